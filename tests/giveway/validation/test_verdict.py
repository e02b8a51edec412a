"""The verdict praises nobody whose advantage is not proved against both simple predictors."""

from __future__ import annotations

import pandas as pd
import pytest

from giveway.validation.verdict import compared, verdict


@pytest.mark.parametrize(
    ("low", "high", "words"),
    [
        (-0.3, -0.1, "better than"),
        (0.1, 0.3, "worse than"),
        (-0.1, 0.1, "not distinguishable from"),
        (float("nan"), float("nan"), "not distinguishable from"),
    ],
)
def test_an_interval_about_zero_proves_nothing(low, high, words):
    assert compared(low, high) == words


def test_a_model_is_compared_with_both_simple_predictors():
    row = {"subset": "near", "metric": "FDE", "predictor": "VCI", "horizon": 2.0, "count": 9}
    row |= {"against_cv_low": -0.2, "against_cv_high": -0.1}
    row |= {"against_goal_cv_low": 0.1, "against_goal_cv_high": 0.3}
    said = list(verdict(pd.DataFrame([row]), pd.DataFrame()))
    assert said == ["VCI, people near a moving vehicle: at 2 s better than CV, worse than goalCV."]


def test_drift_is_compared_with_the_best_constant_velocity():
    row = {"subset": "near", "metric": "FDE", "predictor": "VCI", "horizon": 2.0, "count": 9}
    row |= dict.fromkeys(("against_cv_low", "against_goal_cv_low"), -1.0)
    row |= dict.fromkeys(("against_cv_high", "against_goal_cv_high"), 1.0)
    drift = {"subset": "near", "horizon": 2.0, "baseline": "CV by both", "change": -0.06}
    drift |= {"change_low": -0.14, "change_high": -0.01}
    said = list(verdict(pd.DataFrame([row]), pd.DataFrame([drift])))[-1]
    assert said.endswith("at 2 s better than CV by both (-6.0 % [-14, -1]).")
