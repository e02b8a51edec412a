"""Bounded random numbers: a quantity that physics or a proof bounds has no normal tails."""

import numpy as np
from numpy.typing import NDArray

BOUND = 2.0
"""Standard deviations at which the normal distribution is cut off, on each axis."""


def planar_noise(random: np.random.Generator, count: int) -> NDArray[np.float64]:
    """Draw (count, 2) standard normal numbers, each redrawn until within ``BOUND`` of zero.

    Cut off there, their standard deviation is 0.88.
    """
    noise = random.standard_normal((count, 2))
    outside = np.abs(noise) > BOUND
    while outside.any():
        noise[outside] = random.standard_normal(np.count_nonzero(outside))
        outside = np.abs(noise) > BOUND
    return noise
