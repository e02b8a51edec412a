"""Whether differences lie to one side of zero: Wilcoxon's signed-rank test."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from giveway.studies.statistics.rounding import scale_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


@dataclass(frozen=True)
class SignedRank:
    """What the test says.

    Attributes:
        statistic: smaller one of the two signed-rank sums.
        p_value: two-sided.
        direction: sign of the larger sum: to which side of zero the ranks lean; 0: to none.
    """

    statistic: float
    p_value: float
    direction: int


def signed_rank(differences: Array) -> SignedRank:
    """Wilcoxon's test of paired differences, zeros by Pratt's method.

    Zeros are ranked and then left out of the sums (Pratt 1959): two runs without any overlap are a
    finding that both sides are equal, which dropping zeros before ranking would take no notice of.
    The null distribution is exact for few differences and normal, with corrections for ties and
    zeros, for many, as scipy chooses.

    Args:
        differences: finite numbers (n,), at least one.
    """
    if not differences.any():
        return SignedRank(0.0, 1.0, 0)
    from scipy.stats import rankdata, wilcoxon

    scaled = differences / scale_of(differences)
    result = wilcoxon(scaled, zero_method="pratt")
    lean = float(np.sum(np.sign(scaled) * rankdata(np.abs(scaled))))
    return SignedRank(float(result.statistic), float(result.pvalue), int(np.sign(lean)))


def q_values(p_values: Array) -> Array:
    """Benjamini & Hochberg 1995: the false discovery rate at which each test is just rejected.

    Args:
        p_values: (m,); nan where there was no test, which does not count as one.
    """
    from scipy.stats import false_discovery_control

    q = np.full(p_values.size, np.nan)
    tested = np.isfinite(p_values)
    if tested.any():
        q[tested] = false_discovery_control(p_values[tested])
    return q
