"""The assessment of a manoeuvre: gaps to people and passing speeds beside them."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from support.manoeuvres import (
    ALARM,
    DT,
    FRONT,
    HALF_WIDTH,
    LENGTH,
    LOOKS,
    PATHS,
    RADIUS,
    STRAIGHT,
    WIDTH,
    N,
    assessed,
    manoeuvre,
    walkers,
)

from giveway.ego.foresight.assessment import PASSED


def clearances_at(path, people, m, i):
    """Clearance [m] of each person to the ego's body at step i + 1, and places in its frame."""
    x, y, heading = path.pose(FRONT + m.distance[i + 1], LENGTH)
    towards = np.array([np.cos(heading), np.sin(heading)])
    left = np.array([-towards[1], towards[0]])
    away = people[i] - np.array([x, y])
    corners = [(0, 1), (0, -1), (-1, -1), (-1, 1)]
    body = shapely.Polygon([(LENGTH * a, WIDTH / 2 * b) for a, b in corners])
    place = np.column_stack([away @ towards, away @ left])
    velocity = (people[i + 1] - people[i]) / DT
    clear = body.distance(shapely.points(place)) - RADIUS
    return clear, place, np.column_stack([velocity @ towards, velocity @ left])


@pytest.mark.parametrize("seed", range(15))
@pytest.mark.parametrize("name", PATHS)
def test_the_gap_is_to_the_closest_person_in_the_corridor(name, seed):
    path, g = PATHS[name], np.random.default_rng(seed)
    people, m = walkers(g, path), manoeuvre(g.uniform(0.0, 6.0), g.uniform(-3.0, 1.0))
    line = shapely.LineString(path.vertices)
    gaps, _, _ = assessed(path, people, m)
    for i in range(N):
        at = FRONT + m.distance[i + 1]
        points = shapely.points(people[i])
        station, aside = line.project(points), line.distance(points)
        if (np.abs(aside - HALF_WIDTH) < 2e-3).any() or (
            np.abs(station - at + PASSED) < 2e-2
        ).any():
            continue  # the edge
        inside = (aside < HALF_WIDTH) & (station > at - PASSED)
        expected = np.min(station[inside] - at, initial=np.inf)
        assert gaps[i] == pytest.approx(expected, abs=1e-9 if name == "straight" else 5e-2)


def test_to_a_creeping_ego_who_may_not_see_it_is_nearer():
    path, m = PATHS["straight"], manoeuvre(0.5, 0.0)
    middle = np.array(path.pose(FRONT + 4.0)[:2])
    there = np.repeat(np.array([middle + (0.3, 0.0), middle])[None], N, axis=0)
    some = ALARM._replace(unaware=np.array([True, False]))
    seen, usual, creeping = (
        assessed(path, there, m, alarm=alarm, unaware=nearer)[0]
        for alarm, nearer in ((ALARM, 0.5), (some, 0.0), (some, 0.5))
    )
    assert np.array_equal(seen, usual)
    np.testing.assert_allclose(usual - creeping, 0.2)


def test_who_is_predicted_at_each_step_is_looked_at_at_each_step():
    people, m = walkers(np.random.default_rng(1), STRAIGHT), manoeuvre(4.0)
    often, seldom = (assessed(STRAIGHT, people, m, every=every) for every in (1, 2))
    assert np.allclose(often[0], seldom[0])
    assert not np.array_equal(often[1][:-1:2], often[1][1::2])
    assert np.allclose(often[1][::2], seldom[1][::2])


def test_steps_that_are_left_over_belong_to_the_last_prediction():
    people, m = walkers(np.random.default_rng(2), STRAIGHT), manoeuvre(3.0)
    gaps, threat_free, passing = assessed(STRAIGHT, people[:18], m, every=3)
    for values in (threat_free, passing, gaps + m.distance[1:]):
        assert values[-2:] == pytest.approx(np.repeat(values[-3], 2))


@pytest.mark.parametrize("seed", range(15))
@pytest.mark.parametrize("name", PATHS)
def test_passing_speeds_are_those_of_the_nearest_clearances(name, seed):
    path, g = PATHS[name], np.random.default_rng(100 + seed)
    people, m = walkers(g, path), manoeuvre(g.uniform(1.0, 6.0), g.uniform(-3.0, 1.0))
    _, _, passing = assessed(path, people, m)
    for i in LOOKS:
        speed, least = m.speed[i + 1], np.inf
        if speed <= 0.2:
            continue
        for clear, (x, y), (w_x, w_y) in zip(*clearances_at(path, people, m, i), strict=True):
            d = max(0.0, clear - 0.05 * DT * (i + 1))
            if x < -LENGTH / 2 and np.hypot(w_x, w_y) > 0.3:
                pace = 1.5 if d < 0.5 else np.inf
            else:
                pace = min(0.6 + 2.8 * d, 2.4 + 1.3 * d)
                heads = -w_y * np.sign(y) > 0.3 or abs(y) < WIDTH / 2
                pace = max(pace, 30.0 / 3.6) if d >= 1.0 and not heads else pace
            least = min(least, pace)
        assert passing[i] == pytest.approx(least if least < speed else np.inf, rel=1e-6)
    assert np.array_equal(passing[1::2], passing[::2])  # held between two looks


def test_who_stands_is_in_nobodys_way():
    people = walkers(np.random.default_rng(0), STRAIGHT)
    _, threat_free, passing = assessed(STRAIGHT, people, manoeuvre(0.1))
    assert np.isinf(passing).all()
    assert np.isinf(threat_free).all()
