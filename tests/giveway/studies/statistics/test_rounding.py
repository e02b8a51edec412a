"""Numbers as tables hold them, and means that no large number makes overflow."""

import math

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from giveway.studies.statistics.rounding import mean, median, tabulated, to_decimals

numbers = st.lists(st.floats(-1e8, 1e8), min_size=1, max_size=30)


@given(numbers, st.randoms())
def test_a_mean_does_not_depend_on_the_order(values: list[float], random) -> None:
    first = mean(np.array(values))
    random.shuffle(values)
    assert mean(np.array(values)) == first
    assert first == pytest.approx(math.fsum(values) / len(values), abs=1e-5)


@given(numbers)
def test_a_median_is_that_of_numpy(values: list[float]) -> None:
    assert median(np.array(values)) == pytest.approx(np.median(values), abs=1e-6)


def test_large_numbers_do_not_overflow() -> None:
    huge = np.full(4, 1.5e308)
    assert mean(huge) == pytest.approx(1.5e308)
    assert median(huge) == pytest.approx(1.5e308)


def test_six_decimals_are_kept_and_no_negative_zero() -> None:
    rounded = to_decimals(np.array([-1e-9, 0.12345649, 1e12 + 0.1]))
    assert rounded.tolist() == [0.0, 0.123456, 1e12 + 0.1]
    assert not np.signbit(rounded[0])


def test_probabilities_keep_six_significant_digits() -> None:
    frame = pd.DataFrame({"p_value": [1.23456789e-12], "mean": [1.23456789e-12]})
    table = tabulated(frame, ["p_value", "mean"])
    assert table["p_value"].tolist() == [1.23457e-12]
    assert table["mean"].tolist() == [0.0]
