"""What a crowd walks among besides vehicles: walls, and signals that hold it."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from pedestrian_model import _walls
from pedestrian_model._check import as_floats, check_shape, check_values
from pedestrian_model.errors import SurroundingsError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from pedestrian_model._walls import GroundArrays

_CELL = 1.0  # [m] of the grid of walls
_MOST_CELLS = 2**21  # the grid of a larger place is coarser: 16 MB
_SHORTEST = 1e-6  # [m] a shorter wall has no direction


@dataclass(frozen=True, eq=False)
class Walls:
    """Directed wall segments, the walkable side on the left; build it with ``Walls.create``.

    Where a wall ends within 1 cm of the start of another, the two make a corner. Somebody on the
    walkable side is kept off, somebody up to 1 m behind a wall is pushed back in. A loose end
    keeps people off like a post.
    """

    segments: NDArray[np.float64]  # (k, 4) [m] x0, y0, x1, y1
    _ground: GroundArrays = field(repr=False)

    def __len__(self) -> int:
        return int(self.segments.shape[0])

    @classmethod
    def create(cls, segments: ArrayLike) -> Walls:
        """Walls from segments (k, 4) [m] x0, y0, x1, y1; those without length are left out.

        Raises:
            SurroundingsError: if ``segments`` has a wrong shape or a value is not finite.
        """
        array = as_floats(segments, "segments", SurroundingsError)
        array = array.reshape(0, 4) if array.size == 0 else array
        check_shape(array, (None, 4), "segments", SurroundingsError)
        check_values(array, "segments", SurroundingsError)
        length = np.sqrt(((array[:, 2:] - array[:, :2]) ** 2).sum(axis=1))
        array, length = array[length > _SHORTEST], length[length > _SHORTEST]
        if not len(array):
            return cls(array, _NO_GROUND)
        return cls(array, _sorted(_lines(array, length)))

    def nearest(self, points: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The signed distances (n,) [m] of ``points`` (n, 2) [m] to the nearest wall, and normals.

        Negative behind the wall; the normals (n, 2) point into the walkable side. Where no wall
        is near (from 2 m on, at the latest 5 m) the distance is inf and the normal zero.

        Raises:
            SurroundingsError: if ``points`` has a wrong shape or a value is not finite.
        """
        x = as_floats(points, "points", SurroundingsError)
        check_shape(x, (None, 2), "points", SurroundingsError)
        check_values(x, "points", SurroundingsError)
        out = np.empty((x.shape[0], 3))
        _walls.nearest_walls(x, self._ground, out)
        return out[:, 0].copy(), out[:, 1:].copy()


def _lines(segments: NDArray[np.float64], length: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k, LINE_COLUMNS) of the segments, the normals at their ends still zero: loose."""
    lines = np.zeros((len(segments), _walls.LINE_COLUMNS))
    lines[:, :2] = segments[:, :2]
    lines[:, 2:4] = (segments[:, 2:] - segments[:, :2]) / length[:, None]
    lines[:, 4] = length
    return lines


def _sorted(lines: NDArray[np.float64]) -> GroundArrays:
    """The lines with their grid, joined."""
    ends = lines[:, :2] + lines[:, 2:4] * lines[:, 4:5]
    low = np.minimum(lines[:, :2], ends).min(axis=0) - _walls.REACH
    size = np.maximum(lines[:, :2], ends).max(axis=0) + _walls.REACH - low
    side = _CELL
    while np.prod(size / side + 1.0) > _MOST_CELLS:
        side *= 2.0
    columns, strips = (int(cells) + 1 for cells in size / side)
    first = np.zeros(columns * strips + 1, dtype=np.int64)
    closest = np.full(columns * strips, np.inf)
    where = (float(low[0]), float(low[1]), 1.0 / side, columns, strips)
    nobody, nothing = np.empty(0, dtype=np.int64), np.empty(0, dtype=np.bool_)
    counted: GroundArrays = (nothing, lines, first, nobody, *where)
    _walls.sort_walls(counted, closest, nobody, 0)
    _walls.sort_walls(counted, closest, nobody, 1)
    np.cumsum(first, out=first)
    member = np.empty(int(first[-1]), dtype=np.int64)
    ground: GroundArrays = (nothing, lines, first, member, *where)
    _walls.sort_walls(ground, closest, member, 2)
    first[1:] = first[:-1].copy()
    first[0] = 0
    _walls.join_walls(ground)
    return ground


_NO_GROUND: GroundArrays = (
    np.empty(0, dtype=np.bool_),
    np.empty((0, _walls.LINE_COLUMNS)),
    np.zeros(1, dtype=np.int64),
    np.empty(0, dtype=np.int64),
    0.0,
    0.0,
    1.0,
    0,
    0,
)


def _none_closed() -> NDArray[np.bool_]:
    return np.empty(0, dtype=np.bool_)


@dataclass(frozen=True, eq=False)
class Surroundings:
    """Walls, and which signals are closed; signals are numbered as in ``Crowd.waypoint_signal``.

    ``closed`` may be changed in place as the signals change.

    Raises:
        SurroundingsError: if ``closed`` is not a boolean array of one dimension.
    """

    walls: Walls | None = None
    closed: NDArray[np.bool_] = field(default_factory=_none_closed)  # (signals,)

    def __post_init__(self) -> None:
        closed = self.closed
        if (
            not isinstance(closed, np.ndarray)
            or closed.dtype != np.bool_
            or closed.ndim != 1
            or not closed.flags.c_contiguous
        ):
            raise SurroundingsError(
                f"closed = {closed!r}, expected a contiguous array of bool, one for each signal"
            )

    @cached_property
    def arrays(self) -> GroundArrays:
        """What the kernels take."""
        ground = _NO_GROUND if self.walls is None else self.walls._ground
        return (self.closed, *ground[1:])


#: No walls, no signals.
OPEN_GROUND = Surroundings()
