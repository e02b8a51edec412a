"""The BCa interval of a mean, against Efron's formulas written out, and how often it is right."""

import itertools
import math
import warnings
from statistics import NormalDist, mean

import numpy as np
import pytest
import scipy.stats
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose

from giveway.studies.statistics.bootstrap import (
    MOST_FOR_BCA,
    Interval,
    mean_interval,
    seed_of,
    side_by_side,
)

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


@pytest.mark.parametrize(
    ("sample", "confidence"),
    [([-4.0, 0.0, 0.0, 1.0, 2.5], 0.9), ([0.0, 1.0, 2.0, 10.0], 0.8), ([0, 1, 2, 3, 20.0], 0.85)],
)
def test_ends_are_efrons_on_the_whole_bootstrap_distribution(
    sample: list[float], confidence: float
) -> None:
    """So few numbers have so few resamples (n^n) that all can be listed; we draw 200,000.

    The means are few, and so that no draw matters the levels lie well inside the steps of their
    distribution: the ends are exactly these means. Plain percentiles would be others.
    """
    means = sorted(mean(drawn) for drawn in itertools.product(sample, repeat=len(sample)))
    levels = efron(sample, means, (1.0 - confidence) / 2.0)
    expected = [means[math.floor(level * (len(means) - 1))] for level in levels]
    found = mean_interval(np.array(sample), confidence=confidence, resamples=200_000, seed=1)
    assert found.method == "BCa"
    assert_allclose((found.low, found.high), expected, rtol=1e-12)


@pytest.mark.parametrize("size", [2, 7, 30, 333, 2001])
def test_the_interval_is_scipys_own_to_the_bit(size: int) -> None:
    """It draws the numbers in half the bits, and adds them up without Python."""
    sample = np.round(np.random.default_rng(size).gamma(2.0, 3.0, size), 6)
    found = mean_interval(sample, confidence=0.9, resamples=999, seed=7)
    scipys = scipy.stats.bootstrap(
        (np.round(sample * 1e6),),
        np.mean,
        n_resamples=999,
        confidence_level=0.9,
        batch=max(1, 300_000 // size),
        rng=np.random.default_rng(7),
    )
    low, high = (end / 1e6 for end in scipys.confidence_interval)
    assert (found.low, found.high) == (low, high)


def test_equal_numbers_have_themselves_as_interval() -> None:
    found = mean_interval(np.full(40, 0.1), confidence=0.95, resamples=99, seed=1)
    assert found == Interval(0.1, 0.1, "constant")


@pytest.mark.filterwarnings("error")
def test_percentile_if_every_resample_is_on_one_side_of_the_mean() -> None:
    """One number of 200 is not zero: three resamples often all miss it, and show no bias."""
    sample = np.zeros(200)
    sample[17] = 1.0
    seeds = range(100)
    found = [mean_interval(sample, confidence=0.6, resamples=3, seed=seed) for seed in seeds]
    assert {each.method for each in found} == {"percentile", "BCa"}
    assert all(np.isfinite([each.low, each.high]).all() for each in found)


@pytest.mark.filterwarnings("error")
def test_percentile_beyond_the_pole_of_the_acceleration() -> None:
    """One number far off and nearly all certainty: 1 - a w is negative, the ends would cross."""
    sample = np.zeros(30)
    sample[0] = 1.0
    found = mean_interval(sample, confidence=1.0 - 1e-12, resamples=999, seed=1)
    assert found.method == "percentile"
    assert 0.0 == found.low < found.high <= 1.0


def test_percentile_of_very_many_numbers() -> None:
    """Leaving each of them out once would take too long, and move the ends by nothing."""
    sample = np.random.default_rng(1).exponential(size=MOST_FOR_BCA + 1)
    many = mean_interval(sample, confidence=0.95, resamples=999, seed=1)
    fewer = mean_interval(sample[:-1], confidence=0.95, resamples=999, seed=1)
    assert (many.method, fewer.method) == ("percentile", "BCa")
    assert_allclose((many.low, many.high), (fewer.low, fewer.high), atol=0.1 * many.width)


@pytest.mark.filterwarnings("error")
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
    rounding = 1e-12 * np.abs(sample).max()
    assert_allclose((back.low, back.high), (-there.high, -there.low), rtol=1e-12, atol=rounding)


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
        (lambda rng, n: rng.normal(-1.0, 3.0, n), -1.0, 0.93),
        (lambda rng, n: rng.exponential(1.0, n), 1.0, 0.92),
        # most pairs equal, some far apart: what longest waits look like
        (lambda rng, n: rng.exponential(3.0, n) * (rng.random(n) < 0.2), 0.6, 0.91),
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


def test_side_by_side_the_intervals_and_their_order_are_equal():
    several = [np.random.default_rng(n).normal(size=50 + n).round(3) for n in range(40)]
    several[7] = np.array([1.0] * 9 + [1.001])  # of which scipy would say that it varies too little

    def found(n: int) -> Interval:
        return mean_interval(several[n], confidence=0.95, resamples=499, seed=n)

    before = list(warnings.filters)
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        assert side_by_side(found, range(40)) == [found(n) for n in range(40)]
    assert not told
    assert warnings.filters == before


def test_side_by_side_an_error_is_told():
    with pytest.raises(ZeroDivisionError):
        side_by_side(lambda n: 1 // n, [1, 0, 2])
