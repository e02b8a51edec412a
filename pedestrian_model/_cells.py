"""Who is near whom: everyone against everyone for a small crowd, a cell list for a large one.

The cell list orders the crowd by cells, row by row ("strips" of cells along x), so that the
neighbours of a pedestrian in one strip are one contiguous run. A pedestrian looks to the right in
his own strip and at all of the strips above within reach: each pair is met once.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from pedestrian_model._jit import inlined
from pedestrian_model._pairs import PairConstants, run
from pedestrian_model._rows import PX, PY, fill

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

# Sizes of a cell relative to the interaction radius, found by benchmarks/bench_crowd.py.
_STRIP = 4.0  # strips per interaction radius
_CELL = 8.0  # cells of a strip per interaction radius
_SAFE = 1.0 + 1e-9  # reach of the search, so that rounding loses nobody


@inlined
def add_all_pairs(
    rows: NDArray[np.float64],
    index: NDArray[np.int64],
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
    c: PairConstants,
) -> None:
    """Fill the rows in the given order and add the forces of all pairs."""
    n = position.shape[0]
    order = index[0]
    for i in range(n):
        order[i] = i
    fill(rows, order, position, velocity)
    for i in range(n - 1):
        run(rows, order, i, i + 1, n, c)


@inlined
def _cell_sizes(
    width: float, height: float, reach: float, most: int
) -> tuple[float, float, int, int]:
    """Inverse length and height of a cell, cells per strip and strips: at most ``most`` cells."""
    per_x, per_y = _CELL / reach, _STRIP / reach
    while (width * per_x + 1.0) * (height * per_y + 1.0) > most:
        per_x *= 0.5
        per_y *= 0.5
    return per_x, per_y, int(width * per_x) + 1, int(height * per_y) + 1


@inlined
def _sort_by_cell(
    index: NDArray[np.int64],
    position: NDArray[np.float64],
    x_0: float,
    y_0: float,
    per_x: float,
    per_y: float,
    columns: int,
    strips: int,
) -> None:
    """Counting sort: index[0] the order, index[2] the first of each cell. Stable: deterministic."""
    n = position.shape[0]
    order, cell, first = index[0], index[1], index[2]
    for k in range(columns * strips + 1):
        first[k] = 0
    for i in range(n):
        column = int((position[i, 0] - x_0) * per_x)
        strip = int((position[i, 1] - y_0) * per_y)
        cell[i] = strip * columns + column
        first[cell[i] + 1] += 1
    for k in range(columns * strips):
        first[k + 1] += first[k]
    for i in range(n):
        order[first[cell[i]]] = i
        first[cell[i]] += 1
    for k in range(columns * strips, 0, -1):
        first[k] = first[k - 1]
    first[0] = 0


@inlined
def add_near_pairs(
    rows: NDArray[np.float64],
    index: NDArray[np.int64],
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
    r_max: float,
    c: PairConstants,
) -> None:
    """Fill the rows sorted by cell and add the forces of the pairs within reach."""
    n = position.shape[0]
    reach = r_max * _SAFE
    x_0, x_1, y_0, y_1 = position[0, 0], position[0, 0], position[0, 1], position[0, 1]
    for i in range(n):
        x_0, x_1 = min(x_0, position[i, 0]), max(x_1, position[i, 0])
        y_0, y_1 = min(y_0, position[i, 1]), max(y_1, position[i, 1])
    per_x, per_y, columns, strips = _cell_sizes(
        x_1 - x_0, y_1 - y_0, reach, index.shape[1] - 2
    )
    _sort_by_cell(index, position, x_0, y_0, per_x, per_y, columns, strips)
    order, first = index[0], index[2]
    fill(rows, order, position, velocity)
    for i in range(n):
        x, y = rows[PX, i], rows[PY, i]
        strip = int((y - y_0) * per_y)
        last = min(int((x - x_0 + reach) * per_x), columns - 1)
        run(rows, order, i, i + 1, first[strip * columns + last + 1], c)
        highest = min(int((y - y_0 + reach) * per_y), strips - 1)
        for above in range(strip + 1, highest + 1):
            gap = max(0.0, above / per_y + y_0 - y - reach * 1e-6)
            half = math.sqrt(max(0.0, reach * reach - gap * gap)) + reach * 1e-6
            left = max(int((x - x_0 - half) * per_x), 0)
            right = min(int((x - x_0 + half) * per_x), columns - 1)
            start, stop = first[above * columns + left], first[above * columns + right + 1]
            if stop > start:
                run(rows, order, i, start, stop, c)
