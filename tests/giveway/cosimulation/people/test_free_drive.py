"""The drive that the first ego would make with nobody about."""

import pytest

from giveway.config import RunConfig
from giveway.cosimulation.people.free_drive import free_drive
from giveway.geometry.path import EgoPath

PATH = EgoPath.through([(0.0, 0.0), (120.0, 0.0)])


def test_without_a_path_there_is_none() -> None:
    assert free_drive(RunConfig(), None) is None


def test_it_leads_to_the_end_unless_a_distance_is_set() -> None:
    whole = RunConfig(ego={"depart_position": 20.0, "travel_distance": None})
    drive = free_drive(whole, PATH)
    assert drive is not None
    assert (drive.departure, drive.distance) == (20.0, pytest.approx(100.0))
    part = free_drive(RunConfig(ego={"travel_distance": 40.0}), PATH)
    assert part is not None
    assert part.distance == 40.0


def test_where_lanes_say_how_fast_the_departure_speed_counts() -> None:
    config = {"regulation": {"reference_speed": "lane"}, "ego": {"initial_speed": 7.0}}
    drive = free_drive(RunConfig(**config), PATH)
    assert drive is not None
    assert drive.speed == 7.0
    slow = free_drive(RunConfig(regulation={"reference_speed": 3.0}), PATH)
    assert slow is not None
    assert slow.speed == 3.0


def test_a_vehicle_that_is_taken_over_does_not_count() -> None:
    egos = [
        {"ego": {"take_over": ["bus"]}},
        {"ego": {"route": ["ab"], "id": "mine", "travel_distance": 33.0}},
    ]
    drive = free_drive(RunConfig(egos=egos), PATH)
    assert drive is not None
    assert drive.distance == 33.0
