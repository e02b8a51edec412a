"""Plain Monte Carlo and its interval."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from giveway.risk.estimators import clopper_pearson, monte_carlo, run_sampler


def test_the_interval_is_that_of_an_exact_binomial_test():
    exact = stats.binomtest(7, 500).proportion_ci(0.9, method="exact")
    assert clopper_pearson(7, 500, 0.9) == pytest.approx((exact.low, exact.high))


def test_without_an_event_the_upper_bound_is_three_over_n():
    low, high = clopper_pearson(0, 1000)
    assert low == 0.0
    assert high == pytest.approx(3.0 / 1000, rel=0.01)


def test_events_in_all_runs_have_the_upper_bound_1():
    low, high = clopper_pearson(20, 20)
    assert high == 1.0
    assert low == pytest.approx(0.025 ** (1 / 20))


def test_runs_without_a_result_widen_the_interval_on_both_sides():
    def criticality(vectors):
        found = vectors[:, 0] - 1.0
        found[:10] = np.nan
        return found

    estimate = run_sampler(monte_carlo(2, 200, np.random.default_rng(1)), criticality)
    assert estimate.failed == 10
    assert estimate.low == clopper_pearson(estimate.events, 200)[0]
    assert estimate.high == clopper_pearson(estimate.events + 10, 200)[1]


def test_more_runs_begin_with_the_same_vectors():
    few, many = (next(monte_carlo(3, n, np.random.default_rng(4))) for n in (5, 50))
    assert np.array_equal(many[:5], few)
