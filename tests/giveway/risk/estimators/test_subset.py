"""Subset simulation: its estimate, its interval, and what it says when it does not know."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from giveway.risk.estimators import run_sampler, subset_simulation
from giveway.risk.estimators.scouts import Scouted, scouts
from giveway.risk.estimators.subset import interval_of_repeats, variance_between


def beyond(distance):
    """The criticality of a half-space of ten dimensions, whose probability is known."""
    return lambda u: u.sum(axis=1) / np.sqrt(u.shape[1]) - distance


@pytest.mark.parametrize("distance", [1.0, 4.0])
def test_the_interval_covers_the_probability_of_a_half_space(distance):
    truth = stats.norm.sf(distance)
    estimates = [
        run_sampler(subset_simulation(10, 20_000, seed), beyond(distance)) for seed in range(10)
    ]
    assert sum(one.low <= truth <= one.high for one in estimates) >= 8
    assert all(one.high / one.low < 4.0 for one in estimates)
    assert np.mean([one.probability for one in estimates]) == pytest.approx(truth, rel=0.2)
    assert not any(one.doubts for one in estimates)


def test_equal_seeds_ask_for_equal_vectors():
    first, again = (run_sampler(subset_simulation(2, 3000, 5), beyond(2.0)) for _ in range(2))
    assert first == again


def test_chains_that_miss_the_main_region_are_noticed_by_scouts():
    """The levels lead upwards, to a rare region, past the likely one on the right (RP110)."""

    def criticality(u):
        x, y = u.T
        first = np.where(x <= 3.5, 0.85 - 0.1 * x, 4.0 - x)
        second = np.where(y <= 2.0, 2.3 - y, 0.5 - 0.1 * y)
        return -np.minimum(first, second)

    for seed in range(3):
        estimate = run_sampler(subset_simulation(2, 20_000, seed), criticality)
        assert estimate.low <= 3.196e-5 <= estimate.high
        assert estimate.doubts


def test_a_flat_criticality_gives_an_upper_bound_and_a_doubt():
    estimate = run_sampler(subset_simulation(2, 3000, 1), lambda u: np.full(len(u), -1.0))
    assert (estimate.probability, estimate.low) == (0.0, 0.0)
    assert 0.0 < estimate.high < 0.02
    assert "did not reach the event" in estimate.doubts[0]


def test_repeats_that_disagree_are_a_doubt_and_plain_runs_bound_them():
    """Half of the space is a plateau just below the event, from which few chains get on."""

    def rugged(u):
        hidden = np.sin(1e3 * u[:, 0]) * np.sin(1e3 * u[:, 1])
        return np.where(hidden > 0.999, 1.0, np.minimum(u.sum(axis=1) - 6.0, -1e-6))

    for seed in range(3):
        estimate = run_sampler(subset_simulation(2, 3000, seed), rugged)
        if estimate.doubts:
            assert estimate.high < 0.02
        else:
            assert estimate.high <= 10.0 * estimate.low


def test_noise_by_a_held_component_keeps_the_estimate():
    """The component is the seed of noise: the criticality is random in all others."""
    truth = stats.norm.sf(3.0 / np.sqrt(1.0 + 0.25))

    def noisy(u):
        noise = stats.norm.ppf((stats.norm.cdf(u[:, 0]) * 1e6) % 1.0)
        return u[:, 1] + 0.5 * np.nan_to_num(noise, posinf=0.0, neginf=0.0) - 3.0

    found = [
        run_sampler(subset_simulation(2, 6000, seed, held=(0,)), noisy).probability
        for seed in range(10)
    ]
    assert np.mean(found) == pytest.approx(truth, rel=0.25)


def test_runs_without_a_result_are_a_doubt():
    def failing(u):
        found = beyond(1.0)(u)
        found[0] = np.nan
        return found

    estimate = run_sampler(subset_simulation(2, 3000, 1), failing)
    assert estimate.failed > 0
    assert "have no result" in " ".join(estimate.doubts)


def test_the_interval_of_lognormal_estimates_covers_their_mean():
    random = np.random.default_rng(1)
    covered = 0
    for _ in range(400):
        each = np.exp(0.5 * random.standard_normal(10) - 0.125)
        _, low, high = interval_of_repeats(each, 0.95)
        covered += low <= 1.0 <= high
    assert covered >= 0.92 * 400


def test_repeats_that_agree_by_luck_are_no_closer_than_their_chains():
    each = np.full(10, 1e-3) * np.exp(np.linspace(-0.01, 0.01, 10))
    _, low, high = interval_of_repeats(each, 0.95)
    assert high < 1.01 * low * 1.02
    mean, low, high = interval_of_repeats(each, 0.95, 0.5)
    assert low < 0.8 * mean
    assert high > 1.7 * mean
    apart = np.geomspace(1e-4, 1e-2, 10)
    assert interval_of_repeats(apart, 0.95, 0.5) == interval_of_repeats(apart, 0.95)


def test_the_spread_of_a_share_is_that_between_chains():
    random = np.random.default_rng(5)
    independent = random.random(1000) < 0.1
    share = independent.mean()
    assert variance_between(independent, 1000) == pytest.approx(share * (1.0 - share) / 999.0)
    stuck = np.tile(random.random(100) < 0.1, 10)  # ten states of each chain, all the same
    share = stuck.mean()
    assert variance_between(stuck, 100) == pytest.approx(share * (1.0 - share) / 99.0)
    assert variance_between(stuck[:1], 1) == 0.0


def test_scouts_with_degenerate_weights_see_nothing():
    """In ten dimensions a few of 600 scouts have nearly all the weight: they contradict nobody."""
    beta = 2.9
    vectors = scouts(10, 600, np.random.default_rng(2))
    found = Scouted.of(vectors, vectors[:, 0] - beta)
    assert found.events > 20
    assert (found.probability, found.low, found.high) == (0.0, 0.0, 0.0)


def test_scouts_in_the_plane_see_the_probability():
    vectors = scouts(2, 2000, np.random.default_rng(2))
    found = Scouted.of(vectors, vectors[:, 0] - 2.9)
    assert found.low <= stats.norm.sf(2.9) <= found.high
