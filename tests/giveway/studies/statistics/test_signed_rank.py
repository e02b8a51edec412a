"""Wilcoxon's test against its table, Pratt's zeros, and Benjamini and Hochberg's own example."""

import math
from statistics import NormalDist

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose

from giveway.studies.statistics.signed_rank import q_values, signed_rank

whole = arrays(np.float64, st.integers(1, 60), elements=st.integers(-9, 9).map(float))


def with_negative_ranks(n: int, total: int) -> np.ndarray:
    """Differences 1 ... n, of which the negative ones have ranks that add up to ``total``."""
    differences = np.arange(1.0, n + 1)
    for rank in range(n, 0, -1):
        if rank <= total:
            differences[rank - 1] *= -1.0
            total -= rank
    return differences


@pytest.mark.parametrize(
    ("n", "critical"), [(6, 0), (8, 3), (10, 8), (12, 13), (15, 25), (20, 52), (25, 89)]
)
def test_critical_values_of_the_table(n: int, critical: int) -> None:
    """The largest rank sum that is significant at 5 %, two-sided, from the textbooks' table."""
    at = signed_rank(with_negative_ranks(n, critical))
    beyond = signed_rank(with_negative_ranks(n, critical + 1))
    assert at.statistic == critical
    assert at.p_value <= 0.05 < beyond.p_value


def test_many_differences_with_ties_and_zeros_follow_pratt() -> None:
    """The normal approximation with Pratt's zeros (Cureton 1967) and continuity, written out.

    60 zeros, 40 times +1 and 20 times -1: ranks 1 ... 60 go to the zeros and are left out, all
    others share rank 90.5.
    """
    differences = np.repeat([0.0, 1.0, -1.0], [60, 40, 20])
    found = signed_rank(differences)
    n, zeros, tied = 120, 60, 60
    expected = n * (n + 1) / 4 - zeros * (zeros + 1) / 4
    squares = n * (n + 1) * (2 * n + 1) - zeros * (zeros + 1) * (2 * zeros + 1)
    deviation = math.sqrt((squares - (tied**3 - tied) / 2) / 24)
    z = (40 * 90.5 - expected - 0.5) / deviation
    assert found.statistic == 20 * 90.5
    assert found.direction == 1
    assert_allclose(found.p_value, 2 * NormalDist().cdf(-z), rtol=1e-9)


@pytest.mark.parametrize("n", [10, 30, 100])
def test_if_all_differences_are_tied_p_is_at_least_half_exact(n: int) -> None:
    """The worst case of the approximation; with one rank for all, the exact test is binomial."""
    for negative in range(n // 2):
        exact = 2 * sum(math.comb(n, k) for k in range(negative + 1)) / 2**n
        found = signed_rank(np.where(np.arange(n) < negative, -1.0, 1.0))
        assert found.direction == 1
        if exact > 1e-3:
            assert 0.5 < found.p_value / exact < 1.5


def test_exact_and_normal_meet_where_one_takes_over() -> None:
    """50 differences without a tie are counted out, 51 approximated: the same finding."""
    few, more = (signed_rank(with_negative_ranks(n, n * (n + 1) // 3)) for n in (50, 51))
    assert few.p_value == pytest.approx(more.p_value, rel=0.05)


def test_no_difference_at_all_is_no_finding() -> None:
    found = signed_rank(np.zeros(50))
    assert (found.statistic, found.p_value, found.direction) == (0.0, 1.0, 0)


def test_largest_numbers_do_not_upset_it() -> None:
    assert signed_rank(np.array([1.7e308] * 30)).p_value < 1e-6


@pytest.mark.filterwarnings("error")
@given(whole)
def test_negated_differences_lean_to_the_other_side(differences: np.ndarray) -> None:
    there, back = signed_rank(differences), signed_rank(-differences)
    assert (back.statistic, back.direction) == (there.statistic, -there.direction)
    assert_allclose(back.p_value, there.p_value, rtol=1e-9)
    assert 0.0 <= there.p_value <= 1.0


@given(whole, st.integers(-20, 20))
def test_unit_does_not_matter(differences: np.ndarray, power: int) -> None:
    assert signed_rank(differences * 2.0**power) == signed_rank(differences)


def test_example_of_benjamini_and_hochberg() -> None:
    """Their 15 p-values (1995, section 3.2): four are rejected at 5 %, by Bonferroni three."""
    p = [0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344, 0.0459]
    p += [0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0000]
    q = q_values(np.array(p))
    assert np.count_nonzero(q <= 0.05) == 4
    assert_allclose(q[3], 0.0095 * 15 / 4)


def test_what_was_not_tested_does_not_count() -> None:
    q = q_values(np.array([np.nan, 0.01, np.nan, 0.02]))
    assert_allclose(q, [np.nan, 0.02, np.nan, 0.02])
    assert np.isnan(q_values(np.array([np.nan]))).all()
    assert q_values(np.array([])).size == 0
