"""Intervals of errors: drawn by clips."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.recordings.intervals import ClipBootstrap


def test_the_interval_is_that_of_drawing_clips(straight_walks) -> None:
    """Three clips with means 1, 2 and 6 of 10, 10 and 20 people: no resample is beyond 1 or 6."""
    draws = ClipBootstrap.of(3)
    count = np.array([10.0, 10.0, 20.0])
    low, high = draws.interval(np.array([1.0, 2.0, 6.0]) * count, count)
    assert (low, high) == (1.0, 6.0)
    assert draws.interval(2.5 * count, count) == pytest.approx((2.5, 2.5))
    alone = draws.interval(np.array([5.0, 0.0, 0.0]), np.array([5.0, 0.0, 0.0]))
    assert np.isnan(alone).all(), "one clip tells nothing of other clips"
