"""The priorities and stop lines at each junction in a network file.

A junction's links from lane to lane are numbered in the order of its ``intLanes``. Each link has a
``request`` with two rows of bits, read from the right: the links to which it yields (``response``),
and the links whose paths cross or join its own (``foes``). The stop line is where a lane ends, or
before it by the ``stopOffset`` of the lane or of its edge.
"""

import functools
import math
from pathlib import Path
from typing import NamedTuple

from giveway.scenario_files.network import read_network


class Request(NamedTuple):
    """The numbers of the links that one link of a junction yields to or conflicts with."""

    yields_to: frozenset[int]
    meets: frozenset[int]


class JunctionLogic(NamedTuple):
    """The priorities at one junction."""

    incoming: tuple[str, ...]  # lanes that lead to the junction
    inside: tuple[str, ...]  # last lane of each link inside the junction, or a crossing
    requests: tuple[Request, ...]  # priorities of each link


class StopOffset(NamedTuple):
    """The distance of the stop line from the end of a lane, for some classes of vehicles."""

    value: float  # [m]
    named: frozenset[str]  # SUMO's vehicle classes
    excepted: bool  # True if it holds for all classes but these

    def holds_for(self, kind: str) -> bool:
        """Return whether it holds for vehicles of SUMO's class ``kind``."""
        return (kind in self.named or "all" in self.named) != self.excepted


def right_of_way(net_file: Path) -> dict[str, JunctionLogic]:
    """Return the logic of each junction that has one.

    Raises:
        ScenarioError: the file is unreadable, damaged, or no SUMO network.
    """
    return _current(net_file)[0]


def stop_offsets(net_file: Path) -> dict[str, StopOffset]:
    """Return the offset of the stop line by the id of each lane or edge that has one.

    Raises:
        ScenarioError: the file is unreadable, damaged, or no SUMO network.
    """
    return _current(net_file)[1]


_Content = tuple[dict[str, JunctionLogic], dict[str, StopOffset]]


def _current(net_file: Path) -> _Content:
    about = net_file.stat() if net_file.exists() else None
    return _read(net_file, *((about.st_mtime_ns, about.st_size) if about else (0, 0)))


@functools.lru_cache(maxsize=2)  # the runs of a worker have the same network
def _read(net_file: Path, _changed: int, _size: int) -> _Content:
    reader = _Reader()
    names = ("junction", "request", "edge", "lane", "stopOffset")
    read_network(net_file, {name: getattr(reader, name) for name in names})
    logic = {
        junction: JunctionLogic(incoming, inside, tuple(requests))
        for junction, incoming, inside, requests in reader.found
        if 0 < len(requests) <= len(inside)
    }
    return logic, reader.offsets


class _Reader:
    """Collects the junctions with their requests, and the stop lines."""

    def __init__(self) -> None:
        self.found: list[tuple[str, tuple[str, ...], tuple[str, ...], list[Request]]] = []
        self.offsets: dict[str, StopOffset] = {}
        self._road = ""  # edge or lane that was last begun

    def edge(self, attributes: dict[str, str]) -> None:
        """Begin with another edge."""
        self._road = attributes["id"]

    lane = edge

    def stopOffset(self, attributes: dict[str, str]) -> None:  # noqa: N802 - the element's name
        """Note the stop line of the edge or lane that was last begun."""
        excepted = attributes.get("exceptions", "")
        named = (excepted or attributes.get("vClasses", "all")).split()
        value = float(attributes["value"])
        if not 0.0 <= value < math.inf:
            raise ValueError(f"stopOffset of '{self._road}': value = {value}, no distance [m]")
        self.offsets[self._road] = StopOffset(value, frozenset(named), bool(excepted))

    def junction(self, attributes: dict[str, str]) -> None:
        """Begin with another junction."""
        incoming, inside = attributes.get("incLanes", ""), attributes.get("intLanes", "")
        self.found.append((attributes["id"], tuple(incoming.split()), tuple(inside.split()), []))

    def request(self, attributes: dict[str, str]) -> None:
        """Note one link of the junction that was last begun."""
        if self.found:
            bits = attributes["response"], attributes["foes"]
            self.found[-1][3].append(Request(*map(_numbers, bits)))


def _numbers(bits: str) -> frozenset[int]:
    """Return the numbers of the bits that are set, counted from the right."""
    if bits.strip("01"):
        raise ValueError(f"'{bits}' is not a row of bits, as a <request> has")
    return frozenset(number for number, bit in enumerate(reversed(bits)) if bit == "1")
