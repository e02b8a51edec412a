"""The speeds that a scenario gives to single walks, which libsumo does not report.

``<walk ... speed="1.1"/>`` and ``<walk ... duration="60"/>`` override the person's own desired
speed. They are read from the scenario's files, only for persons that have them.
"""

import io
import math
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from giveway.scenario_files.reading import opened

_OPTIONS = ("route-files", "additional-files")
_PERSONS = frozenset({"person", "personFlow"})
_PLAN = frozenset({"walk", "personTrip", "ride", "stop", "tranship", "access"})


@dataclass(frozen=True, slots=True)
class _Step:
    """One element of a person's plan. Without speed and duration, the person's own speed counts."""

    speed: float | None = None  # [m/s]
    duration: float | None = None  # [s] duration of the whole walk
    end: str = ""  # edge or stopping place to which it leads; empty if unknown


class WalkSpeeds:
    """Speeds that the scenario gives to walks.

    Args:
        files: Route and additional files of SUMO, plain or gzipped. Unreadable files are skipped,
            since SUMO has read them already.
    """

    def __init__(self, files: Iterable[Path]) -> None:
        self._plans: dict[str, list[_Step]] = {}
        for file in files:
            try:
                self._plans.update(_plans(file))
            except (OSError, EOFError, ET.ParseError, ValueError):
                continue

    @classmethod
    def of_running(cls, sumo: Any) -> Self:
        """Read the speeds for the simulation that runs in the libsumo module ``sumo``."""
        names: list[str] = []
        for option in _OPTIONS:
            names += str(sumo.simulation.getOption(option)).split(",")
        return cls(Path(name.strip()) for name in names if name.strip())

    def speed(self, person: str, stage: Any, remaining: int) -> float | None:
        """Return the speed [m/s] that the scenario gives to a walk, or None.

        Args:
            person: Id of the person.
            stage: Stage of the walk, as libsumo's ``person.getStage`` returns it.
            remaining: Number of the person's remaining stages, this one included.
        """
        if not self._plans:
            return None
        plan = self._plans.get(person) or self._plans.get(person.rpartition(".")[0])
        # Plans are counted from the end, because SUMO splits a trip into several stages when it
        # begins.
        if not plan or remaining > len(plan):
            return None
        step = plan[-remaining]
        if step.end not in ("", stage.edges[-1], stage.destStop):
            return None
        if step.duration is not None:
            return float(stage.length) / step.duration
        return step.speed


def _plans(file: Path) -> dict[str, list[_Step]]:
    """Read the plans in which at least one walk has a speed or a duration, by person or flow."""
    with opened(file) as stream:
        data = stream.read()
    if b"<walk" not in data:  # a large file of vehicles need not be parsed
        return {}
    return dict(_with_speeds(data))


def _with_speeds(data: bytes) -> Iterator[tuple[str, list[_Step]]]:
    depth, root = 0, ET.Element("routes")
    for event, element in ET.iterparse(io.BytesIO(data), ("start", "end")):
        depth += 1 if event == "start" else -1
        if depth == 1 and event == "start":
            root = element
        if depth != 1 or event == "start":
            continue
        if element.tag in _PERSONS:
            plan = [_step(child) for child in element if child.tag in _PLAN]
            if any(step.speed is not None or step.duration is not None for step in plan):
                yield element.get("id", ""), plan
        root.clear()  # frees the memory of what has been read


def _step(element: ET.Element) -> _Step:
    if element.tag != "walk":
        return _Step()
    edges = element.get("edges", "").split()
    end = element.get("to") or element.get("busStop") or (edges[-1] if edges else "")
    return _Step(_positive(element.get("speed")), _positive(element.get("duration")), end)


def _positive(text: str | None) -> float | None:
    try:
        value = float(text or "")
    except ValueError:  # SUMO also accepts 0:01:30
        return None
    return value if 0.0 < value < math.inf else None
