"""Wilcoxon's signed-rank test of scipy: whether differences lie to one side of zero."""

from dataclasses import dataclass

import numpy as np
import scipy  # scipy.stats is loaded where it is first used

from giveway.geometry.kernel import Array

_EXACT = 50  # Largest number of differences for the exact distribution


@dataclass(frozen=True)
class SignedRank:
    """The result of the test.

    Attributes:
        statistic: Smaller one of the two signed-rank sums.
        p_value: Two-sided p-value.
        direction: Side of zero to which the ranks lean, 1 or -1; 0 for neither.
    """

    statistic: float
    p_value: float
    direction: int


def signed_rank(differences: Array) -> SignedRank:
    """Wilcoxon's test of paired differences, with zeros by Pratt's method.

    Zeros are ranked and then left out of the sums (Pratt 1959, J. Am. Stat. Assoc. 54, 655-667).
    Two runs without any overlap show that both sides are equal, which would be ignored if zeros
    were left out before the ranking. If all differences are zero, p is 1.

    The method is given explicitly, since scipy's own choice changes from version to version. It is
    exact for few differences without zeros and ties, for which scipy's distribution holds;
    otherwise it is the normal approximation with corrections for zeros, ties and continuity.

    Args:
        differences: Finite numbers (n,), at least one.
    """
    if not differences.any():
        return SignedRank(0.0, 1.0, 0)
    magnitudes = np.abs(differences)
    distinct = magnitudes.all() and np.unique(magnitudes).size == magnitudes.size
    method = "exact" if distinct and magnitudes.size <= _EXACT else "asymptotic"
    found = scipy.stats.wilcoxon(differences, zero_method="pratt", correction=True, method=method)
    leaning = np.sign(differences) @ scipy.stats.rankdata(magnitudes)
    return SignedRank(float(found.statistic), float(found.pvalue), int(np.sign(leaning)))


def q_values(p_values: Array) -> Array:
    """Return the false discovery rate at which each test is just rejected.

    Benjamini & Hochberg 1995, J. R. Stat. Soc. B 57, 289-300.

    Args:
        p_values: Values (m,), or nan if there was no test, which then does not count.
    """
    q = np.full(p_values.size, np.nan)
    tested = np.isfinite(p_values)
    if tested.any():
        q[tested] = scipy.stats.false_discovery_control(p_values[tested])
    return q
