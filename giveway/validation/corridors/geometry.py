"""The corridor of a recording: its walls, the way through it, and coordinates along it."""

import re
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from giveway.errors import ConfigError
from giveway.geometry.kernel import Array
from giveway.recordings import Recording
from giveway.recordings.conversion import LENGTHS
from pedestrian_model import Surroundings, Walls

_PLATE = 0.2  # Thickness [m] of the wall that holds the exit
_BESIDE = 10.0  # Length [m] of the walls beside entrance and exit
_BEYOND = 30.0  # Distance [m] that people want to go on behind the exit
_KEY = re.compile(r"\\\{(width|exit)\\\}|\\\*")


@dataclass(frozen=True)
class StraightCorridor:
    """A straight corridor between an entrance as wide as itself and an exit.

    Attributes:
        start: Place [m] where the wall on the right begins.
        direction: Unit vector in which people walk.
        length: Length [m].
        width: Distance [m] of the walls.
        exit: Width [m] of the exit.
        exit_from: Distance [m] of the exit from the wall on the right.
    """

    start: tuple[float, float]
    direction: tuple[float, float]
    length: float
    width: float
    exit: float
    exit_from: float

    def place(self, along: float, across: float) -> tuple[float, float]:
        """Return the place [m] at distances from the start and from the wall on the right."""
        (x, y), (c, s) = self.start, self.direction
        return x + along * c - across * s, y + along * s + across * c

    def along(self, position: Array) -> Array:
        """Return the distance (n,) [m] of places (n, 2) from the entrance, along the corridor."""
        found: Array = (position - self.start) @ np.array(self.direction)
        return found

    def across(self, position: Array) -> Array:
        """Return the distance (n,) [m] of places (n, 2) from the wall on the right."""
        found: Array = (position - self.start) @ np.array([-self.direction[1], self.direction[0]])
        return found

    def surroundings(self) -> Surroundings:
        """Return the walls: sides, those beside the entrance, and the plates that hold the exit."""
        near, far = self.exit_from, self.exit_from + self.exit
        end, behind = self.length, self.length + _PLATE
        outside = self.width + _BESIDE
        right = [(0.0, -_BESIDE), (0.0, 0.0), (end, 0.0), (end, near), (behind, near)]
        left = [(behind, far), (end, far), (end, self.width), (0.0, self.width), (0.0, outside)]
        lines = [[*right, (behind, -_BESIDE)], [(behind, outside), *left]]
        return Surroundings(
            Walls.create(
                [
                    (*self.place(*one), *self.place(*other))
                    for line in lines
                    for one, other in pairwise(line)
                ]
            )
        )

    def route(self) -> tuple[Array, Array]:
        """Return the way-points (3, 2) [m] and passages (3, 3): entrance, exit, and beyond."""
        middle = self.exit_from + 0.5 * self.exit
        places = (0.0, 0.5 * self.width), (self.length, middle), (self.length + _BEYOND, middle)
        halves = 0.5 * self.width, 0.5 * self.exit, 0.0
        passages = [(*self.direction, half) if half else (0.0, 0.0, 0.0) for half in halves]
        return np.array([self.place(*each) for each in places]), np.array(passages)


def corridor_of(recording: Recording) -> StraightCorridor | None:
    """Return the corridor of a recording, or None if it is not in one by its name.

    Raises:
        ConfigError: the corridor is too short, or its exit is not in it.
    """
    dataset = recording.dataset
    described = dataset.corridor
    if described is None:
        return None
    sizes: dict[str, float] = {}
    if described.names:
        match = re.fullmatch(_KEY.sub(_expression, re.escape(described.names)), recording.name)
        if match is None:
            return None
        unit = LENGTHS[dataset.units.length]
        sizes = {key: unit * float(text) for key, text in match.groupdict().items()}
    width = described.width or sizes["width"]
    exit_width = described.exit or sizes["exit"]
    exit_from = described.exit_from
    exit_from = 0.5 * (width - exit_width) if exit_from is None else exit_from
    x, y, to_x, to_y = described.right
    length = float(np.hypot(to_x - x, to_y - y))
    if length < 1.0 or exit_from < -1e-9 or exit_from + exit_width > width + 1e-9:
        raise ConfigError(
            f"{recording.file}: corridor of {length:g} by {width:g} m, exit from {exit_from:g} to "
            f"{exit_from + exit_width:g} m from the wall; expected at least 1 m, and an exit "
            "between the walls; correct [corridor] in the data set's description"
        )
    direction = (to_x - x) / length, (to_y - y) / length
    return StraightCorridor((x, y), direction, length, width, exit_width, max(exit_from, 0.0))


def _expression(match: re.Match[str]) -> str:
    return rf"(?P<{match[1]}>\d+(?:\.\d+)?)" if match[1] else ".*"
