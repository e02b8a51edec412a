"""Rounding as in tables, and means and medians that do not overflow."""

import math
from collections.abc import Collection, Iterable

import numpy as np
import pandas as pd

from giveway.geometry.kernel import Array

DECIMALS = 6
_PER_ONE = 10.0**DECIMALS
_DIGITS = 6
PROBABILITIES = frozenset({"p_value", "q_value"})
_COARSE = 1e9  # Magnitude from which a double does not resolve the sixth decimal


def to_decimals(values: Array) -> Array:
    """Return ``values`` rounded to six decimals, without negative zeros."""
    fine = np.abs(values) < _COARSE
    return np.asarray(np.where(fine, np.round(np.where(fine, values, 0.0), DECIMALS), values) + 0.0)


def tabulated(
    frame: pd.DataFrame, names: Iterable[str], probabilities: Collection[str] = PROBABILITIES
) -> pd.DataFrame:
    """Round ``frame`` as in files: to six decimals, probabilities to six significant digits.

    Therefore a table in memory equals the table that is read from its file.

    Args:
        frame: Table of numbers and words; it is changed.
        names: Names of the columns with numbers, which become floats.
        probabilities: Names of the columns with probabilities.
    """
    for name in names:
        values = frame[name].to_numpy(np.float64)
        if name in probabilities:
            frame[name] = [float(f"{value:.{_DIGITS}g}") for value in values]
        else:
            frame[name] = to_decimals(values)
    return frame


def in_units(values: Array) -> tuple[Array, float]:
    """Return finite numbers as whole numbers, whose sums are exact and equal in any order.

    Returns:
        ``values`` in units of the sixth decimal, and the number of units in 1. Numbers beyond 1e9
        are only scaled, by a power of two that keeps their sums finite.
    """
    largest = float(np.max(np.abs(values), initial=0.0))
    if largest < _COARSE:
        return np.rint(values * _PER_ONE), _PER_ONE
    per_one = math.ldexp(1.0, 1 - math.frexp(largest)[1])
    return values * per_one, per_one


def mean(values: Array) -> float:
    """Return the mean of finite numbers, however large they are."""
    whole, per_one = in_units(values)
    return float(np.sum(whole)) / whole.size / per_one


def median(values: Array) -> float:
    """Return the median of finite numbers, however large they are."""
    whole, per_one = in_units(values)
    return float(np.median(whole)) / per_one
