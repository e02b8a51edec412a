"""Student's intervals of means, as far as they are possible."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtrit  # all of scipy.stats takes a second to load


def possible(interval: tuple[float, float], least: float = 0.0) -> tuple[float, float]:
    """An interval of a mean without what cannot be: neither times nor clearances are below 0.

    Student's interval knows no bounds. Where bodies overlapped, ``least``, the least value that was
    measured, is below 0 and bounds it instead.
    """
    low, high = interval
    return max(low, min(least, 0.0)), high


def mean_interval(values: NDArray[np.float64], confidence: float) -> tuple[float, float]:
    """Return Student's interval of a mean.

    It is the mean itself if there is one value, or all are equal.
    """
    mean = float(values.mean())
    if values.size < 2:
        return mean, mean
    half = float(stdtrit(values.size - 1, (1.0 + confidence) / 2.0))
    half *= float(values.std(ddof=1)) / math.sqrt(values.size)
    return mean - half, mean + half
