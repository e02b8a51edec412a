"""The ids of the vehicles and persons that a scenario's files declare.

A vehicle that no file declares will never depart. An added person needs a name that is not taken.
"""

import re
from collections.abc import Iterable, Iterator
from html import unescape
from pathlib import Path

from giveway.errors import suggestion
from giveway.scenario_files.reading import pieces

_VEHICLE = re.compile(rb"<(vehicle|trip|flow)\s[^>]*?\bid\s*=\s*(?:\"([^\"]*)\"|'([^']*)')")
_PERSON = re.compile(rb"<(?:person|personFlow)\s[^>]*?\bid\s*=\s*[\"']([^\"']*)")
_CALIBRATOR = b"<calibrator"  # an element that inserts vehicles with names of its own
_INCLUDE = b"<include"  # tag of an included file, which may declare anything
_COMPARED = 5_000  # Number of declared names among which a similar one is searched


def undeclared(name: str, files: Iterable[Path]) -> str | None:
    """Return a message if no vehicle ``name`` is declared in ``files``, or None if one may be.

    Args:
        name: Id of a vehicle in SUMO; a vehicle of a flow has the flow's id, a point and a number.
        files: Files that SUMO reads, compressed or not.
    """
    flow, _, number = name.rpartition(".")
    known: dict[str, None] = {}
    try:
        for kind, declared in _declarations(files):
            if kind == _CALIBRATOR or (kind != b"flow" and declared == name):
                return None
            if kind == b"flow" and declared == flow and number.isdecimal():
                return None
            if len(known) < _COMPARED:
                known[declared + ".0" if kind == b"flow" else declared] = None
    except (OSError, EOFError):
        return None  # SUMO reports the fault in the file
    shown = ", ".join(list(known)[:3])
    none = "it has no vehicles; insert one with --ego-route"
    return suggestion(name, known, f"name one like {shown}" if shown else none, cutoff=0.6)


def declares(name: str, files: Iterable[Path]) -> bool:
    """Return whether a vehicle ``name`` is certainly declared in ``files``."""
    flow, _, number = name.rpartition(".")
    wanted = {(b"vehicle", name), (b"trip", name)}
    if number.isdecimal():
        wanted.add((b"flow", flow))
    try:
        return any(found in wanted for found in _declarations(files))
    except (OSError, EOFError):
        return False  # SUMO reports the fault in the file


def declares_traffic(files: Iterable[Path]) -> bool:
    """Return whether ``files`` declare a vehicle, or cannot be read."""
    try:
        return any(True for _ in _declarations(files))
    except (OSError, EOFError):
        return True  # SUMO reports the fault in the file


def _declarations(files: Iterable[Path]) -> Iterator[tuple[bytes, str]]:
    """Yield kind and id of every vehicle, trip and flow; for a calibrator only the kind."""
    for file in files:
        for text in pieces(file):
            yield from _in(text)


def _in(text: bytes) -> Iterator[tuple[bytes, str]]:
    if _CALIBRATOR in text:
        yield _CALIBRATOR, ""
    for match in _VEHICLE.finditer(text):
        name = match[2] if match[2] is not None else match[3]
        yield match[1], unescape(name.decode("utf-8", "replace"))


def declares_people(files: Iterable[Path]) -> bool:
    """Return whether a person or a flow of persons is declared, or may be, in any of ``files``."""
    try:
        return any(
            _PERSON.search(text) or _INCLUDE in text for file in files for text in pieces(file)
        )
    except (OSError, EOFError):
        return True  # SUMO reports the fault in the file


def free_prefix(wanted: str, files: Iterable[Path]) -> str:
    """Return ``wanted``, or a longer prefix with which no person's id in ``files`` begins.

    Args:
        wanted: Prefix of the names, which end with a number.
        files: Files that SUMO reads, compressed or not.
    """
    names: set[bytes] = set()
    start = wanted.encode()
    try:
        for file in files:
            for text in pieces(file):
                found = (match[1] for match in _PERSON.finditer(text))
                names.update(name for name in found if start in name)
    except (OSError, EOFError):
        return wanted  # SUMO reports the fault in the file
    prefix = wanted
    while any(name.startswith(prefix.encode()) for name in names):
        prefix = f"added_{prefix}"
    return prefix
