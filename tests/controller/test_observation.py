"""The observation: its groups, its short names and its copies."""

import numpy as np
import pytest

from controller import Observation

SHORT = {
    "position": "ego.position", "speed": "ego.speed", "acceleration": "ego.acceleration",
    "force": "ego.force", "path": "ego.path", "gap": "ahead.gap",
    "obstacle_positions": "ahead.obstacle_positions", "person_gap": "ahead.person_gap",
    "leader_gap": "ahead.leader_gap", "leader_speed": "ahead.leader_speed",
    "stop_gap": "ahead.stop_gap", "to_clear": "ahead.to_clear",
    "speed_limit": "limits.speed_limit", "lane_speeds": "limits.lane_speeds",
    "safe_distance": "limits.safe_distance", "people": "pedestrians.people",
    "person_ids": "pedestrians.ids", "foresight": "pedestrians.foresight",
    "vehicles": "traffic.poses", "row": "traffic.row",
}  # fmt: skip


@pytest.mark.parametrize("name", SHORT)
def test_a_short_name_means_the_field_of_a_group(name):
    value = object()
    observation = Observation(**{name: value})
    group, field = SHORT[name].split(".")
    assert getattr(observation, name) is value
    assert getattr(getattr(observation, group), field) is value
    setattr(getattr(observation, group), field, None)
    assert getattr(observation, name) is None


def test_a_short_name_is_read_only():
    with pytest.raises(AttributeError):
        Observation().speed = 3.0


def test_what_is_not_told_is_absent():
    seen = Observation()
    gaps = seen.gap, seen.person_gap, seen.leader_gap, seen.stop_gap, seen.speed_limit
    assert gaps == 5 * (np.inf,)
    assert seen.people is seen.vehicles is seen.lane_speeds is seen.path is None
    assert len(seen.obstacle_positions) == 0


def test_a_copy_shares_no_group():
    seen = Observation(1.0, 2.0, 3.0, np.ones(4), time=5.0)
    copied = seen.replaced(speed=7.0, time=6.0)
    assert (copied.position, copied.speed, copied.gap, copied.time) == (1.0, 7.0, 3.0, 6.0)
    copied.ego.position = copied.ahead.gap = copied.limits.speed_limit = 0.0
    copied.pedestrians.people, copied.traffic.row = [], 3
    assert (seen.position, seen.speed, seen.gap, seen.time) == (1.0, 2.0, 3.0, 5.0)
    assert (seen.speed_limit, seen.people, seen.row) == (np.inf, None, 0)


@pytest.mark.parametrize("make", [Observation, Observation().replaced])
def test_an_unknown_name_is_told_with_those_known(make):
    with pytest.raises(TypeError, match=r"Observation\(sped = ...\): expected one of time, pos"):
        make(sped=1.0)
