"""Plain tuples of arrays that Python passes to the kernels, and the columns of vehicles."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import kernel

#: The arrays that Python passes to a kernel, as one plain tuple.
Arrays = tuple[NDArray[Any], ...]


#: Columns of the array of vehicles.
X, Y, HEADING, SPEED, FRONT, REAR, WIDTH = range(7)


@kernel
def extent(mask: NDArray[np.bool_], start: NDArray[np.int64]) -> tuple[int, int]:
    """Return the number of people in ``mask`` (n,), and that of their way-points."""
    n, total = 0, 0
    for i in range(len(mask)):
        if mask[i]:
            n += 1
            total += start[i + 1] - start[i]
    return n, total


@kernel
def select_into(arrays: tuple[NDArray[Any], ...], mask: NDArray[np.bool_], to: Arrays) -> int:
    """Copy the people in ``mask``, in the same order, and return their ``Crowd.signals``.

    Args:
        arrays: ``Crowd.state`` and ``Crowd.fixed_arrays``.
        mask: Marks (n,) of the people who are copied.
        to: The same arrays of the copy, filled.
    """
    position, velocity, index, desired_speed, priority, waypoints, passage, signal, start = arrays
    x, v, at, wanted, relying, points, lines, lights, offsets = to
    k, signals = 0, 0
    offsets[0] = 0
    for i in range(len(mask)):
        if not mask[i]:
            continue
        x[k, 0], x[k, 1] = position[i, 0], position[i, 1]
        v[k, 0], v[k, 1] = velocity[i, 0], velocity[i, 1]
        wanted[k], at[k], relying[k] = desired_speed[i], index[i], priority[i]
        shift = offsets[k] - start[i]
        for p in range(start[i], start[i + 1]):
            q = p + shift
            points[q, 0], points[q, 1] = waypoints[p, 0], waypoints[p, 1]
            lines[q, 0], lines[q, 1] = passage[p, 0], passage[p, 1]
            lines[q, 2] = passage[p, 2]
            lights[q] = signal[p]
            signals = max(signals, signal[p] + 1)
        k += 1
        offsets[k] = shift + start[i + 1]
    return signals
