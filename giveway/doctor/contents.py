"""The contents of scenario files, which are counted while the files are read."""

import re
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from giveway.scenario_files.reading import pieces

_DEMAND = re.compile(rb"<(vehicle|trip|flow|person|personFlow|tlLogic)[\s>]")
_REMOTE = re.compile(rb"\b(?:file|href|dest|output|imgFile)\s*=\s*[\"'](https?://[^\"']{1,200})")
_NET = re.compile(rb"<net\s([^>]*)>")
_ATTRIBUTE = re.compile(rb"([\w:.]+)\s*=\s*[\"']([^\"']*)[\"']")
_WALKINGAREA: Final = b'function="walkingarea"'
_CROSSING: Final = b'function="crossing"'
_SIDEWALK = re.compile(rb"<lane\s+id=\"[^:\"][^>]*\sallow=\"pedestrian\"")


@dataclass
class Contents:
    """The contents of one or several files.

    Attributes:
        elements: Number of each of vehicle, trip, flow, person, personFlow, tlLogic, and in a
            network of walkingarea, crossing, sidewalk. Elements in comments are counted, too.
        network: Attributes of the ``<net>`` element.
        remote: Addresses to which the files refer.
    """

    elements: Counter[str] = field(default_factory=Counter)
    network: dict[str, str] = field(default_factory=dict)
    remote: list[str] = field(default_factory=list)

    @property
    def vehicles(self) -> int:
        """The number of vehicles and trips, without those of flows."""
        return self.elements["vehicle"] + self.elements["trip"]

    @property
    def persons(self) -> int:
        """The number of persons and flows of persons."""
        return self.elements["person"] + self.elements["personFlow"]


def read_contents(file: Path, into: Contents) -> None:
    """Count the contents of ``file``.

    Raises:
        OSError, EOFError: the file cannot be read.
    """
    for text in pieces(file):
        _count(text, into)


def _count(text: bytes, into: Contents) -> None:
    into.elements.update(found[1].decode() for found in _DEMAND.finditer(text))
    into.elements["walkingarea"] += text.count(_WALKINGAREA)
    into.elements["crossing"] += text.count(_CROSSING)
    into.elements["sidewalk"] += len(_SIDEWALK.findall(text))  # not those inside junctions
    into.remote += [found[1].decode("utf-8", "replace") for found in _REMOTE.finditer(text)]
    if not into.network:
        network = _NET.search(text)
        if network is not None:
            into.network = {
                name.decode(): value.decode("utf-8", "replace")
                for name, value in _ATTRIBUTE.findall(network[1])
            }
