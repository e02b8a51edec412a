"""The rerouters of a scenario, which change the routes of vehicles on their edges."""

import io
import xml.etree.ElementTree as ET
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from giveway.scenario_files.reading import opened

_OF_PARKING = "parkingAreaReroute"  # concerns only vehicles that are to park


class Rerouter(NamedTuple):
    """A rerouter that may send any vehicle another way."""

    id: str
    edges: tuple[str, ...]


def rerouters(files: Iterable[Path]) -> list[Rerouter]:
    """Return the rerouters in additional files. Unreadable files are skipped: SUMO has read them.

    Rerouters that are off, and those of parking areas alone, are left out.
    """
    found = []
    for file in files:
        try:
            with opened(file) as stream:
                data = stream.read()
            if b"<rerouter" not in data:
                continue
            for _, element in ET.iterparse(io.BytesIO(data)):
                if element.tag == "rerouter" and _concerns_all(element):
                    edges = tuple(element.get("edges", "").split())
                    found.append(Rerouter(element.get("id", ""), edges))
        except (OSError, EOFError, ET.ParseError):
            continue
    return found


def _concerns_all(element: ET.Element) -> bool:
    if element.get("off") in ("true", "1"):
        return False
    actions = [action.tag for action in element.iter() if action is not element]
    return any(tag.lower().endswith("reroute") and tag != _OF_PARKING for tag in actions)
