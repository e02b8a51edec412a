"""The workspace of a step: one row per quantity, so that every loop reads contiguous memory.

Pedestrians are copied in (sorted by cell when there are many) and the rows are padded with
far-away dummies, so that vector loops need no scalar tail.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from pedestrian_model._jit import inlined

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: Width of the blocks in which pairs are evaluated and summed, whatever the machine's vectors:
#: the order of the sums, and so the result, depends on it.
BLOCK = 8

# fmt: off
(PX, PY, VX, VY, UX, UY,        # position, velocity, direction of the velocity
 FX, FY,                        # force from the other pedestrians
 VFX, VFY, S,                   # force from the vehicles, signed distance to their contours
 TX, TY, V0,                    # target, desired speed
 PAIR_X, PAIR_Y, LANE_X, LANE_Y,  # scratch of the pair loop
 NX, NY, NVX, NVY,              # next state
 ROWS) = range(23)
# fmt: on

_FAR = 1e12  # [m] a dummy's coordinates: beyond any cut-off, its square far from overflow


def row_length(n: int) -> int:
    """Length of the rows for n pedestrians: whole blocks, and one more for a run that overshoots."""
    return (n + BLOCK - 1) // BLOCK * BLOCK + 2 * BLOCK


def rows_for(n: int) -> NDArray[np.float64]:
    """A workspace for n pedestrians."""
    return np.zeros((ROWS, row_length(n)))


def order_for(n: int) -> NDArray[np.int64]:
    """Scratch of the cell list for n pedestrians: order, cell of each, first of each cell."""
    return np.zeros((3, CELLS_PER_PEDESTRIAN * n + 64), dtype=np.int64)


#: The cell list never has more cells than this times the number of pedestrians (plus 62).
CELLS_PER_PEDESTRIAN = 8


@inlined
def fill(
    rows: NDArray[np.float64],
    order: NDArray[np.int64],
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
) -> None:
    """Copy the state into the rows in ``order``, pad them, and clear the forces."""
    n = position.shape[0]
    for k in range(n):
        i = order[k]
        rows[PX, k] = position[i, 0]
        rows[PY, k] = position[i, 1]
        rows[VX, k] = velocity[i, 0]
        rows[VY, k] = velocity[i, 1]
    for k in range(n, n + 2 * BLOCK):
        rows[PX, k] = _FAR
        rows[PY, k] = _FAR
        rows[VX, k] = 0.0
        rows[VY, k] = 0.0
    for k in range(n + 2 * BLOCK):
        vx, vy = rows[VX, k], rows[VY, k]
        speed = math.sqrt(vx * vx + vy * vy)
        inverse = 1.0 / speed if speed > 0.0 else 0.0
        rows[UX, k] = vx * inverse
        rows[UY, k] = vy * inverse
        rows[FX, k] = 0.0
        rows[FY, k] = 0.0
        rows[VFX, k] = 0.0
        rows[VFY, k] = 0.0
        rows[S, k] = np.inf
