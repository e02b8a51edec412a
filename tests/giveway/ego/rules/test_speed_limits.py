"""Speed limits along the path, and limits that change while the ego drives."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import giveway
from giveway.ego.rules.protocol import Situation
from giveway.ego.rules.speed_limits import SpeedLimits, VariableSpeedLimits
from giveway.ego.rules.speed_profile import SpeedProfile
from giveway.geometry.path import EgoPath
from giveway.scenario_files.configuration_text import configuration_of
from giveway.scenario_files.path_network import network_along
from giveway.sumo.network.lane_path import SpeedLimit

if TYPE_CHECKING:
    from pathlib import Path

ROAD = EgoPath.through([(0.0, 0.0), (600.0, 0.0)])
LIMITS = (SpeedLimit(0.0, 16.0, ("a_0",)), SpeedLimit(400.0, 8.0, ("b_0", "b_1")))
TIMES = 0.1 * np.arange(1.0, 31.0)


def profile() -> SpeedProfile:
    """The speeds of an ego on a straight road with two lanes in a row."""
    return SpeedProfile(ROAD, LIMITS, length=5.0, capable=30.0, deceleration=2.0)


def test_a_limit_below_the_fastest_is_demanded() -> None:
    rule = SpeedLimits(profile(), TIMES)
    assert rule.demand(Situation(0.0, 100.0, 16.0)).speed == np.inf
    assert rule.demand(Situation(0.0, 450.0, 8.0)).speed == pytest.approx(8.0)


def test_a_new_limit_is_reached_with_comfort() -> None:
    now = {"a_0": 16.0, "b_0": 9.0, "b_1": 8.0}
    rule = VariableSpeedLimits(profile(), TIMES, LIMITS, now.__getitem__)
    there = Situation(7.0, 100.0, 16.0)
    rule.update(there)
    assert rule.demand(there).speed == np.inf  # nothing has changed
    now["a_0"] = 10.0
    rule.update(there)
    assert rule.demand(there).speed == pytest.approx(16.0)
    ahead = rule.demand(there).lane_speeds
    assert ahead is not None
    np.testing.assert_allclose(ahead, 16.0 - 2.0 * TIMES, atol=1e-6)
    there.time, there.station = 8.0, 115.0
    assert rule.demand(there).speed == pytest.approx(14.0)
    there.time, there.station = 12.0, 160.0
    assert rule.demand(there).speed == pytest.approx(10.0)
    now["a_0"] = 20.0  # never faster than the fastest limit at the departure
    rule.update(there)
    assert rule.demand(there).speed == np.inf


def test_the_lower_limit_of_two_lanes_holds_where_the_ego_changes() -> None:
    now = {"a_0": 16.0, "b_0": 9.0, "b_1": 5.0}
    rule = VariableSpeedLimits(profile(), TIMES, LIMITS, now.__getitem__)
    rule.update(Situation(0.0, 100.0, 16.0))
    assert rule.demand(Situation(20.0, 450.0, 5.0)).speed == pytest.approx(5.0)


def test_a_variable_speed_sign_is_obeyed(tmp_path: Path) -> None:
    (tmp_path / "road.net.xml").write_text(network_along(ROAD.vertices, 13.89))
    inputs = '<net-file value="road.net.xml"/><additional-files value="sign.add.xml"/>'
    text = configuration_of("road", 60.0)
    (tmp_path / "road.sumocfg").write_text(text.replace('<net-file value="road.net.xml"/>', inputs))
    (tmp_path / "sign.add.xml").write_text(
        '<additional><variableSpeedSign id="sign" lanes="drive_0"><step time="5" speed="6"/>'
        '<step time="20" speed="10"/></variableSpeedSign></additional>'
    )
    drive = giveway.run(
        {
            "scenario": str(tmp_path / "road.sumocfg"),
            "controller": "pid-tuned",
            "ego": {"route": ["drive"], "initial_speed": 13.0, "travel_distance": 280.0},
            "crowd": {"pedestrians": 0},
        }
    ).egos[0].track  # fmt: skip
    assert drive.speed[drive.time < 5.0].max() == pytest.approx(13.89, abs=0.2)
    low = drive.speed[(drive.time > 10.0) & (drive.time < 19.9)]
    assert np.abs(low - 6.0).max() < 0.2
    assert drive.acceleration.min() > -3.5
    assert drive.speed[-1] == pytest.approx(10.0, abs=0.2)
