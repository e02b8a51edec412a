"""Numbers that the report's pictures show."""

from __future__ import annotations

import numpy as np

from giveway.reports.student_intervals import mean_interval, possible
from giveway.reports.study_pictures import study_pictures


def test_an_interval_of_counts_does_not_reach_below_zero() -> None:
    low, high = mean_interval(np.array([0.02, 0.05, 0.9]), 0.95)
    assert low < 0.0
    assert possible((low, high)) == (0.0, high)


def test_what_is_possible_stays() -> None:
    assert possible((0.1, 0.4)) == (0.1, 0.4)


def test_the_trade_off_is_one_of_time_and_close_passes(study) -> None:
    picture = next(each for each in study_pictures(study) if each.name == "tradeoff")
    assert "completion time against mean close passes" in picture.caption
    cell = study.runs[study.runs["cell"] == 1]
    assert f"{cell['close_passes'].mean():.2f} close passes" in picture.alt
