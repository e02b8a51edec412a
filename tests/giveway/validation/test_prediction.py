"""The comparison of drift with constant velocity, on tracks whose errors are known."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.recordings.intervals import ClipBootstrap
from giveway.validation import CITR, Protocol, read_clips
from giveway.validation.prediction import (
    Predicted,
    predict_all,
    prediction_table,
    recent_velocity,
)
from giveway.validation.protocol import windows
from pedestrian_model.drift.trained import unseen_fit

DT = 1 / 29.97


@pytest.fixture
def walks(tmp_path, write_clip, straight_walks):
    """Two clips of a walker whose recorded velocity is 0.05 m/s too high."""
    x, v = straight_walks(200, [[0, 0], [0, 9]], [[1.0, 0.0], [0.0, 0.0]])
    for number in (1, 2):
        write_clip(tmp_path, f"walk_{number:02}", x, v + [0.05, 0.0])
    return read_clips(tmp_path, CITR)


def test_positions_give_the_velocity_that_the_file_has_not(walks):
    cut = windows(walks, Protocol())
    for window in cut:
        assert recent_velocity(window, DT)[0] == pytest.approx([1.0, 0.0], abs=1e-9)


def test_the_baseline_is_the_best_constant_velocity(walks):
    protocol = Protocol()
    cut = windows(walks, protocol)
    found = predict_all(cut, unseen_fit(["walk_01", "walk_02"]), protocol)
    table = prediction_table(found, protocol, ClipBootstrap.of(2))
    assert table["subset"].unique().tolist() == ["all"]
    assert (table["baseline"] == "CV by positions").all()
    assert table["baseline_fde"].tolist() == pytest.approx([0.0] * 3, abs=1e-9)
    assert np.hypot(*found.error[1, 0, 1]) == pytest.approx(0.05 * 60 * DT)


def test_likelihood_and_ellipses_are_those_of_a_normal_distribution():
    rng = np.random.default_rng(1)
    deviation = np.tile([0.8, 0.3], (1, 4000, 1, 1))
    error = rng.normal(0.0, deviation)
    one = np.zeros(4000, dtype=np.int64)
    found = Predicted(one, one[:, None] > 0, error, deviation, error[..., 0])
    assert found.inside(0.5).mean() == pytest.approx(0.5, abs=0.03)
    assert found.inside(0.95).mean() == pytest.approx(0.95, abs=0.02)
    entropy = 1.0 + np.log(2.0 * np.pi) + np.log(0.8 * 0.3)
    assert found.nll.mean() == pytest.approx(entropy, abs=0.05)
