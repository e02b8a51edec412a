"""The forces of all pairs of a small crowd.

The pedestrians are numbered in a ring. At shift m each pedestrian is paired with the m-th next, for
m = 1 ... n/2, so that each pair occurs once. For one m the loop over the pedestrians is contiguous
for both of a pair, and adds to two different rows of a buffer with fixed offsets.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import add_block, copy_block, fma, inlined, inner
from pedestrian_model.vci.buffers import (
    AHEAD,
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
    STRIDE,
    SUM_X,
    SUM_Y,
    fill,
)
from pedestrian_model.vci.pairs.pair_force import (
    COINCIDENT_2,
    PairConstants,
    add_coincident,
    pair,
    pair_constants,
)


@inlined
def _lay_out(rows: NDArray[np.float64], n: int, buffer: NDArray[np.float64]) -> None:
    """Copy the rows into the buffer twice, one copy after the other, and clear the forces."""
    for row in range(6):
        at = row * STRIDE
        for k in range(n):
            buffer[at + k] = rows[PX + row, k]
            buffer[at + n + k] = rows[PX + row, k]
        for k in range(2 * BLOCK):
            buffer[at + 2 * n + k] = rows[PX + row, n + k]
    for k in range(2 * n + 2 * BLOCK):
        buffer[ON_X + k] = 0.0
        buffer[ON_Y + k] = 0.0
        buffer[SUM_X + k] = 0.0
        buffer[SUM_Y + k] = 0.0


@inlined
def _shift(buffer: NDArray[np.float64], m: int, count: int, c: PairConstants) -> int:
    """Add the forces between the first ``count`` pedestrians of the ring and their m-th next.

    Returns:
        Number of pairs that coincide and were left out.
    """
    padded = (count + BLOCK - 1) // BLOCK * BLOCK
    for row in range(0, 6 * STRIDE, STRIDE):
        for k in range(0, padded, BLOCK):
            copy_block(buffer, AHEAD + row + k, buffer, row + m + k)
    coincident = 0
    for k in range(padded):
        dx = buffer[AHEAD + BX + k] - buffer[BX + k]
        dy = buffer[AHEAD + BY + k] - buffer[BY + k]
        wx = buffer[BVX + k] - buffer[AHEAD + BVX + k]
        wy = buffer[BVY + k] - buffer[AHEAD + BVY + k]
        r_2 = fma(dx, dx, dy * dy)
        r = math.sqrt(r_2)
        apart = r_2 >= COINCIDENT_2
        coincident += (k < count) & (not apart)
        f = pair(
            (dx, dy),
            (r, r - c.two_R),
            (wx, wy),
            (buffer[BUX + k], buffer[BUY + k]),
            (buffer[AHEAD + BUX + k], buffer[AHEAD + BUY + k]),
            (r_2 <= c.r_max_2) & apart & (k < count),
            c,
        )
        buffer[ON_X + k] += f[0]
        buffer[ON_Y + k] += f[1]
        buffer[BACK_X + k] = f[2]
        buffer[BACK_Y + k] = f[3]
    for k in range(0, padded, BLOCK):
        add_block(buffer, SUM_X + m + k, buffer, BACK_X + k)
        add_block(buffer, SUM_Y + m + k, buffer, BACK_Y + k)
    return coincident


@inner
def add_all_pairs(
    rows: NDArray[np.float64],
    index: NDArray[np.int64],
    buffer: NDArray[np.float64],
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
    constants: NDArray[Any],
) -> None:
    """Fill the rows in the given order and add the forces of all pairs."""
    c = pair_constants(constants[0])
    n = position.shape[0]
    order = index[0]
    for i in range(n):
        order[i] = i
    fill(rows, order[:n], position, velocity)
    _lay_out(rows, n, buffer)
    coincident = 0
    for m in range(1, n // 2 + 1):
        # At m = n/2 the second half of the ring would repeat the pairs of the first half.
        coincident += _shift(buffer, m, n if 2 * m < n else n // 2, c)
    for k in range(n):
        rows[FX, k] = buffer[ON_X + k] + (buffer[SUM_X + k] + buffer[SUM_X + n + k])
        rows[FY, k] = buffer[ON_Y + k] + (buffer[SUM_Y + k] + buffer[SUM_Y + n + k])
    if coincident > 0:
        for i in range(n - 1):
            add_coincident(rows, order, i, n, c)
