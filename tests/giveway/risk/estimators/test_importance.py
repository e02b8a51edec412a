"""Importance sampling: its estimate, its interval, and degenerate weights."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from giveway.risk.estimators import importance_sampling, run_sampler
from giveway.risk.estimators.importance import Mixture, tail_shape


def both_sides(u):
    """Two regions, of which a single normal distribution would find one."""
    return np.abs(u[:, 0]) - 3.5


def test_the_interval_covers_two_regions():
    truth = 2.0 * stats.norm.sf(3.5)
    estimates = [run_sampler(importance_sampling(3, 5000, s), both_sides) for s in range(5)]
    assert sum(one.low <= truth <= one.high for one in estimates) >= 4
    assert np.mean([one.probability for one in estimates]) == pytest.approx(truth, rel=0.05)
    assert all(one.runs == 5000 for one in estimates)


def test_in_many_dimensions_degenerate_weights_are_a_doubt():
    def ball(u):
        return np.linalg.norm(u, axis=1) - 13.5

    estimate = run_sampler(importance_sampling(100, 5000, 1), ball)
    assert estimate.doubts


def test_an_event_that_is_never_met_gives_an_upper_bound():
    estimate = run_sampler(importance_sampling(2, 2000, 1), lambda u: np.full(len(u), -1.0))
    assert (estimate.probability, estimate.low) == (0.0, 0.0)
    assert 0.0 < estimate.high < 0.05
    assert estimate.doubts


def test_the_mean_of_the_weights_is_1():
    random = np.random.default_rng(1)
    mixture = Mixture(2, np.array([1.0]), np.array([[2.0, 0.0]]), np.eye(2)[None])
    weights = np.exp(mixture.log_weights(mixture.draw(20_000, random)))
    assert weights.mean() == pytest.approx(1.0, abs=0.05)
    assert weights.max() <= 10.0


def test_the_shape_of_a_pareto_tail_is_found():
    heavy = np.random.default_rng(1).pareto(1.0, 5000) + 1.0
    assert tail_shape(heavy) == pytest.approx(1.0, abs=0.2)
    assert tail_shape(np.random.default_rng(1).random(5000)) < 0.0
