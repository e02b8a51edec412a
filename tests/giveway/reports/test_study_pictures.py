"""Numbers that the report's pictures show."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.reports.student_intervals import mean_interval, possible


def test_an_interval_of_clearances_does_not_reach_below_contact() -> None:
    low, high = mean_interval(np.array([0.02, 0.05, 0.9]), 0.95)
    assert low < 0.0
    assert possible((low, high)) == (0.0, high)


@pytest.mark.parametrize(
    ("least", "expected"), [(-0.1, (-0.1, 0.4)), (-0.3, (-0.2, 0.4)), (0.1, (0.0, 0.4))]
)
def test_an_overlap_that_was_measured_bounds_it_instead(least, expected) -> None:
    assert possible((-0.2, 0.4), least) == expected


def test_what_is_possible_stays() -> None:
    assert possible((0.1, 0.4)) == (0.1, 0.4)
