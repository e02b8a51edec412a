"""The entrance of an ego: taken over where it is, or inserted where its route says."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import giveway

if TYPE_CHECKING:
    from pathlib import Path


Drive = Callable[..., tuple[Any, Any]]  # the result of a run, and what was seen on the way


NOBODY = {"crowd": {"zone": "none"}}


ALONE = {"traffic_lights": False, "following": False}  # [rules]


@pytest.mark.parametrize("step", [1, 0.1, 0.05])
def test_a_vehicle_keeps_place_and_speed_when_taken_over(
    drive: Drive, city: Callable[[float], Path], step: float
) -> None:
    result, look = drive(city(step), ego={"take_over": ("car10",)}, time_limit=5.0, **NOBODY)
    track, first = result.ego_track, look.times.index(result.time[0])
    x, y, angle, speed, length, width = look.cars[first]["car10"]  # as SUMO had it
    assert "car10" not in look.cars[first - 1]
    assert (track.front_x[0], track.front_y[0]) == pytest.approx((x, y), abs=1e-6)
    assert math.degrees(math.pi / 2 - track.heading[0]) % 360 == pytest.approx(angle, abs=1e-6)
    assert track.speed[0] == speed
    assert (result.shape.length, result.shape.width) == (length, width)
    assert track.position[0] == 0.0
    moved = np.hypot(np.diff(track.front_x), np.diff(track.front_y))
    assert moved.max() <= track.speed.max() * result.manifest["time_step"] + 1e-9


def test_a_left_turn_begins_on_the_left_lane(drive: Drive, city: Callable[[float], Path]) -> None:
    ego = {"route": ("A1B1", "B1B2"), "lane": 1, "travel_distance": 120.0}
    regulation = {"reference_speed": 4.0}
    result, look = drive(city(0.1), ego=ego, regulation=regulation, rules=ALONE, **NOBODY)
    track = result.ego_track
    on_edge = track.front_x < look.lanes["A1B1_1"][-1, 0]
    y = track.front_y[on_edge]
    assert y[0] == pytest.approx(look.lanes["A1B1_1"][0, 1])
    assert y[-1] == pytest.approx(look.lanes["A1B1_2"][0, 1], abs=0.01)
    assert (np.diff(y) >= -1e-9).all()  # one smooth change, to the left
    assert np.abs(np.diff(y)).max() < 0.05


def test_an_unknown_ego_is_refused_with_a_hint(
    city: Callable[[float], Path],
) -> None:
    with pytest.raises(giveway.GivewayError, match=r"--ego car1O.*did you mean 'car1"):
        giveway.run({"scenario": str(city(1)), "ego": {"take_over": ("car1O",)}})


def test_an_ego_that_never_finds_room_to_depart_is_reported(
    scenario: Callable[..., Path],
) -> None:
    config = scenario(
        """<vehicle id="block" depart="0" departPos="20"><route edges="A0B0"/>
        <stop lane="A0B0_1" endPos="20" duration="500"/></vehicle>
        <vehicle id="late" depart="2" departPos="18" departLane="1"><route edges="A0B0"/></vehicle>
        """,
        end=20,
    )
    with pytest.raises(giveway.GivewayError, match=r"--ego late: .*until 20 s"):
        giveway.run({"scenario": str(config), "ego": {"take_over": ("late",)}})
