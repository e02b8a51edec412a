"""A page of measured blocks: what is run for each, and the code on which it depends."""

from __future__ import annotations

from typing import NamedTuple

from makers import Maker, code, printed
from work import Command, Study

DRIVING = (
    "controller", "fmus", "pedestrian_model", "sumo_scenarios",
    "giveway/config", "giveway/cosimulation", "giveway/crowd", "giveway/ego", "giveway/geometry",
    "giveway/metrics", "giveway/journal", "giveway/run_data", "giveway/studies/bundled",
    "giveway/studies/statistics", "giveway/sumo", "giveway/walkways",
)  # fmt: skip
"""Rooms that decide how an ego drives and how that is measured."""


class Block(NamedTuple):
    """A block of a page: what is run for it, and how its lines are made of that."""

    name: str
    work: Study | Command
    make: Maker


class Page(NamedTuple):
    """A page, or a kept table of one.

    Attributes:
        name: Name on the command line.
        file: Path relative to the repository.
        blocks: Blocks that are filled.
        rooms: Code on which the numbers depend.
        kept: Whether it is made only when ``--kept`` names it.
        junctions: Whether it has drives on roads that meet.
    """

    name: str
    file: str
    blocks: tuple[Block, ...]
    rooms: tuple[str, ...] = DRIVING
    kept: bool = False
    junctions: bool = False


def told(name: str, *command: str) -> Block:
    """A block of what a command printed."""
    return Block(name, Command(*command), printed)


def shell(name: str, words: str, quick: str = "") -> Block:
    command = f"speed/{words}"
    return Block(name, Command(command, "one machine", quick), code(command))
