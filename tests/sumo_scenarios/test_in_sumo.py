"""Each bundled scenario in real SUMO, headless, with the flags that giveway uses.

plaza (shared_space)              street
y                                 y        <-- westbound (with traffic)
|   destinations                  | sidewalk
+--ego-->-----------> x           +-----------------------> x
|      ^ ^ ^                      |  ego-->   ^ ^ ^       (then bends left)
|      crowd                      | sidewalk: crowd
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from sumo_scenarios import Scenario, find

Probe = Callable[..., dict[str, Any]]
Settings = Callable[[Scenario], dict[str, Any]]

EXACT = 1e-9  # [m]
CAR_LENGTH = 5.0  # [m]
STEP_LENGTHS = [None, 0.05, 1.0]  # [s], None: the scenario's own


def test_the_plaza_steps_like_the_controller_traffic_at_a_tenth(probe: Probe) -> None:
    """Cars that see people once in a second only drive into them."""
    assert probe("load", find("shared_space").config_file)["step_length"] == 0.05
    for name in ("street", "junction", "crossings"):
        assert probe("load", find(name).config_file)["step_length"] == 0.1


def test_sumo_ends_no_earlier_than_giveways_time_limit(
    scenario: Scenario, probe: Probe, settings: Settings
) -> None:
    given = settings(scenario)
    depart_time = given["ego"]["depart_time"]
    latest = depart_time[-1] if isinstance(depart_time, list) else depart_time
    assert probe("load", scenario.config_file)["end"] >= latest + given["time_limit"]


def test_the_plaza_is_the_papers_coordinate_system(probe: Probe, settings: Settings) -> None:
    plaza = find("shared_space")
    ego = settings(plaza)["ego"]
    (x0, y0), (x1, y1) = probe("load", plaza.config_file)["lanes"]["plaza_0"]["shape"]
    assert (x0, y0, x1, y1) == (-20.0, 0.0, 100.0, 0.0)
    assert x0 + ego["depart_position"] - CAR_LENGTH / 2 == 0.0
    assert ego["travel_distance"] == 40.0


def test_the_plaza_settings_are_the_papers_crowd(settings: Settings) -> None:
    crowd = settings(find("shared_space"))["crowd"]
    assert crowd["spawn_area"] == [23.3, -23.4, 33.2, -12.0]
    assert crowd["walk"] == [0.0, 30.0]
    assert (crowd["desired_speed_mean"], crowd["desired_speed_sd"]) == (1.394, 0.26)
    assert crowd["pedestrians"] == 30


def test_people_cross_the_street_from_sidewalk_to_sidewalk(
    probe: Probe, settings: Settings
) -> None:
    street = find("street")
    crowd = settings(street)["crowd"]
    lanes = probe("load", street.config_file)["lanes"]
    _, y_min, _, y_max = crowd["spawn_area"]
    for sidewalk, walked in (("eastbound_0", 0.0), ("westbound_0", crowd["walk"][1])):
        lane = lanes[sidewalk]
        x_straight_end = 94.0
        centres = {y for x, y in lane["shape"] if x < x_straight_end}
        assert lane["pedestrians_only"]
        assert len(centres) == 1
        (centre,) = centres
        assert centre - lane["width"] / 2 < y_min + walked
        assert y_max + walked < centre + lane["width"] / 2


def test_nothing_is_marked_where_people_cross(probe: Probe) -> None:
    lanes = probe("load", find("street").config_file)["lanes"]
    assert set(lanes) == {"eastbound_0", "eastbound_1", "westbound_0", "westbound_1"}


def test_a_pedestrian_can_live_on_the_host_edge_and_only_there(
    scenario: Scenario, probe: Probe, settings: Settings
) -> None:
    given = settings(scenario)
    lanes = probe("load", scenario.config_file)["lanes"]
    assert lanes[f"{given['crowd']['host_edge']}_0"]["pedestrians_only"]
    assert lanes[f"{given['ego']['route'][0]}_{given['ego']['lane']}"]["bans_pedestrians"]


@pytest.mark.parametrize("step_length", STEP_LENGTHS)
def test_a_vehicle_on_the_egos_route_gets_where_it_should(
    open_road: Scenario, step_length: float | None, probe: Probe, settings: Settings
) -> None:
    ego = settings(open_road)["ego"]
    seen = probe("drive", open_road.config_file, step_length, ego=ego)
    lane = probe("load", open_road.config_file)["lanes"][f"{ego['route'][0]}_{ego['lane']}"]
    goal = ego["depart_position"] + seen["distance"]
    assert seen["departed_at"] == ego["depart_time"]
    assert seen["speed"] == ego["initial_speed"]
    step = ego["initial_speed"] * (step_length or 1.0)
    assert seen["distance"] == pytest.approx(ego["travel_distance"], abs=step)
    assert goal + CAR_LENGTH < lane["length"]
    assert seen["collisions"] == 0


@pytest.mark.parametrize("step_length", [0.05, 1.0])
def test_the_mirrored_ego_is_where_it_is_put_and_is_followed(
    open_road: Scenario, step_length: float, probe: Probe, settings: Settings
) -> None:
    ego = settings(open_road)["ego"]
    seen = probe("mirror_ego", open_road.config_file, step_length, ego=ego)
    per_step = ego["initial_speed"] * step_length
    assert seen["points"] >= int(ego["travel_distance"] / per_step)
    assert seen["off_position"] < EXACT
    assert seen["off_angle"] < EXACT
    assert seen["collisions"] == 0


@pytest.mark.parametrize("step_length", [0.05, 1.0])
def test_ghost_persons_are_where_they_are_put_from_the_start(
    scenario: Scenario, step_length: float, probe: Probe, settings: Settings
) -> None:
    crowd = settings(scenario)["crowd"]
    seen = probe("move_ghosts", scenario.config_file, step_length, crowd=crowd)
    assert seen["first_error"] < EXACT
    assert seen["largest_error"] < EXACT
    assert seen["left"] == 0


def test_the_plaza_has_no_traffic(probe: Probe) -> None:
    seen = probe("watch_traffic", find("shared_space").config_file, 1.0, seconds=120)
    assert seen["most_at_once"] == 0


@pytest.mark.parametrize("step_length", [1.0, 0.05])
def test_the_streets_traffic_flows_both_ways(step_length: float, probe: Probe) -> None:
    seen = probe("watch_traffic", find("street").config_file, step_length, seconds=120)
    assert seen["departed"] == {"eastbound": 9, "westbound": 11}  # every 14 s and 11 s
    assert seen["arrived"] >= 15
    assert seen["teleports"] == 0
    assert seen["collisions"] == 0
    assert seen["slowest"] == pytest.approx(30 / 3.6, abs=0.01)
    assert seen["most_at_once"] <= 5


def test_the_ego_drives_in_among_the_cars(probe: Probe, settings: Settings) -> None:
    street = find("street")
    ego = settings(street)["ego"]
    seen = probe("watch_traffic", street.config_file, 1.0, seconds=ego["depart_time"])
    ahead = [pos for name, pos in seen["trace"] if name.startswith("eastbound")][-1]
    assert ego["depart_position"] + 15.0 < ahead < ego["depart_position"] + 60.0
    later = probe("watch_traffic", street.config_file, 1.0, seconds=ego["depart_time"] + 6.0)
    assert any(name == "eastbound.1" for name, _ in later["trace"])


def test_the_ego_meets_the_people_on_the_street(settings: Settings) -> None:
    given = settings(find("street"))
    ego, crowd = given["ego"], given["crowd"]
    x_min, _, _, y_max = crowd["spawn_area"]
    reach = (x_min - ego["depart_position"]) / ego["initial_speed"]
    lane_from, lane_to = -3.5, 0.0  # y of the ego's lane [m]
    enters = (lane_from - y_max) / crowd["desired_speed_mean"]
    leaves = (lane_to - y_max) / crowd["desired_speed_mean"]
    assert enters < reach + CAR_LENGTH / ego["initial_speed"]
    assert reach < leaves + 1.0
    assert x_min - ego["depart_position"] > 8.0  # d_safe: not too late from the start
