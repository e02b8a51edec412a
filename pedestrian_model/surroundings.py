"""The walls that a crowd walks among, and the signals at which it waits."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pedestrian_model._check import as_floats, check_shape, check_values
from pedestrian_model.errors import SurroundingsError
from pedestrian_model.walls import COLUMNS, REACH, join_walls, nearest_walls, sort_walls

_CELL = 1.0  # side [m] of the cells of walls
_MOST_CELLS = 2**21  # largest number of cells (16 MB); a larger area has larger cells
_SHORTEST = 1e-6  # least length [m] of a wall


@dataclass(frozen=True, eq=False)
class Walls:
    """Directed wall segments with the walkable side on the left; made by ``Walls.create``.

    Two walls form a corner if one ends within 1 cm of the start of the other. Walls keep people on
    the walkable side at a distance. People up to 1 m behind a wall are pushed back. The end of a
    wall without a corner acts like a post.
    """

    segments: NDArray[np.float64]  # segments (k, 4): x0, y0, x1, y1 [m]
    _lines: NDArray[np.float64] = field(repr=False)
    _cells: NDArray[np.int64] = field(repr=False)

    def __len__(self) -> int:
        return int(self.segments.shape[0])

    @classmethod
    def create(cls, segments: ArrayLike) -> Walls:
        """Return walls from segments (k, 4), x0, y0, x1, y1 [m], without those of length 0.

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
        """Return the signed distances (n,) [m] to the nearest wall, and its normals (n, 2).

        Distances are negative behind the wall. Normals point to the walkable side. A wall counts up
        to 2 m away, and may count up to 5 m. Without one the distance is inf and the normal zero.

        Args:
            points: Points (n, 2) [m].

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
    """Return the rows (1 + k, COLUMNS) of the segments, still without grid and corner normals."""
    lines = np.zeros((1 + len(segments), COLUMNS))
    lines[1:, :2] = segments[:, :2]
    lines[1:, 2:4] = (segments[:, 2:] - segments[:, :2]) / length[:, None]
    lines[1:, 4] = length
    return lines


def _sorted(lines: NDArray[np.float64]) -> NDArray[np.int64]:
    """Set the grid of the lines, join the walls, and return the cells."""
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
    """The walls and the closed signals, numbered as in ``Crowd.waypoint_signal``.

    ``closed`` may be changed in place when signals change.

    Raises:
        SurroundingsError: if ``closed`` is not a boolean array of one dimension.
    """

    walls: Walls | None = None
    closed: NDArray[np.bool_] = field(default_factory=_none_closed)  # marks (signals,)

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


#: Surroundings without walls and signals.
OPEN_GROUND = Surroundings()
