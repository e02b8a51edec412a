"""Cohesion of groups: an attraction towards the group's centre."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.crowd.motion.cohesion import Cohesive, attraction
from pedestrian_model import SIM, Crowd, CrowdModel, PlainModel, Vehicles

STEP = 0.05


def test_attraction_is_zero_within_the_threshold_then_the_papers() -> None:
    pair = np.array([[0.0, 0.0], [0.9, 0.0], [50.0, 50.0]])
    groups = np.array([4, 4, -1])
    assert not attraction(pair, groups).any()  # 0.45 m from the middle: the threshold is 0.5 m
    pair[1, 0] = 2.0  # 0.5 m beyond the threshold
    assert attraction(pair, groups) == pytest.approx(np.array([[1.5, 0], [-1.5, 0], [0, 0]]))
    pair[1, 0] = 9.0
    assert attraction(pair, groups) == pytest.approx(np.array([[3.0, 0], [-3.0, 0], [0, 0]]))


def apart(model, groups, seconds: float = 6.0) -> float:
    """How far apart two are at the end who began 5 m apart and walk the same way."""
    crowd = Crowd.create([(0, 0), (5, 0)], [(0, 1.3)] * 2, 1.3, [[(0, 90)], [(5, 90)]])
    moved = Cohesive(model, lambda: np.array(groups))
    for _ in range(round(seconds / STEP)):
        moved.advance(crowd, Vehicles.empty())
    speed = np.hypot(*crowd.velocity.T)
    assert speed.max() <= SIM.max_speed + 1e-9
    return float(np.hypot(*(crowd.position[1] - crowd.position[0])))


@pytest.mark.parametrize("model", [CrowdModel(SIM, STEP), PlainModel("social-force", SIM, STEP)])
def test_who_belongs_together_walks_together_and_others_do_not(model) -> None:
    assert apart(model, [-1, -1]) == pytest.approx(5.0, abs=0.3)
    assert 0.6 < apart(model, [0, 0]) < 2.5
