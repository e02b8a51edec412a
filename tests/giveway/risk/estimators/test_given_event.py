"""The inputs given the event: indices without bias, whose intervals cover, and quantiles."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import integrate, stats

from giveway.risk.estimators import (
    EventSample,
    event_index,
    importance_sampling,
    monte_carlo,
    run_sampler,
    subset_simulation,
    weighted_quantiles,
)

SLOPE, DISTANCE = 0.8, 2.0
PROBABILITY = stats.norm.sf(DISTANCE)


def half_space(u):
    """The first component matters most, the second less, the third not at all."""
    return SLOPE * u[:, 0] + np.sqrt(1.0 - SLOPE**2) * u[:, 1] - DISTANCE


def exact(slope):
    """The variance of the probability given one component, over that of the event."""

    def square(x):
        return stats.norm.sf((DISTANCE - slope * x) / np.sqrt(1.0 - slope**2)) ** 2

    mean = integrate.quad(lambda x: square(x) * stats.norm.pdf(x), -9.0, 9.0)[0]
    return (mean - PROBABILITY**2) / (PROBABILITY * (1.0 - PROBABILITY))


@pytest.mark.parametrize(
    "sampler",
    [
        monte_carlo(3, 40_000, np.random.default_rng(1)),
        subset_simulation(3, 40_000, 1),
        importance_sampling(3, 20_000, 1),
    ],
)
def test_the_index_is_the_share_of_the_events_variance(sampler):
    estimate = run_sampler(sampler, half_space)
    for component, slope in enumerate((SLOPE, 0.6, 0.0)):
        found = event_index(estimate.sample, component, estimate.probability)
        assert found.index == pytest.approx(exact(slope), rel=0.25, abs=0.005)
        assert found.low - 0.03 <= exact(slope) <= found.high + 0.03


def test_the_interval_covers_the_index_in_most_samples_of_200_events():
    covered = 0
    for seed in range(100):
        sampler = monte_carlo(3, 9_000, np.random.default_rng(seed))
        estimate = run_sampler(sampler, half_space)
        found = event_index(estimate.sample, 0, PROBABILITY)
        covered += found.low <= exact(SLOPE) <= found.high
    assert covered >= 88


def test_a_component_that_says_nothing_has_no_index_on_average():
    vectors = np.random.default_rng(3).standard_normal((200, 60, 1))
    each = [
        event_index(EventSample(v, np.ones(60), np.arange(60)), 0, 0.5, classes=4).index
        for v in vectors
    ]
    assert np.mean(each) == pytest.approx(0.0, abs=3.0 * np.std(each) / np.sqrt(200))


def test_an_event_that_is_sure_or_has_one_source_has_no_index():
    sample = EventSample(np.zeros((3, 1)), np.ones(3), np.arange(3))
    assert np.isnan(event_index(sample, 0, 1.0).index)
    alone = EventSample(np.zeros((3, 1)), np.ones(3), np.zeros(3, dtype=int))
    assert np.isnan(event_index(alone, 0, 0.1).index)


def test_quantiles_count_each_value_by_its_weight():
    values, weights = np.array([3.0, 1.0, 2.0]), np.array([0.5, 0.25, 0.25])
    assert weighted_quantiles(values, weights, [0.25, 0.5, 0.95]).tolist() == [1.0, 2.0, 3.0]
