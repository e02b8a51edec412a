"""Traffic lights: nobody of ours sets out at red, neither on foot nor behind the wheel."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from sumo_scenarios import find

if TYPE_CHECKING:
    from pathlib import Path


Drive = Callable[..., tuple[Any, Any]]  # the result of a run, and what was seen on the way


def test_walkers_cross_at_green_and_wait_at_red(
    drive: Drive, city: Callable[[float], Path]
) -> None:
    crowd = {"zone": "everywhere"}
    result, look = drive(city(0.1), ego={"none": True}, crowd=crowd, time_limit=70.0)
    ours = set(result.crowd_track.ids)
    at_green, at_red = look.entered(ours)
    assert at_green > 50
    assert at_red == 0


def test_who_is_taken_over_while_waiting_keeps_waiting(demonstration: Path, drive: Drive) -> None:
    # Three persons stand at red lights when the truck departs, at 54221.4 s.
    result, look = drive(
        demonstration,
        ego={"take_over": ("1695567809612117",)},
        crowd={"zone": "everywhere"},
        time_limit=8.0,
    )
    ours = set(result.crowd_track.ids)
    assert len(ours) >= 10
    begin = look.times.index(result.time[0])
    waiting = [
        name
        for name, place in look.people[begin - 1].items()
        if name in ours and look.people[begin - 40].get(name) == place
    ]
    assert len(waiting) >= 3
    assert look.entered(set(waiting))[1] == 0


@pytest.mark.parametrize("speed", [4.0, 13.0])
@pytest.mark.parametrize("step", [1, 0.1])
def test_the_ego_stops_before_a_red_line_and_goes_at_green(
    drive: Drive, city: Callable[[float], Path], speed: float, step: float
) -> None:
    route = ("A1B1", "B1C1", "C1D1")
    result, look = drive(
        city(step),
        ego={"route": route, "lane": 1, "depart_time": 95.0, "travel_distance": 205.0},
        regulation={"reference_speed": speed},
        rules={"following": False},
        crowd={"zone": "none"},
        time_limit=150.0,
    )
    track = result.ego_track
    stops = 0
    for source, target in (("A1B1_1", "B1C1_1"), ("B1C1_1", "C1D1_1")):
        line = look.lanes[source][-1, 0]
        crossing = int(np.searchsorted(track.front_x, line))
        assert crossing < len(track.time)
        before = track.time[crossing - 1]
        assert look.colour(source, target, before) in "gGy"
        near = (track.front_x < line) & (track.front_x > line - 5.0)
        red = np.array([look.colour(source, target, t) == "r" for t in track.time[near]])
        stops += bool((red & (track.speed[near] < 0.1)).any())
        if red.any():
            standing = track.front_x[near][red].max()
            assert line - 4.0 < standing < line - 0.3
    assert stops >= 1


@pytest.mark.parametrize(("departure", "passes"), [(50.0, True), (52.0, False)])
def test_at_yellow_the_ego_stops_if_it_can(drive: Drive, departure: float, passes: bool) -> None:
    # It is told nothing before: who knows when the green ends does not come at yellow. That
    # begins at 55 s. At 8 m/s the ego is then 12 m from the line, and would have to brake
    # with 2.7 m/s^2, or 28 m, where 1.1 m/s^2 are enough; 2 m/s^2 are comfortable.
    result, look = drive(
        find("junction").config_file,
        ego={"depart_time": departure, "depart_position": 60.0, "initial_speed": 8.0},
        regulation={"reference_speed": 8.0},
        rules={"following": False, "signal_plans": False},
        crowd={"zone": "none"},
        time_limit=12.0,
    )
    track = result.ego_track
    over = track.front_x >= look.lanes["west_in_1"][-1, 0]
    assert over.any() == passes
    if passes:
        at = track.time[int(np.argmax(over)) - 1]
        assert look.colour("west_in_1", "east_out_1", at) == "y"
