"""The BCa interval of a mean, against Efron's formulas written out and against scipy."""

import itertools
from statistics import NormalDist, mean

import numpy as np
import pytest
import scipy.stats
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose

from giveway.studies.statistics.bootstrap import Interval, bca_levels, mean_interval, seed_of

NORMAL = NormalDist()
MASK = 2**64 - 1

samples = arrays(
    np.float64,
    st.integers(2, 40),
    elements=st.integers(-5000, 5000).map(lambda number: number / 16.0),
)


def efron(sample: list[float], means: list[float], tail: float) -> tuple[float, float]:
    """Efron & Tibshirani 1993, eqs. (14.10), (14.14) and (14.15), by leaving one out."""
    theta = mean(sample)
    below = sum(m < theta for m in means) + sum(m == theta for m in means) / 2
    z_0 = NORMAL.inv_cdf(below / len(means))
    without = [mean(sample[:i] + sample[i + 1 :]) for i in range(len(sample))]
    centre = mean(without)
    cubes = sum((centre - each) ** 3 for each in without)
    squares = sum((centre - each) ** 2 for each in without)
    a = cubes / (6 * squares**1.5)

    def level(z: float) -> float:
        return NORMAL.cdf(z_0 + (z_0 + z) / (1 - a * (z_0 + z)))

    return level(NORMAL.inv_cdf(tail)), level(NORMAL.inv_cdf(1 - tail))


def splitmix64(seed: int):
    state = seed
    while True:
        state = (state + 0x9E3779B97F4A7C15) & MASK
        z = ((state ^ (state >> 30)) * 0xBF58476D1CE4E5B9) & MASK
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
        yield z ^ (z >> 31)


@pytest.mark.parametrize("sample", [[0.0, 1.0, 2.0, 7.0], [-4.0, 0.0, 0.0, 1.0, 2.0]])
def test_levels_are_efrons_on_the_whole_bootstrap_distribution(sample: list[float]) -> None:
    """So few numbers have so few resamples (n^n) that all of them can be drawn."""
    means = [mean(drawn) for drawn in itertools.product(sample, repeat=len(sample))]
    totals = np.sort([sum(drawn) for drawn in itertools.product(sample, repeat=len(sample))])
    found = bca_levels(np.array(sample), totals, 0.025)
    assert_allclose(found, efron(sample, means, 0.025), rtol=1e-12)


@pytest.mark.parametrize("confidence", [0.8, 0.95, 0.99])
def test_interval_is_scipys_on_the_same_resamples(confidence: float) -> None:
    sample = np.random.default_rng(3).exponential(size=50).round(6)
    draws = splitmix64(12345)
    resamples = [[sample[((next(draws) >> 32) * 50) >> 32] for _ in sample] for _ in range(999)]

    class Former:
        bootstrap_distribution = np.mean(resamples, axis=1)

    theirs = scipy.stats.bootstrap(
        (sample,),
        np.mean,
        n_resamples=0,
        bootstrap_result=Former,
        confidence_level=confidence,
        method="BCa",
    ).confidence_interval
    ours = mean_interval(sample, confidence=confidence, resamples=999, seed=12345)
    assert ours.method == "BCa"
    assert_allclose((ours.low, ours.high), theirs, rtol=1e-12)


def test_generator_is_splitmix64() -> None:
    """The reference sequence of seed 1234567, as in every implementation's tests."""
    expected = [6457827717110365317, 3203168211198807973, 9817491932198370423]
    assert list(itertools.islice(splitmix64(1234567), 3)) == expected


def test_equal_numbers_have_themselves_as_interval() -> None:
    found = mean_interval(np.full(40, 0.1), confidence=0.95, resamples=99, seed=1)
    assert found == Interval(0.1, 0.1, "constant")


def test_percentile_where_every_resample_is_on_one_side_of_the_mean() -> None:
    """One number of 4000 is not zero: three resamples often all miss it, and show no bias."""
    sample = np.zeros(4000)
    sample[17] = 1.0
    seeds = range(400)
    found = [mean_interval(sample, confidence=0.6, resamples=3, seed=seed) for seed in seeds]
    assert {each.method for each in found} == {"percentile", "BCa"}
    assert all(np.isfinite([each.low, each.high]).all() for each in found)


def test_no_level_beyond_the_pole_of_the_acceleration() -> None:
    """One number far off, and nearly all resamples below the mean: 1 - a w would be negative."""
    sample = np.zeros(5)
    sample[0] = 1.0
    totals = np.append(np.zeros(10**4), 2.0)
    assert bca_levels(sample, totals, 1e-9) is None


@pytest.mark.parametrize("size", [4e-6, 1e8, 1e10, 1e150, 1.7e308])
def test_no_size_of_the_numbers_upsets_it(size: float) -> None:
    sample = np.array([-1.0, 0.0, 0.5, 1.0, 1.0, -0.25]) * size
    found = mean_interval(sample, confidence=0.95, resamples=99, seed=3)
    assert sample.min() <= found.low <= found.high <= sample.max()


@given(samples, st.integers(0, MASK))
def test_interval_lies_within_the_numbers(sample: np.ndarray, seed: int) -> None:
    found = mean_interval(sample, confidence=0.95, resamples=99, seed=seed)
    assert sample.min() <= found.low <= found.high <= sample.max()


@given(samples, st.integers(0, MASK))
def test_negated_numbers_have_the_negated_interval(sample: np.ndarray, seed: int) -> None:
    there = mean_interval(sample, confidence=0.95, resamples=99, seed=seed)
    back = mean_interval(-sample, confidence=0.95, resamples=99, seed=seed)
    assert_allclose((back.low, back.high), (-there.high, -there.low), rtol=1e-12)


@given(samples, st.integers(-2, 6), st.integers(-100, 100))
@settings(max_examples=50)
def test_interval_follows_scale_and_shift(sample: np.ndarray, power: int, shift: int) -> None:
    plain = mean_interval(sample, confidence=0.9, resamples=99, seed=5)
    moved = mean_interval(sample * 2.0**power + shift, confidence=0.9, resamples=99, seed=5)
    expected = np.array([plain.low, plain.high]) * 2.0**power + shift
    assert_allclose((moved.low, moved.high), expected, rtol=1e-9, atol=1e-12)


def test_seed_depends_on_the_names_and_where_they_end() -> None:
    assert seed_of(["a", "b"]) == seed_of(("a", "b"))
    assert len({seed_of(names) for names in (["a", "b"], ["ab", ""], ["b", "a"], ["ab"])}) == 4


@pytest.mark.parametrize(
    ("draw", "true", "least"),
    [
        (lambda rng, n: rng.normal(-1.0, 3.0, n), -1.0, 0.935),
        (lambda rng, n: rng.exponential(1.0, n), 1.0, 0.925),
        # most pairs equal, some far apart: what longest waits look like
        (lambda rng, n: rng.exponential(3.0, n) * (rng.random(n) < 0.2), 0.6, 0.915),
    ],
    ids=["normal", "exponential", "mostly zero"],
)
def test_95_percent_cover_the_mean_of_100_pairs(draw, true: float, least: float) -> None:
    hits = 0
    for seed in range(2000):
        sample = draw(np.random.default_rng(seed), 100)
        found = mean_interval(sample, confidence=0.95, resamples=499, seed=seed_of([str(seed)]))
        hits += found.low <= true <= found.high
    assert least <= hits / 2000 <= 0.96
