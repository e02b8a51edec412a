"""Bounded noise: normal within its bound, and repeatable."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from giveway.crowd.motion.noise import BOUND, planar_noise


@given(st.integers(0, 2**32 - 1), st.integers(0, 300))
def test_no_number_is_beyond_the_bound(seed: int, count: int) -> None:
    noise = planar_noise(np.random.default_rng(seed), count)
    assert noise.shape == (count, 2)
    assert (np.abs(noise) <= BOUND).all()


def test_its_standard_deviation_is_that_of_the_cut_distribution() -> None:
    noise = planar_noise(np.random.default_rng(1), 200_000)
    assert abs(noise.mean()) < 0.005
    assert abs(noise.std() - 0.880) < 0.005


def test_the_same_stream_gives_the_same_noise() -> None:
    one, other = (planar_noise(np.random.default_rng(7), 50) for _ in range(2))
    assert (one == other).all()
