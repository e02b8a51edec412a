"""The positions and their spread that ``drift`` predicts from its corrections."""

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import kernel
from pedestrian_model.drift.forest import HORIZONS

Array = NDArray[np.float64]


@kernel
def fill_positions(
    position: Array,
    velocity: Array,
    heading: Array,
    corrections: Array,
    time_step: float,
    out: Array,
) -> None:
    """Fill the predicted positions.

    Between the horizons of the trees, corrections are interpolated; before the first and after the
    last one they are those of that horizon.

    Args:
        position: Present positions (n, 2) [m].
        velocity: Present velocities (n, 2) [m/s].
        heading: Headings (n, 2).
        corrections: Corrections (n, 3, 2) [m/s] along and across the heading.
        time_step: Time [s] from step to step.
        out: Positions (N, n, 2) [m] at steps 1 ... N, filled.
    """
    for step in range(out.shape[0]):
        time = (step + 1) * time_step
        after = 1 if time <= HORIZONS[1] else 2
        first, last = HORIZONS[after - 1], HORIZONS[after]
        share = min(max((time - first) / (last - first), 0.0), 1.0)
        for i in range(out.shape[1]):
            before, then = corrections[i, after - 1], corrections[i, after]
            along = (1.0 - share) * before[0] + share * then[0]
            across = (1.0 - share) * before[1] + share * then[1]
            c, s = heading[i, 0], heading[i, 1]
            out[step, i, 0] = position[i, 0] + time * (velocity[i, 0] + c * along - s * across)
            out[step, i, 1] = position[i, 1] + time * (velocity[i, 1] + s * along + c * across)


def spread(deviation: Array, speed: Array, times: Array) -> Array:
    """Return the standard deviations (N, n, 2) [m] along and across the heading.

    Args:
        deviation: Coefficients (3, 2, 2) a, b of a + b * speed, in [m] and [s], for each horizon
            and axis.
        speed: Present speeds (n,) [m/s].
        times: Times (N,) [s] ahead, between which the spread grows linearly.
    """
    at = deviation[:, None, :, 0] + deviation[:, None, :, 1] * speed[:, None]  # (3, n, 2)
    known = np.concatenate([np.zeros((1, *at.shape[1:])), at])
    nodes = np.array((0.0, *HORIZONS))
    after = np.clip(np.searchsorted(nodes, times), 1, len(nodes) - 1)
    share = ((times - nodes[after - 1]) / (nodes[after] - nodes[after - 1]))[:, None, None]
    between: Array = (1.0 - share) * known[after - 1] + share * known[after]
    return between
