"""Walls: the nearest wall point of each pedestrian, and its force into the walkable side.

A wall is a directed segment, walkable on its left. Which walls can be the nearest to a place is
looked up in a grid of cells, built once. Where two walls meet, a place is on the walkable side if
it is on the side of the sum of their normals: either normal alone is wrong behind a sharp corner.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from pedestrian_model._jit import inlined, kernel
from pedestrian_model._mathematics import exponential
from pedestrian_model._rows import PX, PY

if TYPE_CHECKING:
    from numpy.typing import NDArray

    #: ``Ground`` as the kernels take it from outside: numba recognises a plain tuple faster.
    GroundArrays = tuple[
        NDArray[np.bool_],
        NDArray[np.float64],
        NDArray[np.int64],
        NDArray[np.int64],
        float,
        float,
        float,
        int,
        int,
    ]

REACH = 2.0  # [m] no wall is felt further away: exp(-b_w s) is nothing long before
DEPTH = 1.0  # [m] who is further behind a wall than this is let go (ours)
JOINED = 0.01  # [m] ends of walls closer than this are one corner

#: Columns of the lines: start, unit vector along, length, sum of the normals at either end.
X_0, Y_0, T_X, T_Y, LENGTH, N0_X, N0_Y, N1_X, N1_Y, LINE_COLUMNS = range(10)

_AT = 1e-9  # [m] closer to a wall's end there is no direction from it; also equal distances
_LEAST_EXPONENT = -700.0  # exp underflows below


class Ground(NamedTuple):
    """The surroundings as the kernels see them: signals, walls, and the grid of the walls."""

    closed: NDArray[np.bool_]  # which signals are closed
    lines: NDArray[np.float64]  # (k, LINE_COLUMNS) the walls
    first: NDArray[np.int64]  # (cells + 1,) offsets into ``member``
    member: NDArray[np.int64]  # the walls of each cell
    x_0: float  # [m] the lower left corner of the grid
    y_0: float
    per_metre: float  # [1/m] cells
    columns: int
    strips: int


@inlined
def _to_line(
    x: float, y: float, lines: NDArray[np.float64], j: int
) -> tuple[float, float, float, bool]:
    """From the nearest point of wall j to (x, y): vector, its square, and if it is walkable there.

    Within the wall's length, the vector is along its normal.
    """
    from_x, from_y = x - lines[j, X_0], y - lines[j, Y_0]
    t_x, t_y, length = lines[j, T_X], lines[j, T_Y], lines[j, LENGTH]
    along = t_x * from_x + t_y * from_y
    if 0.0 < along < length:
        across = t_x * from_y - t_y * from_x
        return -across * t_y, across * t_x, across * across, across >= 0.0
    n_x, n_y = lines[j, N0_X], lines[j, N0_Y]
    if along > 0.0:
        from_x, from_y = from_x - length * t_x, from_y - length * t_y
        n_x, n_y = lines[j, N1_X], lines[j, N1_Y]
    inside = n_x * from_x + n_y * from_y >= -_AT
    return from_x, from_y, from_x * from_x + from_y * from_y, inside


@inlined
def nearest_wall(x: float, y: float, ground: Ground) -> tuple[float, float, float]:
    """Signed distance (negative behind the wall, inf if out of reach), unit vector to walkable."""
    column = int(np.floor((x - ground.x_0) * ground.per_metre))
    strip = int(np.floor((y - ground.y_0) * ground.per_metre))
    if not (0 <= column < ground.columns and 0 <= strip < ground.strips):
        return np.inf, 0.0, 0.0
    cell = strip * ground.columns + column
    best, nearest, best_x, best_y, inside = np.inf, -1, 0.0, 0.0, True
    for k in range(ground.first[cell], ground.first[cell + 1]):
        j = ground.member[k]
        to_x, to_y, square, walkable = _to_line(x, y, ground.lines, j)
        # of two walls back to back, the one whose walkable side this is counts
        tie = abs(square - best) <= _AT * square
        if (square < best and not tie) or (tie and walkable and not inside):
            best, nearest, best_x, best_y, inside = square, j, to_x, to_y, walkable
    if nearest < 0:
        return np.inf, 0.0, 0.0
    distance = math.sqrt(best)
    if distance <= _AT:
        return 0.0, -ground.lines[nearest, T_Y], ground.lines[nearest, T_X]
    if inside:
        return distance, best_x / distance, best_y / distance
    return -distance, -best_x / distance, -best_y / distance


@inlined
def wall_force(s: float, c: Any) -> float:
    """The size of f_w [N] at the signed distance s [m] of a centre from a wall.

    f_w = A_w exp(-b_w (s - R)) + k_col max(0, R - s), the form of Helbing, Farkas & Vicsek 2000;
    the exponent capped as that of f_v; behind the wall only the second term, to ``DEPTH``.
    """
    if s > REACH or s < -DEPTH:
        return 0.0
    f = c.k_col * max(0.0, c.R - s)
    if s >= 0.0:
        f += c.A_w * exponential(max(min(-c.b_w * (s - c.R), c.cap), _LEAST_EXPONENT))
    return float(f)


@inlined
def add_walls(
    rows: NDArray[np.float64], n: int, row_x: int, row_y: int, ground: Ground, c: Any
) -> None:
    """Add the force f_w of the walls to ``row_x`` and ``row_y`` of the first n pedestrians."""
    if ground.lines.shape[0] == 0:
        return
    for k in range(n):
        s, n_x, n_y = nearest_wall(rows[PX, k], rows[PY, k], ground)
        f = wall_force(s, c)
        rows[row_x, k] += f * n_x
        rows[row_y, k] += f * n_y


@inlined
def _distance(x: float, y: float, lines: NDArray[np.float64], j: int) -> float:
    return math.sqrt(_to_line(x, y, lines, j)[2])


@kernel
def sort_walls(
    ground: GroundArrays, closest: NDArray[np.float64], member: NDArray[np.int64], phase: int
) -> None:
    """One of the three passes that sort the walls into the cells of the grid.

    A wall belongs to a cell if it may be the nearest to any place there: with h half the cell's
    diagonal, if it is no further from the centre than the closest one plus 2 h, or than
    ``REACH`` + h. Pass 0 finds the closest distance of each cell; pass 1 counts the walls of cell
    i in ``first[i + 1]``; pass 2 fills ``member`` and moves ``first[i]`` on to ``first[i + 1]``.
    """
    g = Ground(*ground)
    side = 1.0 / g.per_metre
    h = side * math.sqrt(0.5)
    for j in range(g.lines.shape[0]):
        end_x = g.lines[j, X_0] + g.lines[j, LENGTH] * g.lines[j, T_X]
        end_y = g.lines[j, Y_0] + g.lines[j, LENGTH] * g.lines[j, T_Y]
        low_x, high_x = min(end_x, g.lines[j, X_0]), max(end_x, g.lines[j, X_0])
        low_y, high_y = min(end_y, g.lines[j, Y_0]), max(end_y, g.lines[j, Y_0])
        left = max(0, int((low_x - REACH - g.x_0) * g.per_metre) - 1)
        right = min(g.columns - 1, int((high_x + REACH - g.x_0) * g.per_metre) + 1)
        bottom = max(0, int((low_y - REACH - g.y_0) * g.per_metre) - 1)
        top = min(g.strips - 1, int((high_y + REACH - g.y_0) * g.per_metre) + 1)
        for strip in range(bottom, top + 1):
            for column in range(left, right + 1):
                x, y = g.x_0 + (column + 0.5) * side, g.y_0 + (strip + 0.5) * side
                distance = _distance(x, y, g.lines, j)
                cell = strip * g.columns + column
                if phase == 0:
                    closest[cell] = min(closest[cell], distance)
                elif distance <= min(closest[cell] + 2.0 * h, REACH + h) * (1.0 + 1e-9):
                    if phase == 1:
                        g.first[cell + 1] += 1
                    else:
                        member[g.first[cell]] = j
                        g.first[cell] += 1


@inlined
def _follower(j: int, g: Ground) -> int:
    """The wall that goes on where wall j ends, along the same walkable ground; -1 if none does."""
    t_x, t_y = g.lines[j, T_X], g.lines[j, T_Y]
    x = g.lines[j, X_0] + g.lines[j, LENGTH] * t_x
    y = g.lines[j, Y_0] + g.lines[j, LENGTH] * t_y
    cell = int((y - g.y_0) * g.per_metre) * g.columns + int((x - g.x_0) * g.per_metre)
    found, sharpest, closest = -1, np.inf, np.inf
    for k in range(g.first[cell], g.first[cell + 1]):
        i = g.member[k]
        apart = math.sqrt((g.lines[i, X_0] - x) ** 2 + (g.lines[i, Y_0] - y) ** 2)
        if i == j or apart > JOINED or apart > closest + _AT:
            continue
        # where many meet: the first wall met when turning clockwise from the way back
        cross = t_x * g.lines[i, T_Y] - t_y * g.lines[i, T_X]
        dot = t_x * g.lines[i, T_X] + t_y * g.lines[i, T_Y]
        # the clockwise angle from -t_j to t_i, from 0 (turning back sharply left) to 2 pi
        angle = math.pi - math.atan2(cross, dot)
        angle = angle if angle > 0.0 else 2.0 * math.pi
        if apart < closest - _AT or angle < sharpest:
            found, sharpest, closest = i, angle, min(apart, closest)
    return found


@kernel
def join_walls(ground: GroundArrays) -> None:
    """Fill the sums of the normals where the end of one wall is the start of another."""
    g = Ground(*ground)
    for j in range(g.lines.shape[0]):
        i = _follower(j, g)
        if i >= 0:
            n_x = -g.lines[j, T_Y] - g.lines[i, T_Y]
            n_y = g.lines[j, T_X] + g.lines[i, T_X]
            g.lines[j, N1_X], g.lines[j, N1_Y] = n_x, n_y
            g.lines[i, N0_X], g.lines[i, N0_Y] = n_x, n_y


@kernel
def nearest_walls(
    points: NDArray[np.float64], ground: GroundArrays, out: NDArray[np.float64]
) -> None:
    """Fill ``out`` (n, 3): signed distance and unit vector into the walkable side."""
    g = Ground(*ground)
    for i in range(points.shape[0]):
        out[i, 0], out[i, 1], out[i, 2] = nearest_wall(points[i, 0], points[i, 1], g)
