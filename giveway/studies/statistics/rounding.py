"""Numbers as tables hold them, and arithmetic that no size of them upsets."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

DECIMALS = 6
_DIGITS = 6
_PROBABILITIES = frozenset({"p_value", "q_value"})
_COARSE = 1e9  # beyond it a double's last digit is larger than the sixth decimal


def to_decimals(values: Array) -> Array:
    """``values`` to six decimals, without negative zeros."""
    fine = np.abs(values) < _COARSE
    return np.asarray(np.where(fine, np.round(np.where(fine, values, 0.0), DECIMALS), values) + 0.0)


def tabulated(frame: pd.DataFrame, columns: list[str]) -> pd.DataFrame:
    """``frame`` as it is written: six decimals, probabilities with six significant digits.

    What a table holds in memory is thus what is read back from its file.
    """
    for name in columns:
        values = frame[name].to_numpy(np.float64)
        if name in _PROBABILITIES:
            frame[name] = [float(f"{value:.{_DIGITS}g}") for value in values]
        else:
            frame[name] = to_decimals(values)
    return frame


def scale_of(values: Array) -> float:
    """A power of two near the largest magnitude: dividing by it costs no bit, sums stay finite."""
    largest = float(np.max(np.abs(values), initial=0.0))
    exponent = math.frexp(largest)[1] - 1  # the largest double itself has no power of two above
    return math.ldexp(1.0, max(exponent, -1000)) if largest > 0.0 else 1.0


def mean(values: Array) -> float:
    """The mean of finite numbers, however large."""
    scale = scale_of(values)
    return float(np.mean(values / scale)) * scale


def median(values: Array) -> float:
    """The median of finite numbers, however large."""
    scale = scale_of(values)
    return float(np.median(values / scale)) * scale
