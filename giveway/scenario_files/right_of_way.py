"""The priorities at each junction in a network file.

A junction's links from lane to lane are numbered in the order of its ``intLanes``. Each link has a
``request`` with two rows of bits, read from the right: the links to which it yields (``response``),
and the links whose paths cross or join its own (``foes``).
"""

import functools
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


def right_of_way(net_file: Path) -> dict[str, JunctionLogic]:
    """Return the logic of each junction that has one.

    Raises:
        ScenarioError: the file is unreadable, damaged, or no SUMO network.
    """
    about = net_file.stat() if net_file.exists() else None
    return _read(net_file, *((about.st_mtime_ns, about.st_size) if about else (0, 0)))


@functools.lru_cache(maxsize=2)  # the runs of a worker have the same network
def _read(net_file: Path, _changed: int, _size: int) -> dict[str, JunctionLogic]:
    reader = _Reader()
    read_network(net_file, {"junction": reader.junction, "request": reader.request})
    return {
        junction: JunctionLogic(incoming, inside, tuple(requests))
        for junction, incoming, inside, requests in reader.found
        if 0 < len(requests) <= len(inside)
    }


class _Reader:
    """Collects the junctions and their requests."""

    def __init__(self) -> None:
        self.found: list[tuple[str, tuple[str, ...], tuple[str, ...], list[Request]]] = []

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
