"""Reciprocal collision avoidance: its promise, its linear programme, and its paper's circle."""

import numpy as np
import pytest

from pedestrian_model import SIM, Crowd, PlainModel, Vehicles
from pedestrian_model._jit import kernel
from pedestrian_model.other_models.orca import LINES, TAU, _closest, orca_velocity

_closest = kernel(_closest)
orca_velocity = kernel(orca_velocity)

RADIUS, DT = SIM.body_radius, 0.05
SCRATCH = (np.empty((LINES, 4)), np.empty((LINES, 4)), np.empty((LINES, 2)))
OPEN = (np.inf, 0.0, 0.0)
NO_CAR = np.empty((0, 7))


def answers(position, velocity, preferred, vehicles=NO_CAR):
    """(n, 2) [m/s] the velocities that everybody takes."""
    return np.array(
        [
            orca_velocity(
                i,
                (position, velocity),
                tuple(preferred[i]),
                (2.5, RADIUS),
                (vehicles, OPEN),
                (0.0, DT),
                SCRATCH,
            )
            for i in range(len(position))
        ]
    )


def closest_approach(r, w, horizon):
    """[m] of two who are r apart and approach with w within a time."""
    t = np.clip(-(r @ w) / max(w @ w, 1e-12), 0.0, horizon)
    return np.hypot(*(r + t * w))


def test_two_who_do_their_half_do_not_meet_within_tau():
    """The theorem of the paper, section 4: both velocities are permitted, nobody is touched."""
    random = np.random.default_rng(3)
    met = 0
    for _ in range(300):
        position = np.array([[0.0, 0.0], random.uniform(-4.0, 4.0, 2)])
        apart = np.hypot(*position[1])
        if apart < 2.0 * RADIUS + 0.05:
            continue
        velocity = random.uniform(-1.2, 1.2, (2, 2))
        towards = position[1] / apart
        preferred = random.uniform(-0.5, 0.5, (2, 2)) + [towards, -towards]
        r, straight = position[1] - position[0], preferred[1] - preferred[0]
        met += closest_approach(r, straight, TAU) < 2.0 * RADIUS
        taken = answers(position, velocity, preferred)
        assert closest_approach(r, taken[1] - taken[0], TAU) >= 2.0 * RADIUS - 1e-9
    assert met > 100  # who would have met without


def test_out_of_a_vehicles_way_people_get_alone():
    car = Vehicles.create([-8.0], [0.0], [0.0], [4.0]).array
    random = np.random.default_rng(4)
    for _ in range(50):
        position = np.array([[random.uniform(0.0, 2.0), random.uniform(-1.0, 1.0)]])
        velocity = random.uniform(-1.0, 1.0, (1, 2))
        (taken,) = answers(position, velocity, velocity, car)
        if np.hypot(*taken) > 2.5 - 1e-6:
            continue  # nothing is permitted: the least bad, as fast as they can
        for t in np.linspace(0.0, TAU, 60):
            x, y = position[0] + t * taken - [-8.0 + 4.0 * t, 0.0]
            off = np.hypot(max(abs(x) - 2.5, 0.0), max(abs(y) - 1.0, 0.0))
            assert off >= RADIUS - 1e-6


def test_the_linear_programme_finds_the_closest_velocity():
    random = np.random.default_rng(5)
    grid = np.stack(np.meshgrid(*[np.linspace(-2.0, 2.0, 201)] * 2), -1).reshape(-1, 2)
    solved = 0
    for _ in range(100):
        n = 4
        angle = random.uniform(0.0, 2.0 * np.pi, n)
        lines = np.zeros((LINES, 4))
        lines[:n, :2] = random.normal(0.0, 0.8, (n, 2))
        lines[:n, 2], lines[:n, 3] = np.cos(angle), np.sin(angle)
        wanted = random.uniform(-1.0, 1.0, 2)
        done, *found = _closest(lines, n, 2.0, *wanted, False)
        normal = np.column_stack([-lines[:n, 3], lines[:n, 2]])
        permitted = ((grid[:, None] - lines[None, :n, :2]) * normal).sum(-1).min(axis=1) >= 0.0
        permitted &= np.hypot(*grid.T) <= 2.0
        if done < n:
            assert not permitted.any()
            continue
        solved += 1
        assert ((found - lines[:n, :2]) * normal).sum(-1).min() >= -1e-9
        if permitted.any():
            best = np.hypot(*(grid[permitted] - wanted).T).min()
            assert np.hypot(*(np.array(found) - wanted)) <= best + 1e-9
    assert solved > 30


@pytest.mark.parametrize(("n", "across"), [(8, 12.0), (24, 16.0)])
def test_a_circle_of_people_who_change_places_as_in_the_paper(n, across):
    random = np.random.default_rng(1)
    angle = 2.0 * np.pi * np.arange(n) / n
    start = 0.5 * across * np.column_stack([np.cos(angle), np.sin(angle)])
    pace = random.uniform(1.0, 1.6, n)  # all alike would block each other, in the paper too
    crowd = Crowd.create(start, np.zeros((n, 2)), pace, [-place[None] for place in start])
    model, closest = PlainModel("orca", SIM, DT), np.inf
    for _ in range(round(25.0 / DT)):
        model.advance(crowd, Vehicles.empty())
        apart = crowd.position[:, None] - crowd.position[None]
        distance = np.hypot(apart[..., 0], apart[..., 1]) + 9.0 * np.eye(n)
        closest = min(closest, distance.min())
    assert np.hypot(*(crowd.position + start).T).max() < 0.5
    assert closest > 2.0 * RADIUS - 0.06  # a body gives way; 5 m/s^2 is the most that they have
