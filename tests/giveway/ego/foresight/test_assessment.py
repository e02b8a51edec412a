"""The assessment of a manoeuvre: gaps and conflicts with those predicted."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from support.manoeuvres import (
    CONFLICT_TIME,
    DT,
    FADING,
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

EDGE = 1e-6


def conflicts_at(path, people, m, i):
    """Persons at step i + 1 on a course that touches the ego's body, and those on the edge.

    Whoever touches it within the conflict time counts once, half a second later not at all.
    """
    x, y, heading = path.pose(FRONT + m.distance[i + 1], LENGTH)
    towards = np.array([np.cos(heading), np.sin(heading)])
    left = np.array([-towards[1], towards[0]])
    front = np.array([x, y])
    corners = [
        front - back * LENGTH * towards + side * WIDTH / 2 * left
        for back, side in ((0, 1), (0, -1), (1, -1), (1, 1))
    ]
    body = shapely.Polygon(corners)
    shapely.prepare(wider := body.buffer(RADIUS, quad_segs=4000))
    relative = (people[i + 1] - people[i]) / DT - m.speed[i + 1] * towards
    surely, perhaps = 0.0, 0
    for p, w in zip(people[i], relative, strict=True):
        course = shapely.LineString([p, p + w * (CONFLICT_TIME + FADING)])
        if wider.intersects(course):
            met = shapely.intersection(course, wider)
            begin = min(np.hypot(*(np.array(met.coords) - p).T)) / np.hypot(*w)
            surely += np.clip((CONFLICT_TIME + FADING - begin) / FADING, 0.0, 1.0)
        perhaps += abs(body.distance(course) - RADIUS) <= EDGE
    return surely, perhaps


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


def test_who_is_predicted_at_each_step_is_looked_at_at_each_step():
    people, m = walkers(np.random.default_rng(1), STRAIGHT), manoeuvre(4.0)
    often, seldom = (assessed(STRAIGHT, people, m, every=every) for every in (1, 2))
    assert np.allclose(often[0], seldom[0])
    assert not np.array_equal(often[1][:-1:2], often[1][1::2])
    assert np.allclose(often[1][::2], seldom[1][::2])


def test_steps_that_are_left_over_belong_to_the_last_prediction():
    people, m = walkers(np.random.default_rng(2), STRAIGHT), manoeuvre(3.0)
    gaps, conflicts, threat_free = assessed(STRAIGHT, people[:18], m, every=3)
    for values in (conflicts, threat_free, gaps + m.distance[1:]):
        assert values[-2:] == pytest.approx(np.repeat(values[-3], 2))


@pytest.mark.parametrize("seed", range(15))
@pytest.mark.parametrize("name", PATHS)
def test_conflicts_are_people_on_a_course_into_the_ego(name, seed):
    path, g = PATHS[name], np.random.default_rng(100 + seed)
    people, m = walkers(g, path), manoeuvre(g.uniform(1.0, 6.0), g.uniform(-3.0, 1.0))
    _, conflicts, _ = assessed(path, people, m)
    for i in LOOKS:
        if m.speed[i + 1] > 0.2:
            surely, perhaps = conflicts_at(path, people, m, i)
            assert surely - EDGE <= conflicts[i] <= surely + perhaps + EDGE
    assert np.array_equal(conflicts[1::2], conflicts[::2])  # held between two looks


def test_who_stands_is_in_nobodys_way():
    people = walkers(np.random.default_rng(0), STRAIGHT)
    _, conflicts, threat_free = assessed(STRAIGHT, people, manoeuvre(0.1))
    assert not conflicts.any()
    assert np.isinf(threat_free).all()
