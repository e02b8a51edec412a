"""Draws bounded random numbers, for quantities that physics or a proof bounds."""

import numpy as np
from numpy.typing import NDArray

BOUND = 2.0
"""Number of standard deviations at which the normal distribution is cut off, on each axis."""


def planar_noise(random: np.random.Generator, count: int) -> NDArray[np.float64]:
    """Draw numbers (count, 2) from a normal distribution that is cut off at ``BOUND``.

    A number outside the bound is drawn again. The standard deviation of the result is 0.88.
    """
    noise = random.standard_normal((count, 2))
    outside = np.abs(noise) > BOUND
    while outside.any():
        noise[outside] = random.standard_normal(np.count_nonzero(outside))
        outside = np.abs(noise) > BOUND
    return noise
