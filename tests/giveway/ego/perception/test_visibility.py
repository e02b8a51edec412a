"""Sight: which share of a body a sensor sees past walls, vehicles and people."""

from math import inf, pi

import numpy as np
import pytest

from giveway.ego.perception.visibility import Eye, chords_of, fill_shares, walls_of
from giveway.geometry.kernel import Array

RADIUS = 0.27
TALL = 10.0


def shares(eye: Eye, position: Array, walls: Array, height: float = 1.7) -> Array:
    seen = np.empty(len(position))
    tops = np.full(len(position), height)
    fill_shares(np.array([eye]), (position, tops, RADIUS), walls, inf, seen)
    return seen


def eye(x: float = 0.0, y: float = 0.0, z: float = 1.3, **more: float) -> Eye:
    return Eye(x, y, z, more.get("heading", 0.0), more.get("range", inf), more.get("half", pi))


def wall(x0: float, y0: float, x1: float, y1: float, height: float = TALL) -> Array:
    return np.array([[x0, y0, x1, y1, height]])


NONE = np.empty((0, 5))
AHEAD = np.array([[10.0, 0.0]])


def test_a_person_is_seen_in_full_without_walls() -> None:
    assert shares(eye(), AHEAD, NONE) == 1.0


def test_a_wall_across_the_line_of_sight_hides_a_person() -> None:
    assert shares(eye(), AHEAD, wall(5.0, -3.0, 5.0, 3.0)) == 0.0


def test_a_wall_behind_a_person_hides_nothing() -> None:
    assert shares(eye(), AHEAD, wall(11.0, -3.0, 11.0, 3.0)) == 1.0


def test_a_wall_that_ends_on_the_line_of_sight_hides_one_half() -> None:
    assert shares(eye(), AHEAD, wall(5.0, 0.0, 5.0, 3.0)) == pytest.approx(0.5)


def test_two_walls_that_overlap_hide_what_they_cover_together() -> None:
    # at u = 1/2, w = 0.27 m of the body's width are 0.135 m
    walls = np.vstack([wall(5.0, -0.135, 5.0, 0.0), wall(5.0, -0.0675, 5.0, 0.0675)])
    assert shares(eye(), AHEAD, walls) == pytest.approx(0.25)


@pytest.mark.parametrize(
    ("angle", "seen"), [(0.4, 1.0), (0.6, 0.0), (-0.4, 1.0), (2 * pi - 0.4, 1.0)]
)
def test_nobody_is_seen_outside_of_the_field_of_view(angle: float, seen: float) -> None:
    assert shares(eye(heading=angle, half=0.5), AHEAD, NONE) == seen


def test_nobody_is_seen_beyond_the_range() -> None:
    assert shares(eye(range=9.9), AHEAD, NONE) == 0.0
    assert shares(eye(range=10.0), AHEAD, NONE) == 1.0


@pytest.mark.parametrize(("height", "seen"), [(1.15, 0.0), (1.75, 1.0)])
def test_a_parked_car_hides_a_child_and_not_an_adult(height: float, seen: float) -> None:
    car = walls_of(
        NONE, np.array([[8.0, 0.0, pi / 2, 0.0, 2.25, 2.25, 1.8]]), np.array([1.45]), -1
    )[0]
    assert shares(eye(), AHEAD, car, height) == pytest.approx(seen)


def test_a_hedge_hides_people_from_a_low_sensor_and_not_from_a_truck() -> None:
    hedge = wall(9.0, -3.0, 9.0, 3.0, 1.8)
    assert shares(eye(z=1.2), AHEAD, hedge) == 0.0
    assert shares(eye(z=3.0), AHEAD, hedge, 1.75) == 1.0


def test_people_hide_each_other_and_not_themselves() -> None:
    people = np.array([[5.0, 0.0], [10.0, 0.0], [10.0, 3.0]])
    chords = chords_of(people, np.full(3, 1.75), eye(), RADIUS)
    assert shares(eye(), people, chords, 1.75).tolist() == [1.0, 0.0, 1.0]


def test_the_own_body_hides_nothing() -> None:
    bodies = np.array([[5.0, 0.0, 0.0, 0.0, 2.0, 2.0, 1.8], [7.0, 5.0, 0.3, 0.0, 2.0, 2.0, 1.8]])
    assert len(walls_of(NONE, bodies, np.full(2, 1.5), 0)[0]) == 4
    assert len(walls_of(NONE, bodies, np.full(2, 1.5), -1)[0]) == 8
