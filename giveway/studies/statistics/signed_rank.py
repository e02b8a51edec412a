"""Whether differences lie to one side of zero: Wilcoxon's signed-rank test.

Written out, as scipy's choice between exact, permuted and normal changes from version to version,
and permuting few differences with ties takes it a quarter of a second.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import ndtr

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_EXACT = 50  # pairs up to which every assignment of signs is counted


@dataclass(frozen=True)
class SignedRank:
    """What the test says.

    Attributes:
        statistic: smaller one of the two signed-rank sums.
        p_value: two-sided.
        direction: to which side of zero the ranks lean, 1 or -1; 0: to none.
    """

    statistic: float
    p_value: float
    direction: int


def signed_rank(differences: Array) -> SignedRank:
    """Wilcoxon's test of paired differences, zeros by Pratt's method.

    Zeros are ranked and then left out of the sums (Pratt 1959, J. Am. Stat. Assoc. 54, 655-667):
    two runs without any overlap are a finding that both sides are equal, of which dropping zeros
    before ranking would take no notice. If all differences are zero, p is 1.

    Args:
        differences: finite numbers (n,), at least one.
    """
    ranks = _ranks(np.abs(differences))[differences != 0.0]
    signs = np.sign(differences[differences != 0.0])
    positive = float(np.sum(ranks[signs > 0.0]))
    negative = float(np.sum(ranks[signs < 0.0]))
    statistic = min(positive, negative)
    exact = differences.size <= _EXACT
    p = _exact_p(ranks, statistic) if exact else _normal_p(ranks, statistic)
    return SignedRank(statistic, p, int(np.sign(positive - negative)))


def _ranks(magnitudes: Array) -> Array:
    """1, 2, ... by size; equal ones share the mean of their ranks."""
    _, place, counts = np.unique(magnitudes, return_inverse=True, return_counts=True)
    ends = np.cumsum(counts)
    return np.asarray((ends - (counts - 1) / 2.0)[place], dtype=np.float64)


def _exact_p(ranks: Array, statistic: float) -> float:
    """Twice the share of all 2^n assignments of signs whose positive sum is so small, or less.

    With ties and zeros the distribution is that of these very ranks; twice a rank is whole.
    """
    doubled = np.rint(2.0 * ranks).astype(np.int64)
    share = np.zeros(int(doubled.sum()) + 1)
    share[0] = 1.0
    for rank in doubled:  # with a positive sign the sum is larger by the rank
        share[rank:] = 0.5 * (share[rank:] + share[: share.size - rank])
        share[:rank] *= 0.5
    return min(1.0, 2.0 * float(np.sum(share[: round(2.0 * statistic) + 1])))


def _normal_p(ranks: Array, statistic: float) -> float:
    """The same for many differences: the sum has half the ranks' sum as its mean.

    Its variance, a quarter of their squares' sum, contains the corrections for ties and for
    Pratt's zeros (Cureton 1967, J. Am. Stat. Assoc. 62, 1068-1069).
    """
    deviation = 0.5 * float(np.sqrt(np.sum(ranks**2)))
    if deviation == 0.0:
        return 1.0
    return min(1.0, 2.0 * float(ndtr((statistic - 0.5 * float(np.sum(ranks))) / deviation)))


def q_values(p_values: Array) -> Array:
    """The false discovery rate at which each test is just rejected.

    Benjamini & Hochberg 1995, J. R. Stat. Soc. B 57, 289-300.

    Args:
        p_values: (m,); nan where there was no test, which does not count as one.
    """
    q = np.full(p_values.size, np.nan)
    tested = np.flatnonzero(np.isfinite(p_values))
    order = tested[np.argsort(p_values[tested], kind="stable")]
    raised = p_values[order] * tested.size / np.arange(1, tested.size + 1)
    q[order] = np.minimum.accumulate(raised[::-1])[::-1]
    return q
