"""The safety layer of an ego: poses along its path, and when it acts."""

import numpy as np
import pytest
from support.front_poses import front_poses

from controller import Decision, SafetyParameters
from giveway.config import EgoRunConfig
from giveway.ego.perception import Percept
from giveway.ego.safety_layer import EgoSafetyLayer
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import EgoPath
from pedestrian_model import Crowd

ASKED = Decision(400.0, "pid", "selected", "", 0, 4.0, None)


def quarter_turn(radius: float) -> EgoPath:
    """East for 20 m, round to the north, and on for 20 m."""
    angles = np.linspace(0.0, np.pi / 2, 40)
    x = 20.0 + radius * np.sin(angles)
    y = radius * (1.0 - np.cos(angles))
    end = (20.0 + radius, radius + 20.0)
    return EgoPath.through([(0.0, 0.0), *zip(x, y, strict=True), end])


def guard(path: EgoPath) -> EgoSafetyLayer:
    config = EgoRunConfig.model_validate({"controller": "mpc"})
    return EgoSafetyLayer(SafetyParameters(), config, path, VehicleShape(5.0, 2.0), 0.05)


def person_at(x: float, y: float) -> Percept:
    return Percept(Crowd.create([(x, y)], [(0.0, 0.0)], 1.4, [[(x, y)]]), np.zeros(1, np.int64))


def test_on_a_straight_way_one_pose_says_everything() -> None:
    way, _ = front_poses(EgoPath.through([(0.0, 0.0), (50.0, 50.0)]), 14.0, 30.0, 5.0)
    half = np.sqrt(0.5)
    np.testing.assert_allclose(way, [[14.0 * half, 14.0 * half, half, half]])


def test_in_a_bend_the_poses_are_those_of_the_body() -> None:
    path = quarter_turn(8.0)
    way, spacing = front_poses(path, 18.0, 6.0, 5.0)
    assert len(way) * spacing > 6.0
    for i, (x, y, cos, sin) in enumerate(way):
        pose = path.pose(18.0 + i * spacing, 5.0)
        assert (x, y) == pytest.approx((pose.x, pose.y))
        assert (cos, sin) == pytest.approx((np.cos(pose.heading), np.sin(pose.heading)))


def test_a_way_of_any_length_is_sampled_to_its_end() -> None:
    way, spacing = front_poses(quarter_turn(8.0), 0.0, 5000.0, 5.0)
    assert (len(way) - 1) * spacing >= 5000.0


def test_in_a_bend_it_brakes_for_people_on_the_path_not_ahead() -> None:
    path = quarter_turn(5.0)
    front = 20.0 + 0.25 * np.pi * 5.0  # half way round
    on_it, heading = path.pose(front + 1.8), path.pose(front, 5.0).heading
    here = path.pose(front)
    assert guard(path).overrule(ASKED, front, 4.0, person_at(on_it.x, on_it.y)).acting == "safety"
    tangent = here.x + 4.0 * np.cos(heading), here.y + 4.0 * np.sin(heading)
    assert guard(path).overrule(ASKED, front, 4.0, person_at(*tangent)) is None


def test_who_is_in_sight_of_nobody_keeps_the_very_decision() -> None:
    path = EgoPath.through([(0.0, 0.0), (100.0, 0.0)])
    assert guard(path).overrule(ASKED, 10.0, 4.0, person_at(40.0, 0.0)) is None
