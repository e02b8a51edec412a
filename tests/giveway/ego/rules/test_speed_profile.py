"""The speed that lanes, vehicle and bends leave a free ego, and where it begins to brake."""

from __future__ import annotations

import math
from contextlib import ExitStack

import numpy as np
import pytest

from giveway.config import EgoRunConfig
from giveway.ego.controllers import make_controller
from giveway.ego.preparation import make_waiting_ego
from giveway.ego.rules.speed_profile import SpeedProfile, profile_of
from giveway.errors import ScenarioError
from giveway.geometry.path import EgoPath
from giveway.sumo.network.lane_path import SpeedLimit

STRAIGHT = EgoPath.through([(0.0, 0.0), (400.0, 0.0)])
RADIUS = 20.0  # [m] of a left bend of 180 degrees behind 100 m of straight road
TURNS = np.linspace(-np.pi / 2, np.pi / 2, 200)
BEND = EgoPath.through(
    [
        (0.0, 0.0),
        *np.column_stack([100.0 + RADIUS * np.cos(TURNS), RADIUS + RADIUS * np.sin(TURNS)]),
        (0.0, 2 * RADIUS),
    ]
)
B = 2.0  # [m/s^2]
DROP = (SpeedLimit(0.0, 13.9), SpeedLimit(200.0, 8.3), SpeedLimit(300.0, 11.0))


def profile(path=STRAIGHT, limits=DROP, capable=50.0, **options):
    return SpeedProfile(path, limits, length=5.0, capable=capable, deceleration=B, **options)


def test_it_brakes_before_a_lower_limit_and_speeds_up_behind_it():
    seen = profile()
    braked = (13.9**2 - 8.3**2) / (2.0 * B)
    assert seen.at(200.0 - braked - 1.0) == 13.9
    for before in (0.5, 10.0, 20.0):
        expected = math.sqrt(8.3**2 + 2.0 * B * before)
        assert seen.at(200.0 - before) == pytest.approx(expected, abs=1e-9)
    assert seen.at(200.0) == seen.at(250.0) == seen.at(300.0) == pytest.approx(8.3)
    assert seen.at(301.0) == seen.at(1e4) == pytest.approx(11.0)
    assert seen.at(-5.0) == 13.9  # before the path begins


def test_the_time_between_two_places_is_that_of_a_free_ego():
    seen = profile()
    assert seen.duration(0.0, 139.0) == pytest.approx(10.0)
    assert seen.duration(210.0, 293.0) == pytest.approx(10.0)
    braked = (13.9**2 - 8.3**2) / (2.0 * B)
    assert seen.duration(200.0 - braked, 200.0) == pytest.approx((13.9 - 8.3) / B, rel=1e-3)


def test_no_limit_is_exceeded_anywhere_however_the_lanes_end():
    limits = tuple(SpeedLimit(s, v) for s, v in ((-30.0, 3.0), (-7.3, 9.0), (81.2, 5.0), (83.9, 7)))
    seen = profile(limits=limits)
    for station in np.arange(0.0, 150.0, 0.1):
        mine = [limit.speed for limit in limits if limit.station <= station][-1]
        assert seen.at(station) <= mine + 1e-9
    assert seen.at(60.0) == pytest.approx(9.0)
    assert seen.at(90.0) == pytest.approx(7.0)


def test_a_bend_is_driven_in_comfort_and_braked_for_before_it():
    seen = profile(BEND, (SpeedLimit(0.0, 13.9),))
    in_the_bend = 7.66  # [m/s] 17.1 mph, where AASHTO's side friction is 0.30: 2.93 m/s^2 at 20 m
    assert seen.at(130.0) == pytest.approx(in_the_bend, rel=0.01)
    before = 30.0
    braking = math.sqrt(in_the_bend**2 + 2.0 * B * before)
    assert braking * 0.95 < seen.at(100.0 - before) < braking * 1.02
    assert seen.at(20.0) == 13.9
    falling = np.diff(seen.speeds**2) / (2.0 * 0.5)
    assert falling.min() >= -B - 1e-9


def test_it_is_clipped_to_what_the_vehicle_may():
    seen = profile(capable=10.0)
    assert seen.at(50.0) == seen.fastest == 10.0
    assert seen.at(250.0) == pytest.approx(8.3)
    assert profile(departure=250.0).fastest == 11.0


def test_the_controller_is_told_only_of_limits_below_its_speed():
    seen = profile()
    assert seen.limit(20.0, 13.9) == math.inf
    assert seen.limit(250.0, 8.3) == pytest.approx(8.3)
    assert seen.limit(190.0, 10.0) < seen.at(190.0)  # it follows with a lag


def test_a_plan_is_told_the_speeds_at_its_steps():
    seen, times = profile(), 0.05 * np.arange(1, 61)
    start = 180.0
    v = seen.at(start)
    ahead = seen.ahead(start, v, times)
    braking = v - B * times
    np.testing.assert_allclose(ahead, np.maximum(braking, 8.3), atol=0.01)
    too_fast = seen.ahead(250.0, 12.0, times)
    np.testing.assert_allclose(too_fast, np.maximum(12.0 - B * times, 8.3), atol=0.01)


@pytest.mark.parametrize(
    ("own", "fastest"),
    [
        ({}, 20.0),
        ({"vehicle": {"speed_max": 12.5}}, 12.5),
        ({"vehicle": {"mass": 10_000.0, "friction": 0.0, "force_limit": 4000.0}}, 7.9),
    ],
    ids=["as it is", "speed_max", "what it stops from in time"],
)
def test_the_cap_is_the_model_s_and_the_safety_layer_s(own, fastest):
    config = EgoRunConfig.model_validate({"regulation": {"reference_speed": "lane"}, **own})
    with ExitStack() as stack:
        ego = make_waiting_ego(config, make_controller(config, 0.05), 0.05, stack)
        limits = (SpeedLimit(0.0, 36.0),)
        found = profile_of(ego, STRAIGHT, limits, 0.0, 5.0, math.inf, 0.05)
        assert found is not None
        assert found.fastest == pytest.approx(fastest, abs=0.1)
        slow = profile_of(ego, STRAIGHT, limits, 0.0, 5.0, 5.56, 0.05)
        assert slow is not None
        assert slow.fastest == 5.56
        with pytest.raises(ScenarioError, match=r"follows no lanes; expected a speed \[m/s\]"):
            profile_of(ego, STRAIGHT, (), 0.0, 5.0, math.inf, 0.05)
