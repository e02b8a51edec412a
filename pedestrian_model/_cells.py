"""A cell list, for a large crowd: nobody looks further than the interaction radius.

The plane is cut into strips along x, each strip into columns, and the crowd is sorted by strip and
column, so that the neighbours in one strip are contiguous. The pedestrians of a *tile* (some
columns of a strip) share one list of candidates: the columns to the right in their own strip and
those within reach in the strips above, so that each pair is met once. The candidates are copied
into the buffer, met by each pedestrian of the tile in a vector loop, and the forces on them
copied back.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from pedestrian_model._jit import add_block, fma, inlined, kernel
from pedestrian_model._pairs import (
    COINCIDENT_2,
    PairConstants,
    add_coincident,
    pair,
    pair_constants,
)
from pedestrian_model._rows import (
    BACK_X, BACK_Y, BLOCK, BUX, BUY, BVX, BVY, BX, BY, FX, FY, ON_X, ON_Y, PX, PY, STRIDE,
    UX, UY, VX, VY, fill,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

# Sizes relative to the interaction radius, found by benchmarks/bench_crowd.py.
_STRIPS = 3.0  # strips per interaction radius
_COLUMNS = 12.0  # columns per interaction radius
_TILE = 4  # columns per tile
_SAFE = 1.0 + 1e-6  # reach of the search, so that rounding loses nobody
_ROOM = STRIDE - 2 * BLOCK  # candidates the buffer holds


@inlined
def _cell_sizes(width: float, height: float, reach: float, most: int) -> tuple[float, float]:
    """Columns and strips per metre, coarser than planned where they would be too many."""
    per_x, per_y = _COLUMNS / reach, _STRIPS / reach
    while (width * per_x + 1.0) * (height * per_y + 1.0) > most:
        per_x *= 0.5
        per_y *= 0.5
    return per_x, per_y


@inlined
def _sort(
    index: NDArray[np.int64], position: NDArray[np.float64], x_0: float, y_0: float,
    per_x: float, per_y: float, columns: int, cells: int,
) -> None:
    """Counting sort: index[0] the order, index[2] the first of each cell. Stable: deterministic."""
    order, cell, first = index[0], index[1], index[2]
    for k in range(cells + 1):
        first[k] = 0
    for i in range(position.shape[0]):
        column = int((position[i, 0] - x_0) * per_x)
        cell[i] = int((position[i, 1] - y_0) * per_y) * columns + column
        first[cell[i] + 1] += 1
    for k in range(cells):
        first[k + 1] += first[k]
    for i in range(position.shape[0]):
        order[first[cell[i]]] = i
        first[cell[i]] += 1
    for k in range(cells, 0, -1):
        first[k] = first[k - 1]
    first[0] = 0


@inlined
def _sum(buffer: NDArray[np.float64], at: int, blocks: int) -> float:
    """The sum of whole blocks of the buffer in one fixed order: by lanes, then pairwise."""
    for k in range(1, blocks):
        add_block(buffer, at, at + k * BLOCK)
    a, b = (buffer[at], buffer[at + 1]), (buffer[at + 2], buffer[at + 3])
    c, d = (buffer[at + 4], buffer[at + 5]), (buffer[at + 6], buffer[at + 7])
    return ((a[0] + c[0]) + (b[0] + d[0])) + ((a[1] + c[1]) + (b[1] + d[1]))


@inlined
def _meet(
    rows: NDArray[np.float64], i: int, buffer: NDArray[np.float64], start: int, stop: int,
    c: PairConstants,
) -> int:
    """The forces between row i and the candidates start ... stop - 1 of the buffer.

    Returns:
        How many of these pairs coincide and were left out.
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
            dx, dy, r, r - c.two_R, vx - from_start[BVX + k], vy - from_start[BVY + k],
            ux, uy, from_start[BUX + k], from_start[BUY + k],
            (r_2 <= c.r_max_2) & apart & (k < stop - start), c,
        )
        from_start[ON_X + k] = f[0]
        from_start[ON_Y + k] = f[1]
        from_start[BACK_X + k] += f[2]
        from_start[BACK_Y + k] += f[3]
    rows[FX, i] += _sum(from_start, ON_X, blocks)
    rows[FY, i] += _sum(from_start, ON_Y, blocks)
    return coincident


@inlined
def _bounds(
    rows: NDArray[np.float64], begin: int, end: int
) -> tuple[float, float, float, float]:
    """The box round the rows begin ... end - 1: x from, x to, y from, y to."""
    x_0, x_1, y_0, y_1 = rows[PX, begin], rows[PX, begin], rows[PY, begin], rows[PY, begin]
    for i in range(begin + 1, end):
        x_0, x_1 = min(x_0, rows[PX, i]), max(x_1, rows[PX, i])
        y_0, y_1 = min(y_0, rows[PY, i]), max(y_1, rows[PY, i])
    return x_0, x_1, y_0, y_1


@inlined
def _borrow(
    rows: NDArray[np.float64], buffer: NDArray[np.float64], who: NDArray[np.int64], at: int,
    start: int, stop: int, box: tuple[float, float, float, float], reach_2: float,
) -> int:
    """Copy the rows start ... stop - 1 that lie within reach of a box to place ``at`` and on.

    Returns:
        The place after the last one.
    """
    for j in range(start, stop):
        x, y = rows[PX, j], rows[PY, j]
        buffer[BX + at] = x
        buffer[BY + at] = y
        buffer[BVX + at] = rows[VX, j]
        buffer[BVY + at] = rows[VY, j]
        buffer[BUX + at] = rows[UX, j]
        buffer[BUY + at] = rows[UY, j]
        who[at] = j
        dx = max(max(box[0] - x, x - box[1]), 0.0)
        dy = max(max(box[2] - y, y - box[3]), 0.0)
        at += dx * dx + dy * dy <= reach_2  # the next one overwrites whom nobody can feel
    return at


@inlined
def _meet_candidates(
    rows: NDArray[np.float64], begin: int, end: int, segments: NDArray[np.int64], count: int,
    who: NDArray[np.int64], buffer: NDArray[np.float64], c: PairConstants,
) -> int:
    """The forces between the rows begin ... end - 1 and the later ones in the ``segments``.

    Args:
        rows: the workspace, sorted by cell.
        begin: first row of the tile, and of the first segment.
        end: last row of the tile, plus one.
        segments: (2, at least count) first row, and last row plus one; consumed.
        count: how many segments.
        who: scratch.
        buffer: what does not fit into it is met in several goes.
        c: the constants.

    Returns:
        How many pairs coincide and were left out.
    """
    box = _bounds(rows, begin, end)
    coincident, segment = 0, 0
    while segment < count:
        used = 0
        while segment < count and used < _ROOM:
            start = segments[0, segment]
            stop = min(segments[1, segment], start + _ROOM - used)
            used = _borrow(rows, buffer, who, used, start, stop, box, c.r_max_2 * _SAFE)
            segments[0, segment] = stop
            segment += stop == segments[1, segment]
        for k in range(used + BLOCK):
            buffer[BACK_X + k] = 0.0
            buffer[BACK_Y + k] = 0.0
        for i in range(begin, end):
            start = max(0, i + 1 - who[0])  # in the own strip only those after i
            if start < used:
                coincident += _meet(rows, i, buffer, start, used, c)
        for k in range(used):
            rows[FX, who[k]] += buffer[BACK_X + k]
            rows[FY, who[k]] += buffer[BACK_Y + k]
    return coincident


@inlined
def _find_segments(
    first: NDArray[np.int64], segments: NDArray[np.int64], strip: int, left: int, begin: int,
    columns: int, strips: int, per_x: float, per_y: float, reach: float,
) -> int:
    """The rows within reach of a tile, strip by strip upwards; how many segments they make."""
    right = min(left + _TILE, columns) - 1
    count = 0
    for above in range(min(int(reach * per_y) + 2, strips - strip)):
        gap = max(0, above - 1) / per_y
        if gap >= reach:
            break
        margin = int(math.sqrt(reach * reach - gap * gap) * per_x) + 1
        base = (strip + above) * columns
        start = begin if above == 0 else first[base + max(left - margin, 0)]
        stop = first[base + min(right + margin, columns - 1) + 1]
        if stop > start:
            segments[0, count] = start
            segments[1, count] = stop
            count += 1
    return count


@kernel
def add_near_pairs(
    rows: NDArray[np.float64], index: NDArray[np.int64], buffer: NDArray[np.float64],
    position: NDArray[np.float64], velocity: NDArray[np.float64], constants: NDArray[Any],
) -> None:
    """Fill the rows sorted by cell and add the forces of the pairs within reach.

    A function of its own in machine code: inlined into the step, its loops lose their registers.
    """
    c = pair_constants(constants[0])
    n, reach = position.shape[0], constants[0].r_max * _SAFE
    x_0, x_1, y_0, y_1 = position[0, 0], position[0, 0], position[0, 1], position[0, 1]
    for i in range(n):
        x_0, x_1 = min(x_0, position[i, 0]), max(x_1, position[i, 0])
        y_0, y_1 = min(y_0, position[i, 1]), max(y_1, position[i, 1])
    per_x, per_y = _cell_sizes(x_1 - x_0, y_1 - y_0, reach, index.shape[1] - 2)
    columns, strips = int((x_1 - x_0) * per_x) + 1, int((y_1 - y_0) * per_y) + 1
    _sort(index, position, x_0, y_0, per_x, per_y, columns, columns * strips)
    order, first = index[0], index[2]
    # after the sort, the cell of each pedestrian is no longer needed
    segments, who = index[1, :16].reshape(2, 8), index[1, 16 : 16 + STRIDE]
    fill(rows, order, position, velocity)
    for strip in range(strips):
        for left in range(0, columns, _TILE):
            begin = first[strip * columns + left]
            end = first[strip * columns + min(left + _TILE, columns)]
            if begin == end:
                continue
            count = _find_segments(
                first, segments, strip, left, begin, columns, strips, per_x, per_y, reach
            )
            if _meet_candidates(rows, begin, end, segments, count, who, buffer, c) > 0:
                for i in range(begin, end):
                    add_coincident(rows, order, i, n, c)
