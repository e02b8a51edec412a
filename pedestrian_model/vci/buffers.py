"""The scratch memory of a step, with one row per quantity.

Pedestrians are copied into the rows, sorted by cell if there are many. The rows are padded with
dummies far away, so that all loops cover whole blocks. The pair loops work in a small buffer whose
rows have the constant distance ``STRIDE``.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import inlined
from pedestrian_model.arrays import Arrays

#: Width of the blocks in which pairs are evaluated and summed on every machine. The order of the
#: sums, and so the result, depends on it.
BLOCK = 8

# fmt: off
#: The rows of the workspace.
(PX, PY, VX, VY, UX, UY,  # position, velocity, direction of the velocity
 FX, FY,                  # force from the other pedestrians
 VFX, VFY, S,             # force from the vehicles, signed distance to their contours
 TX, TY, V0, SOFT,        # target, desired speed, [m^2] s_des^2 of the target
 WS, WX, WY,              # signed distance to the nearest wall, its normal (or to a closed line)
 MOST,                    # largest total force along WX, WY
 NX, NY, NVX, NVY,        # next state
 PRIORITY,                # 0 to 1; filled if anybody has priority
 ROWS) = range(25)
# fmt: on

#: Distance of the buffer's rows, in float64; not a multiple of 4096 bytes.
STRIDE = 680
#: Largest crowd of the all-pairs loops, which need every person twice in a row, with padding.
LARGEST_RING = (STRIDE - 2 * BLOCK) // 2
#: Offsets of the buffer's rows: PX ... UY as above, then forces on one person and on the others.
BX, BY, BVX, BVY, BUX, BUY, ON_X, ON_Y, BACK_X, BACK_Y = (k * STRIDE for k in range(10))
#: Further offsets for all pairs: BX ... BUY of the people ahead, and sums of the forces on them.
AHEAD, SUM_X, SUM_Y = (k * STRIDE for k in (10, 16, 17))

#: Largest number of cells of the cell list per pedestrian (plus 62).
CELLS_PER_PEDESTRIAN = 16

_FAR = 1e12  # coordinates [m] of a dummy: beyond any cut-off, without overflow of their squares


class Scratch(NamedTuple):
    """The memory that a step works in. Its contents before the step do not matter."""

    rows: NDArray[np.float64]  # quantities (ROWS, padded n)
    sorting: NDArray[np.int64]  # (3, cells): order of the people, cell of each, first of each cell
    buffer: NDArray[np.float64]  # buffer (18 STRIDE,) of the pair loops


def aligned(size: int) -> NDArray[np.float64]:
    """Return zeros (size,) that begin at a cache line."""
    memory = np.zeros(size + BLOCK)
    skipped = -memory.ctypes.data % (8 * BLOCK) // 8
    return memory[skipped : skipped + size]


class Workspace:
    """The scratch memory of the kernels, which grows with the crowd.

    Attributes:
        arrays: Arrays of :class:`Scratch`.
    """

    arrays: Arrays

    def __init__(self) -> None:
        self.capacity = -1
        self._buffer = aligned(18 * STRIDE)
        self.reserve(64)

    def reserve(self, n: int) -> None:
        """Make room for n pedestrians."""
        if n > self.capacity:
            self.capacity = max(n, 2 * self.capacity)
            columns = (self.capacity + BLOCK - 1) // BLOCK * BLOCK + 2 * BLOCK
            rows = aligned(ROWS * columns).reshape(ROWS, columns)
            index = np.zeros((3, CELLS_PER_PEDESTRIAN * self.capacity + 64), dtype=np.int64)
            self.arrays = tuple(Scratch(rows, index, self._buffer))


@inlined
def fill(
    rows: NDArray[np.float64],
    order: NDArray[np.int64],
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
) -> None:
    """Copy the state into the rows in the given order, pad the rows, and clear the forces.

    Row k is that of pedestrian ``order[k]``. All loops count from 0: an index that could be
    negative keeps a loop from becoming vector instructions.
    """
    n = order.shape[0]
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
