"""The scratch memory of a step: one row per quantity, so that every loop reads contiguous memory.

Pedestrians are copied into the rows (sorted by cell when there are many), which are padded with
far-away dummies, so that vector loops need no scalar tail. The pair loops work in a small buffer
whose rows lie a constant ``STRIDE`` apart: the compiler then sees that they do not overlap.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import inlined
from pedestrian_model.arrays import Arrays

#: Width of the blocks in which pairs are evaluated and summed, whatever the machine's vectors:
#: the order of the sums, and so the result, depends on it.
BLOCK = 8

# fmt: off
#: The rows of the workspace.
(PX, PY, VX, VY, UX, UY,  # position, velocity, direction of the velocity
 FX, FY,                  # force from the other pedestrians
 VFX, VFY, S,             # force from the vehicles, signed distance to their contours
 TX, TY, V0, SOFT,        # target, desired speed, [m^2] s_des^2 of the target
 WS, WX, WY,              # signed distance to the nearest wall, its normal
 NX, NY, NVX, NVY,        # next state
 PRIORITY,                # 0 to 1; filled where anybody has it
 ROWS) = range(24)
# fmt: on

#: Distance of the buffer's rows, not a multiple of 4096 bytes (cache sets).
STRIDE = 680
#: The largest crowd whose ring fits in the buffer, twice and padded.
LARGEST_RING = (STRIDE - 2 * BLOCK) // 2
#: Offsets of the buffer's rows: as PX ... UY above, then forces on the one and on the others.
BX, BY, BVX, BVY, BUX, BUY, ON_X, ON_Y, BACK_X, BACK_Y = (k * STRIDE for k in range(10))
#: Of the ring besides: as BX ... BUY the ones ahead, and sums of the forces on these.
AHEAD, SUM_X, SUM_Y = (k * STRIDE for k in (10, 16, 17))

#: The cell list never has more cells than this times the number of pedestrians (plus 62).
CELLS_PER_PEDESTRIAN = 16

_FAR = 1e12  # [m] a dummy's coordinates: beyond any cut-off, its square far from overflow


class Scratch(NamedTuple):
    """The memory that a step works in; what it holds before does not matter."""

    rows: NDArray[np.float64]  # (ROWS, padded n)
    sorting: NDArray[np.int64]  # (3, cells): order of the pedestrians, cell of each, first of each
    buffer: NDArray[np.float64]  # (18 STRIDE,) of the pair loops


def aligned(size: int) -> NDArray[np.float64]:
    """(size,) zeros, the first of which begins a line of the processor's memory.

    Where each block of eight lies across two lines, the pair loops take twice the time.
    """
    memory = np.zeros(size + BLOCK)
    skipped = -memory.ctypes.data % (8 * BLOCK) // 8
    return memory[skipped : skipped + size]


class Workspace:
    """The scratch of the kernels, grown when a larger crowd comes.

    Attributes:
        arrays: those of :class:`Scratch`.
    """

    arrays: Arrays

    def __init__(self) -> None:
        self.capacity = -1
        self._buffer = aligned(18 * STRIDE)
        self.reserve(64)

    def reserve(self, n: int) -> None:
        """Have room for n pedestrians."""
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


@inlined
def fill_some(
    rows: NDArray[np.float64],
    order: NDArray[np.int64],
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
    start: int,
    stop: int,
) -> None:
    """Fill the rows start ... stop - 1 as ``fill`` does, and the padding after them.

    Not what ``fill`` calls: the ring's loops become a seventh slower with it.
    """
    for k in range(start, stop):
        i = order[k]
        rows[PX, k] = position[i, 0]
        rows[PY, k] = position[i, 1]
        rows[VX, k] = velocity[i, 0]
        rows[VY, k] = velocity[i, 1]
    for k in range(stop, stop + 2 * BLOCK):
        rows[PX, k] = _FAR
        rows[PY, k] = _FAR
        rows[VX, k] = 0.0
        rows[VY, k] = 0.0
    for k in range(start, stop + 2 * BLOCK):
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
