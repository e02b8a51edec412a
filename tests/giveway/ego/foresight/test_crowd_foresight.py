"""What the planner is told of the crowd, against plain geometry and the safety layer."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
import shapely
from support.front_poses import front_poses

from controller import (
    LongitudinalModel,
    Manoeuvre,
    SafetyLayer,
    SafetyParameters,
    WorstMotion,
)
from giveway.ego.foresight.assessment import PASSED, View, assess
from giveway.ego.foresight.crowd_foresight import CrowdForesight, EgoAssumptions, plan_predictor
from giveway.ego.foresight.threats import Alarm, is_threat, outline
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import kernel
from giveway.geometry.path import EgoPath
from pedestrian_model import OPEN_GROUND, SIM, Crowd

is_threat = kernel(is_threat)
outline = kernel(outline)

N, DT = 20, 0.05
EVERY = 2  # steps of a manoeuvre in one of the prediction
LOOKS = range(0, N - 1, EVERY)  # where conflicts are looked for
LENGTH, WIDTH, RADIUS = 5.0, 2.0, SIM.body_radius
HALF_WIDTH, CONFLICT_TIME, FADING = 1.25, 1.5, 0.5
FRONT = 20.0  # [m]
WORST = SafetyParameters().worst
ALARM = Alarm(RADIUS, 0.05, WORST.acceleration, WORST.speed, 8.0, heeded=True)
EDGE = 1e-6

angles = np.linspace(-np.pi / 2, np.pi / 2, 200)
STRAIGHT = EgoPath.through([(0.0, 0.0), (60.0, 0.0)])
BEND = EgoPath.through(np.column_stack([20.0 * np.cos(angles), 20.0 * np.sin(angles)]))
PATHS = {"straight": STRAIGHT, "bend": BEND}


def walkers(g, path, count=25):
    """(N, n, 2) people about the path ahead, each at a constant velocity."""
    middle = np.array(path.pose(FRONT + 3.0)[:2])
    start = middle + g.uniform(-7.0, 7.0, (count, 2))
    velocity = g.uniform(-1.6, 1.6, (count, 2))
    return start + DT * np.arange(1, N + 1)[:, None, None] * velocity


def manoeuvre(speed, acceleration=0.0):
    m = Manoeuvre.empty(N)
    m.acceleration[:] = acceleration
    m.speed[:] = np.maximum(speed + acceleration * DT * np.arange(N + 1), 0.0)
    m.distance[1:] = DT * np.cumsum(m.speed[:-1])
    return m


def assessed(path, people, m, *, alarm=ALARM, every=EVERY):
    out = np.empty(N), np.empty(N), np.empty(N)
    assess(
        (path.vertices, path.stations, path.headings),
        # they walk straight on
        (2.0 * people[0] - people[1], np.ascontiguousarray(people[every - 1 :: every])),
        FRONT,
        (m.distance, m.speed),
        (View(LENGTH, WIDTH, HALF_WIDTH, CONFLICT_TIME, DT, every), alarm),
        out,
    )
    return out


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
    gaps, conflicts, calm = assessed(STRAIGHT, people[:18], m, every=3)
    for values in (conflicts, calm, gaps + m.distance[1:]):
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
    _, conflicts, calm = assessed(STRAIGHT, people, manoeuvre(0.1))
    assert not conflicts.any()
    assert np.isinf(calm).all()


@pytest.mark.parametrize("seed", range(20))
def test_a_person_is_a_threat_only_above_the_threat_free_speed(seed):
    g = np.random.default_rng(seed)
    people, v = walkers(g, STRAIGHT, count=1), g.uniform(1.0, 6.0)
    m = manoeuvre(v)
    _, _, calm = assessed(STRAIGHT, people, m)

    def threatened(i, speed):
        return any(
            is_threat(
                (x - FRONT - m.distance[i + 1], y),
                tuple(w),
                outline(speed, DT, ALARM),
                WIDTH / 2,
                DT,
                ALARM,
            )
            for (x, y), w in zip(people[i], (people[i + 1] - people[i]) / DT, strict=True)
        )

    for i in LOOKS:
        if np.isinf(calm[i]):
            assert not threatened(i, v)
        else:
            assert threatened(i, v)
            assert threatened(i, min(v, calm[i] + v / 32.0 + 1e-9))  # five halvings
            assert calm[i] == 0.0 or not threatened(i, calm[i])


def test_without_a_safety_layer_every_speed_is_calm():
    people = walkers(np.random.default_rng(3), STRAIGHT)
    _, _, calm = assessed(STRAIGHT, people, manoeuvre(4.0), alarm=ALARM._replace(heeded=False))
    assert np.isinf(calm).all()


def test_threats_outline_when_the_safety_layer_would_act():
    # Not a bound: docs/planner.md says in which cases the outline errs, and in which direction.
    g, layer = np.random.default_rng(0), SafetyLayer(LongitudinalModel(), SafetyParameters())
    seen = np.zeros((2, 2))
    for _ in range(6000):
        v, x, y = g.uniform(0.3, 6.0), g.uniform(0.3, 8.0), g.uniform(-4.0, 4.0)
        pace, towards = g.uniform(0.0, 2.2), g.uniform(-np.pi, np.pi)
        w = pace * np.array([np.cos(towards), np.sin(towards)])
        layer.reset()
        way, here = np.array([[0.0, 0.0, 1.0, 0.0]]), np.array([[x, y]])
        acted = layer.filter(100.0 * v, v, (way, 0.1), here, w[None]).acted
        seen[
            int(acted),
            int(is_threat((x, y), tuple(w), outline(v, DT, ALARM), WIDTH / 2, DT, ALARM)),
        ] += 1
    assert seen[1].sum() > 300
    assert seen[1, 1] / seen[1].sum() > 0.995  # of the acts
    assert seen[0, 1] / seen[0].sum() < 0.06  # false alarms


def test_threats_show_when_the_layer_would_act_beside_a_sidewalk():
    alarm = ALARM._replace(setting_out=WORST.setting_out)
    g, layer = np.random.default_rng(1), SafetyLayer(LongitudinalModel(), SafetyParameters())
    seen = np.zeros((2, 2))
    for _ in range(6000):
        v, x, y = g.uniform(1.0, 14.0), g.uniform(0.3, 12.0), g.uniform(-4.0, -1.0)
        pace, towards = g.uniform(0.0, 2.2), g.uniform(-np.pi, np.pi)
        w = pace * np.array([np.cos(towards), np.sin(towards)])
        depth = g.uniform(0.05, 2.0)
        layer.reset()
        way, here = np.array([[0.0, 0.0, 1.0, 0.0]]), np.array([[x, y]])
        kerbs = np.array([[0.0, 1.0, depth]])
        acted = layer.filter(100.0 * v, v, (way, 0.1), here, w[None], kerbs=kerbs).acted
        behind = 0.0, 1.0, depth - 0.05
        threat = is_threat((x, y), tuple(w), outline(v, DT, alarm), WIDTH / 2, DT, alarm, behind)
        seen[int(acted), int(threat)] += 1
    assert seen[1].sum() > 300
    assert seen[1, 1] / seen[1].sum() > 0.995  # of the acts
    assert seen[0, 1] / seen[0].sum() < 0.06  # false alarms


@pytest.mark.parametrize("name", PATHS)
def test_a_person_for_whom_the_layer_would_act_is_a_threat(name):
    """Just below a speed at which the stop takes a step less, and on either side of a bend."""
    path, m = PATHS[name], manoeuvre(3.98)
    layer = SafetyLayer(LongitudinalModel(), SafetyParameters())
    front = FRONT + m.distance[1]
    acted = 0
    for ahead, aside in itertools.product(np.arange(0.7, 2.4, 0.1), (-1.6, -1.4, 1.4, 1.6)):
        x, y, heading = path.pose(front + ahead)
        there = np.array([[x - aside * np.sin(heading), y + aside * np.cos(heading)]])
        layer.reset()
        way = front_poses(path, front, layer.reach(3.98), LENGTH)
        if layer.filter(398.0, 3.98, way, there, np.zeros((1, 2))).acted:
            acted += 1
            _, _, calm = assessed(path, np.repeat(there[None], N, axis=0), m)
            assert calm[0] < 3.98, (ahead, aside)
    assert acted > 20


# --- the crowd under a manoeuvre ------------------------------------------------------------------


def foresight(**changes):
    shape = VehicleShape(LENGTH, WIDTH)
    ego = EgoAssumptions(shape, HALF_WIDTH, 0.05, 8.0, WORST, CONFLICT_TIME)
    predictor = plan_predictor(SIM, DT, N)
    return CrowdForesight(predictor, STRAIGHT, ego._replace(**changes), horizon=N, time_step=DT)


def look(ahead, *, speed=4.0, off=6.0):
    """Somebody beside the corridor who wants to cross before the ego."""
    crowd = Crowd.create([(FRONT + off, -2.0)], [(0.0, 1.3)], 1.3, [[(FRONT + off, 10.0)]])
    poses = np.zeros((N, 1, 7))
    poses[:, :, 4:] = LENGTH / 2, LENGTH / 2, WIDTH
    ahead.look(crowd, OPEN_GROUND, (poses, 0, FRONT))


def test_calm_speeds_are_those_of_what_the_layer_below_assumes():
    calm = []
    for worst in (WorstMotion(5.0, 2.5), WORST, WorstMotion(1.0, 2.5), None):
        ahead = foresight(worst=worst)
        look(ahead, off=3.5)
        calm.append(ahead.prospect(manoeuvre(4.0)).calm.min())
    assert calm[0] < calm[1] < calm[2] <= calm[3] == np.inf


def test_a_plan_is_predicted_in_steps_of_a_tenth_of_a_second():
    for time_step, horizon, every, count in ((0.05, 60, 2, 30), (0.02, 17, 5, 3), (0.1, 8, 1, 8)):
        made = plan_predictor(SIM, time_step, horizon)
        assert made.time_step == pytest.approx(every * time_step)
        assert made.horizon == count
        assert made.law[1:3] == (pytest.approx(every * time_step), 1)
    assert plan_predictor(SIM, 0.02, 4).horizon == 1


def test_people_too_quick_for_the_step_are_predicted_in_theirs():
    quick = replace(SIM, destination_gain=1000.0)
    made = plan_predictor(quick, DT, N)
    assert (made.time_step, made.horizon) == (0.1, N // 2)
    assert made.law[1:3] == (DT, 2)


def test_positions_are_known_at_each_step():
    ahead = foresight()
    look(ahead)
    ahead.prospect(manoeuvre(4.0))
    ahead.prefer()
    y = np.concatenate([[-2.0], ahead.best[:, 0, 1]])
    assert ahead.best.shape == (N, 1, 2)
    assert y[1::2] == pytest.approx((y[:-1:2] + y[2::2]) / 2.0)
    assert (np.diff(y) != 0.0).all()


def test_people_answer_to_the_manoeuvre():
    ahead = foresight()
    look(ahead)
    crossings = []
    for m in (manoeuvre(4.0), manoeuvre(4.0, -4.0)):
        ahead.prospect(m)
        ahead.prefer()
        crossings.append(ahead.best[-1, 0, 1])
    assert abs(crossings[1] - crossings[0]) > 0.01


def test_the_best_is_remembered_until_the_next_look():
    ahead = foresight()
    look(ahead)
    assert ahead.best is None
    ahead.prospect(manoeuvre(4.0))
    ahead.prefer()
    preferred = ahead.best.copy()
    ahead.prospect(manoeuvre(4.0, -4.0))
    assert np.array_equal(ahead.best, preferred)
    look(ahead)
    assert ahead.best is None
