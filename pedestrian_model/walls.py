"""Walls: the distance of each pedestrian to the nearest wall, and its normal.

A wall is a directed segment with the walkable side on its left. A grid of cells, built once, lists
the walls that can be the nearest to a point. At a corner of two walls a point is on the walkable
side if it is on the side of the sum of their normals. One normal alone gives a wrong result behind
a sharp corner.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import inlined, kernel

REACH = 2.0  # distance [m] beyond which a wall has no force; exp(-b_w s) is negligible there
DEPTH = 1.0  # depth [m] behind a wall beyond which it has no force (ours)
JOINED = 0.01  # distance [m] below which two ends of walls form a corner

#: Columns of the walls: start, unit vector along, length, sum of the normals at either end.
#: Row 0 is the grid (see ``Grid``). The walls follow.
X_0, Y_0, T_X, T_Y, LENGTH, N0_X, N0_Y, N1_X, N1_Y, COLUMNS = range(10)

_AT = 1e-9  # tolerance [m] of equal distances, and least distance that has a direction
_LEAST_EXPONENT = -700.0  # least exponent without underflow


class Grid(NamedTuple):
    """The grid of the walls' cells, from row 0 of the walls.

    The cells are one array of int64. It begins with one index for each cell, and one for their end,
    at which the cell's members begin in this array. The members follow: rows of the walls.
    """

    x_0: float  # coordinates [m] of the lower left corner
    y_0: float
    per_metre: float  # cells per metre [1/m]
    columns: float  # number of columns
    strips: float  # number of strips (rows of cells)


@inlined
def _grid(walls: NDArray[np.float64]) -> Grid:
    return Grid(walls[0, 0], walls[0, 1], walls[0, 2], walls[0, 3], walls[0, 4])


@inlined
def _cell(x: float, y: float, g: Grid) -> int:
    """Return the cell of a point, or -1 outside of the grid."""
    column, strip = np.floor((x - g.x_0) * g.per_metre), np.floor((y - g.y_0) * g.per_metre)
    if 0.0 <= column < g.columns and 0.0 <= strip < g.strips:
        return int(strip) * int(g.columns) + int(column)
    return -1


class _Wall(NamedTuple):
    """One wall of the array of walls."""

    x: float  # coordinates [m] of its start
    y: float
    t_x: float  # unit vector along the wall
    t_y: float
    length: float  # length [m]
    N0: tuple[float, float]  # sum of the normals at its start
    N1: tuple[float, float]  # sum of the normals at its end


@inlined
def _wall(line: NDArray[np.float64]) -> _Wall:
    N0, N1 = (line[5], line[6]), (line[7], line[8])
    return _Wall(line[0], line[1], line[2], line[3], line[4], N0, N1)


@inlined
def _to_wall(x: float, y: float, w: _Wall) -> tuple[float, float, float, bool]:
    """Return the vector from a wall's nearest point to (x, y), and its squared length.

    The last result is whether (x, y) is on the wall's walkable side.
    """
    dx, dy = x - w.x, y - w.y
    along = w.t_x * dx + w.t_y * dy
    if 0.0 < along < w.length:
        across = w.t_x * dy - w.t_y * dx
        return -across * w.t_y, across * w.t_x, across * across, across >= 0.0
    N_x, N_y = w.N0
    if along > 0.0:
        dx, dy = dx - w.length * w.t_x, dy - w.length * w.t_y
        N_x, N_y = w.N1
    return dx, dy, dx * dx + dy * dy, N_x * dx + N_y * dy >= -_AT


@inlined
def find_walls(
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    n: int,
    walls: NDArray[np.float64],
    cells: NDArray[np.int64],
    nearest: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
) -> None:
    """Fill ``nearest`` with the signed distance [m] of n points to the nearest wall, and normals.

    The distance is negative behind the wall. The unit normal x, y points to the walkable side. Out
    of reach of all walls they are inf and zero.
    """
    s, n_x, n_y = nearest
    grid = _grid(walls)
    for k in range(n):
        best, best_x, best_y, inside, t_x, t_y = np.inf, 0.0, 0.0, True, 0.0, 0.0
        cell = _cell(x[k], y[k], grid)
        for at in range(cells[cell], cells[cell + 1] if cell >= 0 else 0):
            wall = _wall(walls[cells[at]])
            dx, dy, square, walkable = _to_wall(x[k], y[k], wall)
            # Of two walls back to back, the one with the point on its walkable side counts.
            tie = abs(square - best) <= _AT * square
            if (square < best and not tie) or (tie and walkable and not inside):
                best, best_x, best_y, inside = square, dx, dy, walkable
                t_x, t_y = wall.t_x, wall.t_y
        distance = math.sqrt(best)
        if distance <= _AT:  # for a point on the wall the wall's own normal is used
            distance, best_x, best_y, best = 0.0, -t_y, t_x, 1.0
        sign = 1.0 if inside else -1.0
        inverse = sign / math.sqrt(best)
        s[k], n_x[k], n_y[k] = sign * distance, best_x * inverse, best_y * inverse


@kernel
def sort_walls(
    walls: NDArray[np.float64], closest: NDArray[np.float64], cells: NDArray[np.int64], phase: int
) -> None:
    """Perform one of the three passes that sort the walls into the cells of the grid.

    A wall belongs to a cell if it may be the nearest one to a point of the cell. With h half of the
    cell's diagonal, its distance to the centre is then at most that of the closest wall plus 2 h,
    and at most ``REACH`` + h. Pass 0 finds the closest distance of each cell. Pass 1 counts the
    walls of cell i in ``cells[i + 1]``. Pass 2 writes the members to index ``cells[i]``, which it
    increments.

    Args:
        walls: Grid and walls, (1 + k, COLUMNS).
        closest: Closest distance [m] of each cell.
        cells: Cells of the grid.
        phase: Number of the pass.
    """
    g = _grid(walls)
    side = 1.0 / g.per_metre
    h = side * math.sqrt(0.5)
    for j in range(1, walls.shape[0]):
        wall = _wall(walls[j])
        end_x, end_y = wall.x + wall.length * wall.t_x, wall.y + wall.length * wall.t_y
        left = _index(min(wall.x, end_x) - REACH - side, g.x_0, g.per_metre, g.columns)
        right = _index(max(wall.x, end_x) + REACH + side, g.x_0, g.per_metre, g.columns)
        low = _index(min(wall.y, end_y) - REACH - side, g.y_0, g.per_metre, g.strips)
        high = _index(max(wall.y, end_y) + REACH + side, g.y_0, g.per_metre, g.strips)
        for strip in range(low, high + 1):
            for column in range(left, right + 1):
                x, y = g.x_0 + (column + 0.5) * side, g.y_0 + (strip + 0.5) * side
                distance = math.sqrt(_to_wall(x, y, wall)[2])
                cell = strip * int(g.columns) + column
                if phase == 0:
                    closest[cell] = min(closest[cell], distance)
                elif distance <= min(closest[cell] + 2.0 * h, REACH + h) * (1.0 + 1e-9):
                    if phase == 1:
                        cells[cell + 1] += 1
                    else:
                        cells[cells[cell]] = j
                        cells[cell] += 1


@inlined
def _index(x: float, x_0: float, per_metre: float, count: float) -> int:
    """Return the column (or strip) of a coordinate, limited to those of the grid."""
    return int(min(max(np.floor((x - x_0) * per_metre), 0.0), count - 1.0))


@inlined
def _follower(j: int, walls: NDArray[np.float64], cells: NDArray[np.int64]) -> int:
    """Return the wall that continues wall j along the same walkable side, or 0."""
    wall = _wall(walls[j])
    x, y = wall.x + wall.length * wall.t_x, wall.y + wall.length * wall.t_y
    cell = _cell(x, y, _grid(walls))
    found, sharpest, closest = 0, -np.inf, np.inf
    for at in range(cells[cell], cells[cell + 1]):
        other = _wall(walls[cells[at]])
        apart = math.sqrt((other.x - x) ** 2 + (other.y - y) ** 2)
        if cells[at] == j or apart > JOINED or apart > closest + _AT:
            continue
        # Of several walls, the sharpest turn to the left bounds the same walkable side. `turn`
        # rises with the angle from -2 to 2. Straight back is the tip of a thin wall, used last.
        dot = wall.t_x * other.t_x + wall.t_y * other.t_y
        left = wall.t_x * other.t_y - wall.t_y * other.t_x >= 0.0 and dot > _AT - 1.0
        turn = 1.0 - dot if left else dot - 1.0
        if apart < closest - _AT or turn > sharpest:
            found, sharpest, closest = cells[at], turn, min(apart, closest)
    return found


@kernel
def join_walls(walls: NDArray[np.float64], cells: NDArray[np.int64]) -> None:
    """Fill the sums of the normals at corners, where one wall ends and another one starts."""
    for j in range(1, walls.shape[0]):
        i = _follower(j, walls, cells)
        if i > 0:
            n_x, n_y = -walls[j, T_Y] - walls[i, T_Y], walls[j, T_X] + walls[i, T_X]
            walls[j, N1_X], walls[j, N1_Y] = n_x, n_y
            walls[i, N0_X], walls[i, N0_Y] = n_x, n_y


@kernel
def nearest_walls(
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    walls: NDArray[np.float64],
    cells: NDArray[np.int64],
    out: NDArray[np.float64],
) -> None:
    """Fill ``out`` (3, n): signed distance [m], and unit normal x, y to the walkable side."""
    find_walls(x, y, x.shape[0], walls, cells, (out[0], out[1], out[2]))
