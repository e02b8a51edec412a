"""Manoeuvres along a path among people who walk straight on, and how they are assessed."""

from __future__ import annotations

import numpy as np

from controller import (
    Manoeuvre,
    SafetyParameters,
)
from giveway.ego.foresight.assessment import View, assess
from giveway.ego.foresight.threats import Alarm
from giveway.geometry.path import EgoPath
from pedestrian_model import SIM

N, DT = 20, 0.05


LENGTH, WIDTH, RADIUS = 5.0, 2.0, SIM.body_radius


HALF_WIDTH = 1.25


FRONT = 20.0  # [m]


WORST = SafetyParameters().worst


STRAIGHT = EgoPath.through([(0.0, 0.0), (60.0, 0.0)])


def manoeuvre(speed, acceleration=0.0):
    m = Manoeuvre.empty(N)
    m.acceleration[:] = acceleration
    m.speed[:] = np.maximum(speed + acceleration * DT * np.arange(N + 1), 0.0)
    m.distance[1:] = DT * np.cumsum(m.speed[:-1])
    return m


EVERY = 2  # steps of a manoeuvre in one of the prediction


LOOKS = range(0, N - 1, EVERY)  # where threats are looked for


ALARM = Alarm(RADIUS, 0.05, WORST.acceleration, WORST.speed, 8.0, heeded=True)


angles = np.linspace(-np.pi / 2, np.pi / 2, 200)


BEND = EgoPath.through(np.column_stack([20.0 * np.cos(angles), 20.0 * np.sin(angles)]))


PATHS = {"straight": STRAIGHT, "bend": BEND}


def walkers(g, path, count=25):
    """(N, n, 2) people about the path ahead, each at a constant velocity."""
    middle = np.array(path.pose(FRONT + 3.0)[:2])
    start = middle + g.uniform(-7.0, 7.0, (count, 2))
    velocity = g.uniform(-1.6, 1.6, (count, 2))
    return start + DT * np.arange(1, N + 1)[:, None, None] * velocity


def assessed(path, people, m, *, alarm=ALARM, every=EVERY, unaware=0.0):
    out = np.empty(N), np.empty(N), np.empty(N)
    assess(
        (path.vertices, path.stations, path.headings),
        # they walk straight on
        (2.0 * people[0] - people[1], np.ascontiguousarray(people[every - 1 :: every])),
        FRONT,
        (m.distance, m.speed),
        (View(LENGTH, WIDTH, HALF_WIDTH, DT, every), alarm, unaware),
        out,
    )
    return out
