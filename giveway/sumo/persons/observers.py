"""The elements of a scenario that look for persons: detectors, outputs and traffic lights.

A held person is on no lane in SUMO's records. Who looks for it there has to be served, see
lane_records.py.
"""

import io
import re
import xml.etree.ElementTree as ET
from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

from giveway.scenario_files.reading import opened

_ATTRIBUTE = "detectPersons"
_LOOPS = frozenset({"inductionLoop", "e1Detector"})
_AREAS = frozenset({"laneAreaDetector", "e2Detector"})
_SUMS = frozenset({"edgeData", "laneData"})
_ENTRY = 3.0  # distance [m] before and behind a detector, from which on it has to see persons
_CROSSING = re.compile(r"^(:.*)_c\d+$")
_STATIC = 0  # SUMO's number of the type of lights with fixed times


class Observer(NamedTuple):
    """An element of the scenario that looks for persons."""

    tag: str
    id: str


class Observers(NamedTuple):
    """The places where something looks for persons."""

    windows: dict[str, list[tuple[float, float]]]  # [m] stretches of lanes with detectors
    edges: bool  # True if an output adds up the persons on edges
    junctions: frozenset[str]  # junctions with crossings whose lights answer to requests

    def __bool__(self) -> bool:
        return bool(self.windows or self.edges or self.junctions)


def declared(files: Iterable[Path]) -> list[Observer]:
    """Return the elements of additional files that detect persons. Unreadable files are skipped."""
    found = []
    for file in files:
        try:
            with opened(file) as stream:
                data = stream.read()
            if _ATTRIBUTE.encode() not in data:
                continue
            for _, element in ET.iterparse(io.BytesIO(data)):
                if element.get(_ATTRIBUTE, "none") not in ("", "none"):
                    found.append(Observer(element.tag, element.get("id", "")))
        except (OSError, EOFError, ET.ParseError):
            continue
    return found


def of_running(sumo: Any) -> Observers:
    """Return what looks for persons in the simulation that runs in the libsumo module ``sumo``."""
    names = str(sumo.simulation.getOption("additional-files")).split(",")
    observers = declared(Path(name.strip()) for name in names if name.strip())
    windows: dict[str, list[tuple[float, float]]] = defaultdict(list)
    for tag, name in observers:
        if tag in _LOOPS:
            lane, start, length = sumo.inductionloop.getLaneID(name), _start(sumo, name), 0.0
        elif tag in _AREAS:
            area = sumo.lanearea
            lane, start = area.getLaneID(name), float(area.getPosition(name))
            length = float(area.getLength(name))
        else:
            continue
        windows[lane].append((start - _ENTRY, start + length + _ENTRY))
    edges = any(observer.tag in _SUMS for observer in observers)
    return Observers(dict(windows), edges, frozenset(_answering(sumo)))


def _start(sumo: Any, loop: str) -> float:
    return float(sumo.inductionloop.getPosition(loop))


def _answering(sumo: Any) -> Iterable[str]:
    """Yield the junctions with crossings at lights whose phases depend on requests."""
    for system in sumo.trafficlight.getIDList():
        running = sumo.trafficlight.getProgram(system)
        logics = sumo.trafficlight.getAllProgramLogics(system)
        if all(logic.type == _STATIC for logic in logics if logic.programID == running):
            continue
        for links in sumo.trafficlight.getControlledLinks(system):
            for _, target, _ in links:
                if crossing := _CROSSING.match(target.rpartition("_")[0]):
                    yield crossing[1]
