"""The elements of a scenario that act on people or egos, or wait for them."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from giveway.doctor.finding import Finding, note, warning
from giveway.scenario_files import ScenarioFiles
from giveway.scenario_files.reading import pieces
from giveway.scenario_files.rerouters import rerouters
from giveway.sumo.persons.observers import declared

_TAG = re.compile(rb"<(\w+)\s([^>]*)>")
_ATTRIBUTE = re.compile(rb"([\w:.]+)\s*=\s*[\"']([^\"']*)[\"']")
_ON_A_CROSSING = re.compile(r"^:.*_c\d+$")
_OWNERS = frozenset({"vType", "vehicle", "trip", "flow"})
_NEEDLES = (b"triggered", b"has.taxi.device", b"<tlLogic", b"<connection")
_UNSEEING = frozenset({"entryExitDetector", "e3Detector", "instantInductionLoop"})
_LONGEST = 3  # number of names in one line


@dataclass
class _Found:
    """The elements that were found, by their ids."""

    waiting: list[str] = field(default_factory=list)  # vehicles that wait for passengers
    taxis: list[str] = field(default_factory=list)  # types and vehicles with a taxi device
    actuated: set[str] = field(default_factory=set)  # lights that answer to requests
    crossed: set[str] = field(default_factory=set)  # lights with crossings
    without_priority: list[str] = field(default_factory=list)  # crossings that people yield at


def interplay(files: ScenarioFiles) -> list[Finding]:
    """Name lights that are asked for, detectors for persons, waiting buses, taxis and rerouters.

    Args:
        files: Files of the scenario, all of which can be read.
    """
    found = _Found()
    demand = (*files.route_files, *files.additional_files)
    for file in (files.net_file, *demand):
        owner = ""
        for tag, attributes in _tags(file):
            owner = attributes.get("id", "") if tag in _OWNERS else owner
            _note(tag, attributes, owner, found)
    return [*_findings(found), *_of_persons(demand), *_of_rerouters(demand)]


def _tags(file: Path) -> Iterator[tuple[str, dict[str, str]]]:
    """Yield the elements of the parts of a file that may hold what is looked for."""
    for text in pieces(file):
        if any(needle in text for needle in _NEEDLES):
            for tag, attributes in _TAG.findall(text):
                told = _ATTRIBUTE.findall(attributes)
                yield tag.decode(), {k.decode(): v.decode("utf-8", "replace") for k, v in told}


def _note(tag: str, attributes: dict[str, str], owner: str, found: _Found) -> None:
    if tag == "stop" and attributes.get("triggered", "false") not in ("", "false", "0"):
        found.waiting.append(owner)
    elif tag == "param" and attributes.get("key") == "has.taxi.device":
        if attributes.get("value") in ("true", "1"):
            found.taxis.append(owner)
    elif tag == "tlLogic" and attributes.get("type", "static") != "static":
        found.actuated.add(attributes.get("id", ""))
    elif tag == "connection" and _ON_A_CROSSING.match(attributes.get("to", "")):
        if "tl" in attributes:
            found.crossed.add(attributes["tl"])
        elif attributes.get("state") == "m":
            found.without_priority.append(attributes["to"])


def _findings(found: _Found) -> list[Finding]:
    findings = []
    if asked := found.actuated & found.crossed:
        text = f"{_names(asked)}: people ask for green at {len(asked)} light(s)"
        remedy = (
            "they do in a run, too; at a second crossing in a row it takes a phase's longest time"
        )
        findings.append(note("lights on request", text, remedy))
    if found.without_priority:
        text = f"{_names(found.without_priority)}: vehicles have priority, people wait for a gap"
        remedy = '<crossing priority="true"> in netconvert\'s connections makes a zebra crossing'
        findings.append(note("gap crossings", text, remedy))
    if found.waiting:
        text = f"{_names(found.waiting)}: waits for passengers at a stop (triggered)"
        remedy = "not an ego, unless --no-rules-stops leaves its stops out or they get durations"
        findings.append(note("buses", text, remedy))
    if found.taxis:
        text = f"{_names(found.taxis)}: SUMO's taxi device"
        findings.append(note("taxis", text, "such a vehicle cannot be an ego; name another"))
    return findings


def _of_persons(files: Iterable[Path]) -> list[Finding]:
    found = declared(files)
    seeing = [one.id for one in found if one.tag not in _UNSEEING]
    blind = [one.id for one in found if one.tag in _UNSEEING]
    findings = []
    if seeing:
        text = f"{_names(seeing)}: looks for persons (detectPersons)"
        remedy = "people whom giveway moves are found where the lane is straight"
        findings.append(note("detectors", text, remedy))
    if blind:
        text = f"{_names(blind)}: does not find the people whom giveway moves"
        findings.append(warning("blind detectors", text, "use E1 or E2 detectors, or edgeData"))
    return findings


def _of_rerouters(files: Iterable[Path]) -> list[Finding]:
    return [
        note(
            "rerouter",
            f"{one.id} on {_names(one.edges)}",
            'an ego keeps the route of its departure there; give it another, or set off="1"',
        )
        for one in rerouters(files)
    ]


def _names(names: Iterable[str]) -> str:
    """Return the first names, sorted, and how many more there are."""
    ordered = sorted(set(names))
    more = f" and {len(ordered) - _LONGEST} more" if len(ordered) > _LONGEST else ""
    return ", ".join(ordered[:_LONGEST]) + more
