"""Departures of egos: at their time, on a lane for vehicles, under a name of their own."""

import pytest

import giveway


def test_a_departure_after_the_scenarios_end_is_refused() -> None:
    with pytest.raises(giveway.GivewayError, match=r"--ego-depart-time 300.*ends at 120 s"):
        giveway.run({"ego": {"depart_time": 300.0}})


def test_a_pavement_is_no_lane_for_the_ego() -> None:
    with pytest.raises(giveway.GivewayError, match=r"eastbound_0.*not for cars.*\[1\]"):
        giveway.run({"scenario": "street", "ego": {"lane": 0}})


def test_an_ego_id_that_a_pedestrian_has_is_refused() -> None:
    with pytest.raises(giveway.GivewayError, match="ped3"):
        giveway.run({"ego": {"id": "ped3"}})
