"""The path as a controller sees it: from the front bumper on."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.ego.perception.path_ahead import PathView
from giveway.geometry.path import EgoPath

RADIUS = 20.0  # [m] of a left bend behind 30 m of straight road
TURNS = np.linspace(-np.pi / 2, np.pi / 2, 200)
BEND = np.column_stack([30.0 + RADIUS * np.cos(TURNS), RADIUS + RADIUS * np.sin(TURNS)])
PATH = EgoPath.through([(0.0, 0.0), *BEND])


def view(station: float) -> PathView:
    seen = PathView(PATH)
    seen.station = station
    return seen


def test_poses_follow_the_path_and_go_straight_on_beyond_it() -> None:
    seen, ahead = view(10.0), np.array([0.0, 5.0, 30.0, 60.0, 200.0])
    expected = [PATH.pose(10.0 + distance) for distance in ahead]
    np.testing.assert_allclose(seen.poses(ahead), expected, atol=1e-9)
    assert seen.remaining() == pytest.approx(PATH.length - 10.0)
    assert view(PATH.length + 3.0).remaining() == 0.0


def test_the_curvature_is_that_of_the_bend_not_of_its_corners() -> None:
    assert view(0.0).curvature(np.array([5.0, 15.0])) == pytest.approx(0.0, abs=1e-12)
    assert view(40.0).curvature(np.linspace(20.0, 35.0, 50)) == pytest.approx(1 / RADIUS, rel=0.01)
    mirrored = PathView(EgoPath.through(PATH.vertices * (1.0, -1.0)))
    assert mirrored.curvature(np.array([70.0])) == pytest.approx(-1 / RADIUS, rel=0.01)
