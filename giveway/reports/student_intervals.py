"""Student's intervals of means, without impossible values."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtrit  # a part of scipy.stats that loads quickly


def possible(interval: tuple[float, float]) -> tuple[float, float]:
    """Return an interval of a mean without impossible values: no time or count is negative."""
    low, high = interval
    return max(low, 0.0), high


def mean_interval(values: NDArray[np.float64], confidence: float) -> tuple[float, float]:
    """Return Student's interval of a mean.

    It is the mean itself if there is only one value, or all values are equal.
    """
    mean = float(values.mean())
    if values.size < 2:
        return mean, mean
    half = float(stdtrit(values.size - 1, (1.0 + confidence) / 2.0))
    half *= float(values.std(ddof=1)) / math.sqrt(values.size)
    return mean - half, mean + half
