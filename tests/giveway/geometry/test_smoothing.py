"""Smooth parts of a path: gentle bends within their room, and stations that keep their place."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from giveway.geometry.path import EgoPath
from giveway.geometry.smoothing import Room, smooth

KINKED = [(0.0, 0.0), (80.0, 0.0), (200.0, 0.0)]
PART = [(140.0, 260.0)]


def kinked(degrees: float) -> EgoPath:
    """A path with a corner of so many degrees at 200 m, 400 m long."""
    turn = math.radians(degrees)
    return EgoPath.through([*KINKED, (200 + 200 * math.cos(turn), 200 * math.sin(turn))])


def room(drawn: EgoPath, largest: float) -> Room:
    """The same room [m] everywhere on a path."""
    return lambda stations: (drawn.points(stations), np.full(len(stations), largest))


def bending(path: EgoPath) -> np.ndarray:
    """The curvature [1/m] each metre."""
    ways = np.diff(path.points(np.arange(0.0, path.length, 1.0)), axis=0)
    return np.abs(np.diff(np.unwrap(np.arctan2(ways[:, 1], ways[:, 0]))))


@pytest.mark.parametrize(("degrees", "largest"), [(3, 0.5), (10, 0.5), (15, 0.3), (90, 0.5)])
def test_a_corner_becomes_a_bend_within_its_room(degrees: float, largest: float) -> None:
    drawn = kinked(degrees)
    path = smooth(drawn, PART, room(drawn, largest)).path
    _, aside = drawn.project(path.vertices)
    assert np.abs(aside).max() < 1.02 * largest
    # A bend whose curvature rises and falls evenly has theta^2 / (6 e) at its apex, e wide
    least = math.radians(degrees) ** 2 / (12.0 * largest)
    assert bending(path).max() < max(0.003, 1.3 * least)


def test_both_sides_of_the_polyline_are_used_where_it_helps() -> None:
    drawn = kinked(15.0)
    _, aside = drawn.project(smooth(drawn, PART, room(drawn, 0.4)).path.vertices)
    assert aside.min() == pytest.approx(-0.4, abs=0.01)
    assert aside.max() == pytest.approx(0.4, abs=0.01)


@given(st.floats(2.0, 60.0), st.integers(0, 1000))
def test_no_other_line_near_it_bends_less(degrees: float, seed: int) -> None:
    drawn = kinked(degrees)
    stations = np.linspace(*PART[0], 121)
    points = smooth(drawn, PART, room(drawn, 0.5)).path.vertices[2:-1]
    assert len(points) == 121

    def cost(line: np.ndarray) -> float:
        off = line - drawn.points(stations)
        return float(np.sum(np.diff(line, 2, axis=0) ** 2) + np.sum(off**2) / 20.0**4)

    bump = np.zeros_like(points)
    random = np.random.default_rng(seed)
    middle, wide = random.uniform(20, 100), random.uniform(3, 10)
    bell = np.exp(-(((np.arange(117) + 2 - middle) / wide) ** 2))
    bump[2:-2] = bell[:, None] * random.normal(size=2) * 0.01
    off = points + bump - drawn.points(stations)
    bump *= (np.hypot(*off.T) <= 0.49).min()  # a line beyond the room is no rival
    assert cost(points) <= cost(points + bump) + 1e-6


def test_the_line_stays_within_circles_beside_the_polyline() -> None:
    drawn = kinked(30.0)
    outwards = np.array([0.0, -0.2])
    found = smooth(drawn, PART, lambda at: (drawn.points(at) + outwards, np.full(len(at), 0.3)))
    x, y = found.path.vertices[2:-4].T
    before = (x > 145.0) & (x < 195.0)
    assert y[before].min() == pytest.approx(-0.5, abs=0.01)
    assert y[before & (x < 190.0)].max() < 0.11
    assert found.path.vertices[2] == pytest.approx((140.0, 0.0))


def test_all_outside_the_parts_stays_as_it_is() -> None:
    drawn = kinked(10.0)
    found = smooth(drawn, PART, room(drawn, 0.5))
    np.testing.assert_array_equal(found.path.vertices[:2], drawn.vertices[:2])
    np.testing.assert_array_equal(found.path.vertices[-1], drawn.vertices[-1])
    assert found.path.pose(100.0) == drawn.pose(100.0)
    ahead, behind = found.path.pose(found.path.length - 50.0), drawn.pose(drawn.length - 50.0)
    assert ahead == pytest.approx(behind, abs=1e-9)
    assert smooth(drawn, [(10.0, 12.0)], room(drawn, 0.5)).path.pose(250.0) == drawn.pose(250.0)


@given(st.floats(-60.0, 60.0), st.floats(-20.0, 430.0))
def test_a_place_keeps_its_station_beside_the_path(degrees: float, station: float) -> None:
    drawn = kinked(degrees)
    parts = [(20.0, 70.0), *PART]
    found = smooth(drawn, parts, room(drawn, 0.5))
    there = found.station(station)
    x, y, _ = drawn.pose(station)
    near, aside = found.path.locate(x, y, near=there)
    assert near == pytest.approx(there, abs=0.12)  # the polyline's corner is no point of its own
    assert abs(aside) < 0.51
    assert found.station(station + 0.5) >= there


def test_a_part_may_reach_to_the_end_of_the_path() -> None:
    drawn = kinked(10.0)
    found = smooth(drawn, [(150.0, drawn.length)], room(drawn, 0.5))
    assert found.path.vertices[-1] == pytest.approx(drawn.vertices[-1])
    assert found.station(drawn.length) == pytest.approx(found.path.length)
