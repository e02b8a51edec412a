"""The junction in real SUMO: signals, crossings, people and cars.

                 north
          w0 = c0 = w1
west --- c3       c1 --- c (zebra) --- east
          w3 = c2 = w2
                 south
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from sumo_scenarios import find

Probe = Callable[..., dict[str, Any]]
Settings = Callable[..., dict[str, Any]]

ARMS = [f"centre_c{i}" for i in range(4)]


@pytest.fixture
def watch(probe: Probe) -> Probe:
    def run(seed: int) -> dict[str, Any]:
        return probe("watch_junction", find("junction").config_file, None, seed=seed)

    return run


def test_the_crossings_of_all_arms_have_signals_and_the_zebra_has_none(watch: Probe) -> None:
    seen = watch(seed=1)
    assert seen["signalised"] == ARMS
    assert seen["crossings"] == [*ARMS, "zebra_c0"]


@pytest.mark.parametrize("seed", [1, 7])
def test_some_dozens_of_people_use_every_crossing_and_none_on_red(watch: Probe, seed: int) -> None:
    seen = watch(seed=seed)
    assert 24 <= len(seen["departed"]) <= 96
    assert set(seen["used"]) == {*ARMS, "zebra_c0"}
    assert min(seen["used"].values()) >= 3
    assert seen["on_red"] == []


def test_cars_come_from_all_arms_and_nobody_collides(watch: Probe) -> None:
    seen = watch(seed=1)
    straight = ["eastbound", "northbound", "southbound", "westbound"]
    assert seen["cars"] == sorted([*straight, "turning_left", "turning_right"])
    assert seen["teleports"] == 0
    assert seen["collisions"] == 0


def test_who_walks_when_is_a_matter_of_the_seed(watch: Probe) -> None:
    assert watch(seed=1)["departed"] == watch(seed=1)["departed"]
    assert watch(seed=1)["departed"] != watch(seed=2)["departed"]


def test_the_ego_departs_on_green_and_finds_red_if_it_is_held_up(
    watch: Probe, settings: Settings
) -> None:
    ego = settings(find("junction"))["ego"]
    lights = {float(time): state[10] for time, state in watch(seed=1)["lights"].items()}
    to_the_stop_line = (112.0 - ego["depart_position"]) / ego["initial_speed"]
    arrival = ego["depart_time"] + to_the_stop_line
    assert {light for time, light in lights.items() if ego["depart_time"] < time < arrival} == {"G"}
    assert {light for time, light in lights.items() if 61.0 < time < 89.0} == {"r"}


def test_the_step_is_a_tenth_of_a_second(probe: Probe) -> None:
    assert probe("load", find("junction").config_file)["step_length"] == 0.1


def test_the_egos_way_leads_over_the_signals_and_the_zebra(settings: Settings) -> None:
    ego = settings(find("junction"))["ego"]
    assert ego["route"] == ["west_in", "east_out", "far_east_out"]
    front = -120.0 + ego["depart_position"] + ego["travel_distance"]  # the way is straight
    assert front > 62.0 + 5.0  # the zebra's far side and a car's length
