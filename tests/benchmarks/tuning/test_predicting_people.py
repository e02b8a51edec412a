"""The numbers by which predictors are compared."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from predicting_people import difference, error_ahead, parts, table


def numbers(close, near, time):
    rest = dict.fromkeys(("delay", "jerk", "braking", "touched", "frontal", "error"), 0.0)
    return {"close": close, "near": near, "time": time, **rest}


DRIVES = {
    ("crowd", "1"): numbers(1, 10, 10.0),
    ("crowd", "2"): numbers(3, 10, 12.0),
    ("street", "1"): numbers(0, 20, 20.0),
    ("street", "2"): numbers(2, 20, 22.0),
}


def test_the_drives_of_a_seed_are_summed():
    assert parts(DRIVES, "close").tolist() == [[1.0, 5.0], [30.0, 30.0]]
    assert parts(DRIVES, "time").tolist() == [[30.0, 34.0], [2.0, 2.0]]


def test_equal_differences_of_all_seeds_have_no_spread():
    seeds = np.arange(1.0, 9.0)
    one, other = np.stack([seeds, np.ones(8)]), np.stack([seeds + 2.0, np.ones(8)])
    assert difference(one, other) == pytest.approx((2.0, 2.0, 2.0))


def test_the_interval_holds_the_difference_of_noise():
    g = np.random.default_rng(2)
    one, other = (np.stack([g.normal(size=60), np.ones(60)]) for _ in range(2))
    mean, low, high = difference(one, other)
    assert low < mean < high
    assert low < 0.0 < high


def test_an_error_is_that_of_the_same_person_two_seconds_later():
    predictions = pd.DataFrame(
        {
            "time": [0.0, 0.0, 0.0, 9.0],
            "id": ["a", "b", "a", "a"],
            "look_ahead": [2.0, 2.0, 1.0, 2.0],
            "x": [3.0, 0.0, 50.0, 50.0],
            "y": [4.0, 1.0, 50.0, 50.0],
        }
    )
    walked = pd.DataFrame(
        {"time": [2.0, 2.0, 1.0], "id": ["a", "b", "a"], "x": [0.0] * 3, "y": [0.0] * 3}
    )
    assert error_ahead(predictions, walked) == pytest.approx(3.0)  # of 5 m and 1 m
    assert np.isnan(error_ahead(predictions[3:], walked))


def test_the_table_shows_shares_and_differences():
    drives = {}
    for (scene, seed), found in DRIVES.items():
        drives[f"MIXED | known | {scene} | old | {seed}"] = found
        drives[f"MIXED | known | {scene} | new | {seed}"] = {**found, "time": found["time"] - 1.0}
    rows = [line for line in table(drives, "old") if "| all |" in line]
    assert rows[0].startswith("| MIXED | known | all | old | 4 | 10.0 | 16.0 |")
    assert rows[1].startswith("| MIXED | known | all | new | 4 | 10.0 | 15.0 |")
    assert "| +0.0 [+0.0, +0.0] | -1.0 [-1.0, -1.0] |" in rows[1]
