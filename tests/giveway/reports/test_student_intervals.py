"""Student's intervals of means, compared with scipy's own."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from giveway.reports.student_intervals import mean_interval, possible

VALUES = np.array([3.1, 2.7, 4.4, 3.9, 2.2])


@pytest.mark.parametrize("confidence", [0.9, 0.95, 0.99])
def test_it_is_scipys(confidence: float) -> None:
    scale = stats.sem(VALUES)
    expected = stats.t.interval(confidence, len(VALUES) - 1, VALUES.mean(), scale)
    assert mean_interval(VALUES, confidence) == pytest.approx(expected)


def test_one_value_or_equal_ones_have_no_width() -> None:
    assert mean_interval(VALUES[:1], 0.95) == (3.1, 3.1)
    assert mean_interval(np.full(4, 2.0), 0.95) == (2.0, 2.0)


@given(st.floats(-5.0, 5.0), st.floats(0.0, 5.0))
def test_it_does_not_reach_below_what_can_be(low: float, width: float) -> None:
    cut, high = possible((low, low + width))
    assert high == low + width
    assert cut == max(low, 0.0)
