"""Who is in the way of SUMO's own cars: the many cars' kernel against one path at a time."""

from __future__ import annotations

import itertools
import math

import libsumo
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from giveway.cosimulation.traffic.lane_paths import (
    LanePathPool,
    _middles,
    gaps_ahead,
    sort_pedestrians,
)
from giveway.ego.perception.corridor import closest_in_front
from giveway.geometry.kernel import kernel
from giveway.geometry.path import EgoPath
from giveway.sumo.network.lanes import Lanes
from giveway.sumo.vehicles import SumoVehicles
from sumo_scenarios import find

closest_in_front = kernel(closest_in_front)

HALF_WIDTH = 1.25


def winding(seed: int, corners: int) -> np.ndarray:
    """(corners, 2) a lane that bends by up to a right angle."""
    draw = np.random.default_rng(seed)
    heading = np.cumsum(draw.uniform(-1.5, 1.5, corners))
    length = draw.uniform(2.0, 30.0, corners)
    return np.cumsum(length[:, None] * np.column_stack([np.cos(heading), np.sin(heading)]), axis=0)


def pooled(lanes: list[np.ndarray]) -> LanePathPool:
    """Each lane a way of its own."""
    along = [
        np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(lane, axis=0).T))]) for lane in lanes
    ]
    return LanePathPool(
        np.concatenate(lanes),
        np.concatenate(along),
        np.cumsum([0, *map(len, lanes)]).astype(np.int64),
        np.array([len(lane) for lane in lanes]),
        np.array([part[-1] for part in along]),
    )


def one_by_one(lane: np.ndarray, station: float, sight: float, people: np.ndarray) -> float:
    """The gap by the ego's own means: a path from the front on, everybody looked at.

    Who is more than 0.3 m behind the end of the lanes does not count.
    """
    path = EgoPath.through(lane)
    front = np.array(path.pose(station)[:2])
    ahead = EgoPath.through([front, *lane[path.stations > station]])
    segments = len(ahead.headings) - 1
    near = people[np.hypot(*(people - front).T) <= sight]
    gap, _ = closest_in_front(
        ahead.vertices, ahead.stations, (0, segments), near, 0.0, HALF_WIDTH, 0.0
    )
    return gap if gap <= min(sight, ahead.length + 0.3) else math.inf


@settings(max_examples=40)
@given(st.integers(0, 10_000), st.integers(2, 12), st.floats(5.0, 120.0))
def test_the_first_in_each_cars_way_is_found(seed: int, corners: int, sight: float) -> None:
    lanes = [winding(seed + k, corners) for k in range(3)]
    ways = pooled(lanes)
    draw = np.random.default_rng(seed)
    people = np.concatenate(lanes)[draw.integers(0, 3 * corners, 60)] + draw.normal(0, 8, (60, 2))
    stations = np.array([draw.uniform(0.0, 0.99) * length for length in ways.nominal])
    fronts = np.array(
        [EgoPath.through(lane).pose(s)[:2] for lane, s in zip(lanes, stations, strict=True)]
    )
    gaps = np.empty(3)
    gaps_ahead(
        (fronts, stations, np.arange(3)),
        ways,
        np.full(3, sight),
        np.full(3, HALF_WIDTH),
        people,
        sort_pedestrians(people),
        gaps,
    )
    found = [gap if gap <= sight else math.inf for gap in gaps]
    expected = [one_by_one(lanes[k], stations[k], sight, people) for k in range(3)]
    assert found == pytest.approx(expected, abs=1e-9)


def test_a_car_on_no_lane_or_at_the_end_of_its_route_sees_nobody() -> None:
    lane = np.array([[0.0, 0.0], [50.0, 0.0]])
    people = np.array([[60.0, 0.0]])
    gaps = np.empty(2)
    gaps_ahead(
        (np.array([[40.0, 0.0], [50.0, 0.0]]), np.array([40.0, 50.0]), np.array([-1, 0])),
        pooled([lane]),
        np.full(2, 100.0),
        np.full(2, HALF_WIDTH),
        people,
        sort_pedestrians(people),
        gaps,
    )
    assert gaps.tolist() == [math.inf, math.inf]


def test_the_middle_of_a_car_cuts_the_inner_side_of_a_bend() -> None:
    angle = np.linspace(0.0, np.pi / 2, 19)
    bend = 10.0 * np.column_stack([np.sin(angle), 1.0 - np.cos(angle)])
    lane = np.vstack([[-30.0, 0.0], bend, bend[-1:], [10.0, 40.0]])
    middles = _middles(lane)
    assert middles.shape == lane.shape
    assert middles[[0, 1, -1]] == pytest.approx(lane[[0, 1, -1]], abs=0.3)
    inwards = np.hypot(*(middles[8:13] - (0.0, 10.0)).T)
    assert inwards == pytest.approx(10.0 * np.cos(2.25 / 10.0), abs=0.01)  # of a chord of 4.5 m
    straight = np.array([[0.0, 0.0], [5.0, 0.0], [60.0, 0.0]])
    assert _middles(straight) == pytest.approx(straight)
    assert _middles(straight[:1]).tolist() == [[0.0, 0.0]]


@pytest.mark.parametrize("count", [0, 1, 7, 1000])
def test_everybody_is_in_exactly_one_bucket(count: int) -> None:
    people = np.random.default_rng(count).normal(0.0, 500.0, (count, 2))
    grid = sort_pedestrians(people)
    buckets = max(1, count)
    assert sorted(grid[buckets + 1 :]) == list(range(count))
    assert (np.diff(grid[: buckets + 1]) >= 0).all()
    assert grid[buckets] == count


def test_every_lane_ahead_begins_where_the_one_before_ends() -> None:
    libsumo.start(["sumo", "-c", str(find("junction").config_file), "--no-step-log"])
    try:
        lanes = Lanes(libsumo, find("junction").config_file)
        vehicles = SumoVehicles(libsumo, lambda function, *args: function(*args), lanes)
        inside = 0
        for _ in range(300):
            libsumo.simulationStep()
            for name in libsumo.vehicle.getIDList():
                lane = libsumo.vehicle.getLaneID(name)
                inside += lane.startswith(":")
                for ahead in (
                    vehicles.lanes_ahead(name, lane, 60.0),
                    vehicles._by_its_plan(name, lane, 60.0),
                ):
                    assert ahead[0] == lane
                    for before, after in itertools.pairwise(ahead):
                        apart = math.dist(lanes.shape(before)[-1], lanes.shape(after)[0])
                        assert apart < 0.05, (name, ahead)
        assert inside  # cars on the junction itself have been among them
    finally:
        libsumo.close()
