"""The walls that a crowd walks among, and the signals that hold it."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pedestrian_model._check import as_floats, check_shape, check_values
from pedestrian_model.errors import SurroundingsError
from pedestrian_model.walls import COLUMNS, REACH, join_walls, nearest_walls, sort_walls

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
    _lines: NDArray[np.float64] = field(repr=False)
    _cells: NDArray[np.int64] = field(repr=False)

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
        lines = _lines(array, length)
        return cls(array, lines, _sorted(lines) if len(array) else _NO_CELLS)

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
        out = np.empty((3, x.shape[0]))
        nearest_walls(x[:, 0].copy(), x[:, 1].copy(), self._lines, self._cells, out)
        return out[0], out[1:].T.copy()


def _lines(segments: NDArray[np.float64], length: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the rows of the segments, (1 + k, COLUMNS), without grid and normals of loose ends."""
    lines = np.zeros((1 + len(segments), COLUMNS))
    lines[1:, :2] = segments[:, :2]
    lines[1:, 2:4] = (segments[:, 2:] - segments[:, :2]) / length[:, None]
    lines[1:, 4] = length
    return lines


def _sorted(lines: NDArray[np.float64]) -> NDArray[np.int64]:
    """The cells of the lines; sets their grid and joins them."""
    ends = lines[1:, :2] + lines[1:, 2:4] * lines[1:, 4:5]
    low = np.minimum(lines[1:, :2], ends).min(axis=0) - REACH
    size = np.maximum(lines[1:, :2], ends).max(axis=0) + REACH - low
    side = _CELL
    while np.prod(size / side + 1.0) > _MOST_CELLS:
        side *= 2.0
    columns, strips = (int(cells) + 1 for cells in size / side)
    lines[0, :5] = low[0], low[1], 1.0 / side, columns, strips
    count = np.zeros(columns * strips + 1, dtype=np.int64)
    closest = np.full(columns * strips, np.inf)
    sort_walls(lines, closest, count, 0)
    sort_walls(lines, closest, count, 1)
    first = len(count) + np.cumsum(count)
    cells = np.empty(int(first[-1]), dtype=np.int64)
    cells[: len(first)] = first
    sort_walls(lines, closest, cells, 2)
    cells[: len(first)] = first
    join_walls(lines, cells)
    return cells


_NO_CELLS = np.zeros(1, dtype=np.int64)
_NO_LINES = np.zeros((1, COLUMNS))


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
    def arrays(self) -> tuple[NDArray[np.bool_], NDArray[np.float64], NDArray[np.int64]]:
        """The arrays that the kernels take: signals, walls, and the cells of the walls."""
        if self.walls is None:
            return self.closed, _NO_LINES, _NO_CELLS
        return self.closed, self.walls._lines, self.walls._cells


#: No walls, no signals.
OPEN_GROUND = Surroundings()
