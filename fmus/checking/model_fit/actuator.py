"""The actuator's model: the commanded force is delayed, then passes a first-order lag.

    tau F'(t) + F(t) = u(t - d)

The mean of F over each step is computed exactly for any tau and d, also fractions of a step: with
Y(t), the integral of the lagged force without dead time, it is (Y(t + h - d) - Y(t - d)) / h.
"""

from itertools import accumulate

import numpy as np
from numpy.typing import NDArray

NEGLIGIBLE = 1e-6  # share of a step below which a lag is ignored


def mean_force(
    force: NDArray[np.float64], step: float, lag: float, delay: float
) -> NDArray[np.float64]:
    """Return the mean (n,) [N] over each step of the acting force, for a commanded force.

    Args:
        force: Commanded force (n,) [N], held over each step; 0 before the first step.
        step: Duration of a step [s].
        lag: Time constant tau of the lag [s].
        delay: Dead time d [s].
    """
    if lag <= NEGLIGIBLE * step:
        lagged, impulse = None, np.concatenate(([0.0], np.cumsum(force) * step))
    else:
        keep = float(np.exp(-step / lag))
        lagged = np.fromiter(
            accumulate(force, lambda F, u: u + (F - u) * keep, initial=0.0),
            np.float64,
            force.size + 1,
        )
        mean = force + (lagged[:-1] - force) * (lag / step) * (1.0 - keep)
        impulse = np.concatenate(([0.0], np.cumsum(mean) * step))
    if delay <= 0.0:
        return np.diff(impulse) / step
    whole = int(delay / step)
    if whole >= force.size:
        return np.zeros_like(force)
    part = delay - whole * step  # [s] of the previous command that still acts
    shifted = np.zeros_like(impulse)
    shifted[whole + 1 :] = _impulse_at(force, lagged, impulse, lag, step - part)[
        : impulse.size - whole - 1
    ]
    return np.diff(shifted) / step


def _impulse_at(
    force: NDArray[np.float64],
    lagged: NDArray[np.float64] | None,
    impulse: NDArray[np.float64],
    lag: float,
    into: float,
) -> NDArray[np.float64]:
    """Return the integral Y (n,) [N s] at ``into`` [s] after the beginning of each step."""
    there: NDArray[np.float64] = impulse[:-1] + force * into
    if lagged is not None:
        there += (lagged[:-1] - force) * lag * -np.expm1(-into / lag)
    return there
