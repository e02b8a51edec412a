"""Positions and spread from corrections."""

from __future__ import annotations

import numpy as np
import pytest

from pedestrian_model.drift.motion import fill_positions, spread


def test_corrections_act_in_the_frame_of_the_heading():
    heading, out = np.array([[0.0, 1.0]]), np.empty((4, 1, 2))
    corrections = np.tile([-0.2, 0.1], (1, 3, 1))
    fill_positions(np.array([[1.0, 2.0]]), np.array([[0.0, 1.0]]), heading, corrections, 1.0, out)
    assert out[:, 0, 1] == pytest.approx(2.0 + 0.8 * np.arange(1, 5))
    assert out[:, 0, 0] == pytest.approx(1.0 - 0.1 * np.arange(1, 5))


def test_corrections_are_interpolated_between_horizons():
    corrections, out = np.zeros((1, 3, 2)), np.empty((5, 1, 2))
    corrections[0, 1:, 0] = 0.1, 0.3
    zero = np.zeros((1, 2))
    fill_positions(zero, zero, np.array([[1.0, 0.0]]), corrections, 1.0, out)
    assert out[:, 0, 0] == pytest.approx([0.02, 0.2, 0.6, 1.2, 1.5])


def test_the_spread_grows_linearly_from_nothing_to_each_horizon():
    law = np.array([[[0.1, 0.1], [0.1, 0.0]], [[0.4, 0.2], [0.3, 0.0]], [[0.8, 0.4], [0.5, 0.0]]])
    found = spread(law, np.array([2.0]), np.array([0.375, 0.75, 3.0]))
    assert found[:, 0, 0] == pytest.approx([0.15, 0.3, 1.2])
    assert found[:, 0, 1] == pytest.approx([0.05, 0.1, 0.4])
