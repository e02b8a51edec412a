"""Threats: people for whom the safety layer would act."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from support.front_poses import front_poses
from support.manoeuvres import (
    ALARM,
    DT,
    FRONT,
    LENGTH,
    LOOKS,
    PATHS,
    STRAIGHT,
    WIDTH,
    WORST,
    N,
    assessed,
    manoeuvre,
    walkers,
)

from controller import (
    LongitudinalModel,
    SafetyLayer,
    SafetyParameters,
)
from giveway.ego.foresight.threats import is_threat, outline, passing_speed
from giveway.geometry.kernel import kernel

is_threat = kernel(is_threat)


outline = kernel(outline)


@pytest.mark.parametrize("seed", range(20))
def test_a_person_is_a_threat_only_above_the_threat_free_speed(seed):
    g = np.random.default_rng(seed)
    people, v = walkers(g, STRAIGHT, count=1), g.uniform(1.0, 6.0)
    m = manoeuvre(v)
    _, threat_free, _ = assessed(STRAIGHT, people, m)

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
        if np.isinf(threat_free[i]):
            assert not threatened(i, v)
        else:
            assert threatened(i, v)
            assert threatened(i, min(v, threat_free[i] + v / 32.0 + 1e-9))  # five halvings
            assert threat_free[i] == 0.0 or not threatened(i, threat_free[i])


def test_without_a_safety_layer_every_speed_is_calm():
    people = walkers(np.random.default_rng(3), STRAIGHT)
    _, threat_free, _ = assessed(
        STRAIGHT, people, manoeuvre(4.0), alarm=ALARM._replace(heeded=False)
    )
    assert np.isinf(threat_free).all()


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
            _, threat_free, _ = assessed(path, np.repeat(there[None], N, axis=0), m)
            assert threat_free[0] < 3.98, (ahead, aside)
    assert acted > 20


def test_people_on_a_sidewalk_slow_down_only_who_passes_them_closely():
    """From 1.5 m on nobody slows down for them, on streets with any limit."""
    assert passing_speed(1.2, False, False, True) == pytest.approx(30.0 / 3.6)
    assert passing_speed(1.6, False, False, True) == np.inf
    assert passing_speed(1.6, False, False, False) == pytest.approx(30.0 / 3.6)
    assert passing_speed(1.6, False, True, False) < 5.0
