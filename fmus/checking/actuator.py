"""From the force commanded to the force at the wheels: dead time, then a first-order lag.

    tau F'(t) + F(t) = u(t - d)

The mean of F over each step is computed exactly for any tau and d, also fractions of a step: with
Y(t), the integral of the lagged force without dead time, it is (Y(t + h - d) - Y(t - d)) / h.
"""

from itertools import accumulate

import numpy as np
from numpy.typing import NDArray

NEGLIGIBLE = 1e-6  # share of a step: a shorter lag is ignored


def mean_force(
    force: NDArray[np.float64], step: float, lag: float, delay: float
) -> NDArray[np.float64]:
    """(n,) [N] mean over each step of the force that acts, from what is commanded.

    Args:
        force: (n,) commanded, held over each step [N]; nothing acts before.
        step: [s].
        lag: tau [s].
        delay: d [s].
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
    part = delay - whole * step  # [s] of the step before that still acts
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
    """(n,) [N s] Y at ``into`` [s] after each step's begin."""
    there: NDArray[np.float64] = impulse[:-1] + force * into
    if lagged is not None:
        there += (lagged[:-1] - force) * lag * -np.expm1(-into / lag)
    return there
