"""The forces of the pairs of a large crowd within the interaction radius, by a cell list.

The plane is divided into strips along x, and each strip into columns. The crowd is sorted by strip
and column, so that the neighbours in one strip are contiguous. The pedestrians of a *tile* (some
columns of a strip) share one list of candidates: those to the right in their own strip, and those
within reach in the strips above. Thus each pair occurs once. The candidates are copied into the
buffer. Their forces with each pedestrian of the tile are computed in one loop, and the forces on
the candidates are copied back.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import add_block, copy_block, fma, inlined, inner
from pedestrian_model.vci.buffers import (
    BACK_X,
    BACK_Y,
    BLOCK,
    BUX,
    BUY,
    BVX,
    BVY,
    BX,
    BY,
    FX,
    FY,
    ON_X,
    ON_Y,
    PX,
    PY,
    STRIDE,
    UX,
    UY,
    VX,
    VY,
    fill,
)
from pedestrian_model.vci.pairs.pair_force import (
    COINCIDENT_2,
    PairConstants,
    add_coincident,
    pair,
    pair_constants,
)

# Sizes relative to the interaction radius, found by benchmarks/speed/bench_crowd.py.
_STRIPS = 4.0  # number of strips per interaction radius
_COLUMNS = 16.0  # number of columns per interaction radius
_TILE = 6  # number of columns per tile
_ROOM = STRIDE - 2 * BLOCK  # number of candidates that the buffer holds


class Grid(NamedTuple):
    """The position and size of the cells."""

    x_0: float  # coordinates [m] of the lower left corner
    y_0: float
    per_x: float  # columns per metre [1/m]
    per_y: float  # strips per metre [1/m]
    columns: int  # number of columns
    strips: int  # number of strips
    reach: float  # interaction radius [m]
    slack: float  # tolerance [m] against rounding errors


class Strips(NamedTuple):
    """Some adjacent strips of a grid."""

    grid: Grid
    begin: int  # first strip
    end: int  # last strip plus one


@inlined
def _lay_grid(position: NDArray[np.float64], reach: float, most: int) -> Grid:
    """Return the grid over a crowd, with larger cells if there would be more than ``most``."""
    x_0, x_1, y_0, y_1 = position[0, 0], position[0, 0], position[0, 1], position[0, 1]
    for i in range(position.shape[0]):
        x_0, x_1 = min(x_0, position[i, 0]), max(x_1, position[i, 0])
        y_0, y_1 = min(y_0, position[i, 1]), max(y_1, position[i, 1])
    width, height = x_1 - x_0, y_1 - y_0
    per_x, per_y = _COLUMNS / reach, _STRIPS / reach
    while (width * per_x + 1.0) * (height * per_y + 1.0) > most:
        per_x *= 0.5
        per_y *= 0.5
    slack = 1e-6 * reach + 1e-15 * (abs(x_0) + abs(x_1) + abs(y_0) + abs(y_1))
    columns, strips = int(width * per_x) + 1, int(height * per_y) + 1
    return Grid(x_0, y_0, per_x, per_y, columns, strips, reach, slack)


@inlined
def _sort(index: NDArray[np.int64], position: NDArray[np.float64], grid: Grid) -> None:
    """Sort the crowd into cells by a counting sort, which is stable.

    index[0] becomes the order, and index[2] the first pedestrian of each cell. During the sort the
    entries of index[2] are shifted by one, so that they are correct at its end.
    """
    order, cell, first = index[0], index[1], index[2]
    cells = grid.columns * grid.strips
    for k in range(cells + 2):
        first[k] = 0
    for i in range(position.shape[0]):
        column = int((position[i, 0] - grid.x_0) * grid.per_x)
        strip = int((position[i, 1] - grid.y_0) * grid.per_y)
        cell[i] = strip * grid.columns + column
        first[cell[i] + 2] += 1
    for k in range(1, cells + 1):
        first[k + 1] += first[k]
    for i in range(position.shape[0]):
        order[first[cell[i] + 1]] = i
        first[cell[i] + 1] += 1


@inlined
def _sum(buffer: NDArray[np.float64], at: int, blocks: int) -> float:
    """Return the sum of whole blocks of the buffer in a fixed order: by columns, then pairwise."""
    for k in range(1, blocks):
        add_block(buffer, at, buffer, at + k * BLOCK)
    even = (buffer[at] + buffer[at + 4]) + (buffer[at + 2] + buffer[at + 6])
    odd = (buffer[at + 1] + buffer[at + 5]) + (buffer[at + 3] + buffer[at + 7])
    return float(even + odd)


@inlined
def _meet(
    rows: NDArray[np.float64],
    i: int,
    buffer: NDArray[np.float64],
    start: int,
    stop: int,
    c: PairConstants,
) -> int:
    """Add the forces between row i and the candidates start ... stop - 1 of the buffer.

    Returns:
        Number of pairs that coincide and were left out.
    """
    x, y, vx, vy = rows[PX, i], rows[PY, i], rows[VX, i], rows[VY, i]
    ux, uy = rows[UX, i], rows[UY, i]
    blocks = (stop - start + BLOCK - 1) // BLOCK
    from_start = buffer[start:]
    coincident = 0
    for k in range(blocks * BLOCK):
        dx = from_start[BX + k] - x
        dy = from_start[BY + k] - y
        r_2 = fma(dx, dx, dy * dy)
        r = math.sqrt(r_2)
        apart = r_2 >= COINCIDENT_2
        coincident += (k < stop - start) & (not apart)
        f = pair(
            (dx, dy),
            (r, r - c.two_R),
            (vx - from_start[BVX + k], vy - from_start[BVY + k]),
            (ux, uy),
            (from_start[BUX + k], from_start[BUY + k]),
            (r_2 <= c.r_max_2) & apart & (k < stop - start),
            c,
        )
        from_start[ON_X + k] = f[0]
        from_start[ON_Y + k] = f[1]
        from_start[BACK_X + k] += f[2]
        from_start[BACK_Y + k] += f[3]
    rows[FX, i] += _sum(from_start, ON_X, blocks)
    rows[FY, i] += _sum(from_start, ON_Y, blocks)
    return coincident


@inlined
def _bounds(rows: NDArray[np.float64], begin: int, end: int) -> tuple[float, float, float, float]:
    """Return the box around the rows begin ... end - 1: least x, largest x, least y, largest y."""
    x_0, x_1, y_0, y_1 = rows[PX, begin], rows[PX, begin], rows[PY, begin], rows[PY, begin]
    for i in range(begin + 1, end):
        x_0, x_1 = min(x_0, rows[PX, i]), max(x_1, rows[PX, i])
        y_0, y_1 = min(y_0, rows[PY, i]), max(y_1, rows[PY, i])
    return x_0, x_1, y_0, y_1


@inlined
def _borrow(
    rows: NDArray[np.float64], buffer: NDArray[np.float64], at: int, start: int, count: int
) -> None:
    """Copy ``count`` rows from ``start`` on to index ``at`` of the buffer, in whole blocks.

    Excess rows are overwritten by the next copy, or left out by ``_meet``.
    """
    for k in range(0, count, BLOCK):
        copy_block(buffer, BX + at + k, rows[PX], start + k)
        copy_block(buffer, BY + at + k, rows[PY], start + k)
        copy_block(buffer, BVX + at + k, rows[VX], start + k)
        copy_block(buffer, BVY + at + k, rows[VY], start + k)
        copy_block(buffer, BUX + at + k, rows[UX], start + k)
        copy_block(buffer, BUY + at + k, rows[UY], start + k)


@inlined
def _give_back(
    rows: NDArray[np.float64], buffer: NDArray[np.float64], at: int, start: int, count: int
) -> None:
    """Add the forces at index ``at`` of the buffer to ``count`` rows from ``start`` on."""
    whole = count // BLOCK * BLOCK
    for k in range(0, whole, BLOCK):
        add_block(rows[FX], start + k, buffer, BACK_X + at + k)
        add_block(rows[FY], start + k, buffer, BACK_Y + at + k)
    for k in range(whole, count):
        rows[FX, start + k] += buffer[BACK_X + at + k]
        rows[FY, start + k] += buffer[BACK_Y + at + k]


@inlined
def _meet_candidates(
    rows: NDArray[np.float64],
    begin: int,
    end: int,
    segments: NDArray[np.int64],
    count: int,
    buffer: NDArray[np.float64],
    c: PairConstants,
) -> int:
    """Add the forces between the rows begin ... end - 1 and later rows in the ``segments``.

    Args:
        rows: Rows of the workspace, sorted by cell.
        begin: First row of the tile, and of the first segment.
        end: Last row of the tile, plus one.
        segments: First row, last row plus one, and scratch, (4, more than count).
        count: Number of segments.
        buffer: Buffer of the candidates. More candidates than it holds are handled in parts.
        c: Constants of the pair loops.

    Returns:
        Number of pairs that coincide and were left out.
    """
    coincident, segment = 0, 0
    while segment < count:
        used, pieces, first = 0, 0, segments[0, segment]
        while segment < count and used < _ROOM:
            start = segments[0, segment]
            take = min(segments[1, segment] - start, _ROOM - used)
            _borrow(rows, buffer, used, start, take)
            segments[2, pieces], segments[3, pieces] = start, take
            used, pieces = used + take, pieces + 1
            segments[0, segment] += take
            segment += segments[0, segment] == segments[1, segment]
        for k in range(used + BLOCK):
            buffer[BACK_X + k] = 0.0
            buffer[BACK_Y + k] = 0.0
        for i in range(begin, end):
            start = max(0, i + 1 - first)  # in the own strip only rows after i
            if start < used:
                coincident += _meet(rows, i, buffer, start, used, c)
        at = 0
        for k in range(pieces):
            _give_back(rows, buffer, at, segments[2, k], segments[3, k])
            at += segments[3, k]
    return coincident


@inlined
def _find_segments(
    rows: NDArray[np.float64],
    first: NDArray[np.int64],
    segments: NDArray[np.int64],
    begin: int,
    end: int,
    strip: int,
    grid: Grid,
) -> int:
    """Find the rows within reach of the box around a tile's rows, strip by strip upwards.

    Returns:
        Number of segments that they form.
    """
    x_low, x_high, y_high = rows[PX, begin], rows[PX, begin], rows[PY, begin]
    for i in range(begin + 1, end):
        x_low, x_high = min(x_low, rows[PX, i]), max(x_high, rows[PX, i])
        y_high = max(y_high, rows[PY, i])
    count = 0
    for above in range(min(int(grid.reach * grid.per_y) + 2, grid.strips - strip)):
        gap = (strip + above) / grid.per_y + grid.y_0 - y_high - grid.slack
        if gap >= grid.reach:
            break
        half = math.sqrt(grid.reach**2 - max(gap, 0.0) ** 2) + grid.slack
        left = max(int((x_low - half - grid.x_0) * grid.per_x), 0)
        right = min(int((x_high + half - grid.x_0) * grid.per_x), grid.columns - 1)
        base = (strip + above) * grid.columns
        start = begin if above == 0 else first[base + left]
        stop = first[base + right + 1]
        if stop > start:
            segments[0, count], segments[1, count] = start, stop
            count += 1
    return count


@inner
def add_near_pairs(
    rows: NDArray[np.float64],
    index: NDArray[np.int64],
    buffer: NDArray[np.float64],
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
    constants: NDArray[Any],
) -> Grid:
    """Fill the rows sorted by cell, and add the forces of the pairs within reach.

    Returns:
        Grid of the cells; ``index[2]`` holds the first row of each cell.
    """
    c = pair_constants(constants[0])
    grid = _lay_grid(position, constants[0].r_max, index.shape[1] - 2)
    _sort(index, position, grid)
    order, first = index[0], index[2]
    segments = index[1, :64].reshape(4, 16)  # memory that only the sort needed
    fill(rows, order[: position.shape[0]], position, velocity)
    for strip in range(grid.strips):
        for left in range(0, grid.columns, _TILE):
            begin = first[strip * grid.columns + left]
            end = first[strip * grid.columns + min(left + _TILE, grid.columns)]
            if begin == end:
                continue
            count = _find_segments(rows, first, segments, begin, end, strip, grid)
            if _meet_candidates(rows, begin, end, segments, count, buffer, c) > 0:
                for i in range(begin, end):
                    add_coincident(rows, order, i, position.shape[0], c)
    return grid
