"""Egos in somebody else's streets: stops, odd steps, departures one after the other.

A2--B2--C2    A grid of 3 x 3 junctions, 100 m apart, two lanes per direction.
|   |   |     Edge A0B0 runs east from the south-western corner.
A0--B0--C0
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from support.streets import EASTWARDS, NOBODY, ROUTE

import giveway
from giveway.errors import ScenarioError
from giveway.run_data.progress import Ending

if TYPE_CHECKING:
    from collections.abc import Callable

    Scenario = Callable[..., str]


@pytest.mark.parametrize(
    "stop",
    [
        'lane="A0B0_1" endPos="40" duration="20"',
        'lane="A0B0_1" endPos="40" duration="20" parking="true"',
        'lane="A0B0_1" endPos="40" triggered="true"',
        'lane="B0C0_1" endPos="40" duration="10" parking="true"',
    ],
)
@pytest.mark.parametrize("departure", ["0", "stop"])
def test_the_stops_of_a_vehicle_that_is_taken_over_are_left_out(
    street_scenario: Scenario, stop: str, departure: str
) -> None:
    if departure == "stop" and "B0C0" in stop:
        departure = "0"
    car = f'<vehicle id="car" depart="0" departPos="{departure}">{ROUTE}<stop {stop}/></vehicle>'
    result = giveway.run(
        {"scenario": street_scenario(car), "ego": {"take_over": ("car",), "travel_distance": 120}}
        | NOBODY
    )
    assert result.completed
    assert any("'car': its 1 stop(s) are left out" in remark for remark in result.remarks)
    assert result.ego_track.speed[1:].min() > 0


@pytest.mark.parametrize("step", [0.0333, 0.0335])
def test_a_step_is_rounded_to_milliseconds_as_by_sumo(
    street_scenario: Scenario, step: float
) -> None:
    ego = {"route": EASTWARDS, "travel_distance": 5}
    result = giveway.run({"scenario": street_scenario("", step=step), "ego": ego} | NOBODY)
    assert result.completed
    assert result.manifest["time_step"] == result.manifest["sumo"]["step_length"]


def test_an_endless_scenario_waits_for_all_egos_to_be_inserted(
    street_scenario: Scenario,
) -> None:
    egos = ({"ego": {"id": "first"}}, {"ego": {"id": "second", "depart_time": 40}})
    result = giveway.run(
        {
            "scenario": street_scenario("", end=-1),
            "ego": {"route": EASTWARDS, "travel_distance": 10},
            "egos": egos,
        }
        | NOBODY
    )
    assert [ego.ending for ego in result.egos] == [Ending.COMPLETED] * 2
    assert result.egos[1].track.time[0] == 40


def test_an_ego_cannot_have_the_name_of_a_vehicle_yet_to_depart(street_scenario: Scenario) -> None:
    car = f'<vehicle id="ego" depart="20">{ROUTE}</vehicle>'
    with pytest.raises(ScenarioError, match=r"--ego-id ego: .*choose another"):
        giveway.run({"scenario": street_scenario(car), "ego": {"route": EASTWARDS}} | NOBODY)
