"""Clearance, time to collision and DRAC of single records, by hand and by brute force.

The ego is 5 m x 2 m with its front bumper at the origin, heading +x, unless said otherwise:

             y ^
     +---------+----> x        pedestrians are circles of radius 0.27 m
     |   ego   |
     +---------+
    x=-5      x=0
"""

from __future__ import annotations

from math import cos, hypot, inf, pi, sin, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from giveway.geometry.bodies import VehicleShape
from giveway.geometry.contact import contact_interval, signed_distance
from giveway.geometry.kernel import kernel
from giveway.metrics import proximity

contact_interval = kernel(contact_interval)
signed_distance = kernel(signed_distance)

CAR = VehicleShape(length=5.0, width=2.0)
R = 0.27


def clearance(*drive):
    return proximity(*drive).clearance


def time_to_collision(*drive):
    return proximity(*drive).time_to_collision


@pytest.fixture
def judge(ego, crowd):
    """One measure of one record: the pedestrian's state, the ego's speed, heading and place."""

    def measure(measure, state, speed=0.0, heading=0.0, front=(0.0, 0.0)):
        track = ego(np.array([0.0]), np.array([front]), heading, speed)
        return measure(track, crowd((0, [state])), CAR, R)[0]

    return measure


@pytest.mark.parametrize(
    ("place", "expected"),
    [
        ((3.0, 0.0), 3.0 - R),  # ahead
        ((-8.0, 0.5), 3.0 - R),  # behind
        ((-2.0, 2.0), 1.0 - R),  # on the left
        ((-2.0, -2.0), 1.0 - R),  # on the right
        ((3.0, 5.0), 5.0 - R),  # off a corner: 3-4-5
        ((0.2, 0.0), 0.2 - R),  # the circle overlaps the front bumper
        ((-0.5, 0.0), -0.5 - R),  # the centre is half a metre behind the front bumper
        ((-2.5, 0.0), -1.0 - R),  # the ego's very centre: the sides are nearest
        ((R, 0.3), 0.0),  # just touching
    ],
)
def test_clearance_is_the_distance_of_skin_to_bodywork(judge, place, expected):
    assert judge(clearance, (*place, 0.0, 0.0)) == pytest.approx(expected, abs=1e-12)


def test_clearance_turns_with_the_heading(judge):
    # Heading +y with the front bumper at (10, 20): the car reaches from y = 15 to 20.
    assert judge(clearance, (10.0, 23.0, 0, 0), 0.0, pi / 2, (10.0, 20.0)) == pytest.approx(3 - R)
    assert judge(clearance, (13.0, 17.0, 0, 0), 0.0, pi / 2, (10.0, 20.0)) == pytest.approx(2 - R)


@pytest.mark.parametrize(
    ("case", "state", "speed", "expected"),
    [
        ("standing ahead", (10.27, 0.0, 0.0, 0.0), 4.0, 2.5),
        ("head-on", (10.27, 0.5, -1.0, 0.0), 4.0, 2.0),
        ("walking away, slower", (10.27, 0.0, 1.5, 0.0), 4.0, 4.0),
        ("walking away, faster", (10.27, 0.0, 5.0, 0.0), 4.0, inf),
        ("running into the rear", (-6.27, 0.0, 3.0, 0.0), 1.0, 0.5),
        ("walking into the side of a standing ego", (-2.0, 4.27, 0.0, -1.5), 0.0, 2.0),
        ("crossing, gets there as the ego does", (8.0, -3.27, 0.0, 1.27), 4.0, (8 - R) / 4),
        ("crossing, out of the way in time", (20.0, -1.0, 0.0, 1.27), 4.0, inf),
        ("crossing, behind the ego by then", (2.0, -8.0, 0.0, 1.0), 4.0, inf),
        ("beside, same way", (-2.0, 1.5, 4.0, 0.0), 4.0, inf),
        ("touching", (0.2, 0.0, 0.0, 0.0), 0.0, 0.0),
        ("overlapping and leaving", (0.1, 0.0, 2.0, 0.0), 1.0, 0.0),
        ("both stand apart", (3.0, 0.0, 0.0, 0.0), 0.0, inf),
        # Centre passes 0.1 m outside the corner: contact is with the rounded corner.
        ("grazing a corner", (4.0, 1.1, 0.0, 0.0), 2.0, (4.0 - sqrt(R**2 - 0.1**2)) / 2.0),
        ("missing a corner", (4.0, 1.0 + R + 1e-9, 0.0, 0.0), 2.0, inf),
        # Through the grown bounding box's corner square, but past the rounded corner.
        ("diagonally past a corner", (R, 1.0 + R / 2, -1.0, 1.0), 0.0, inf),
    ],
)
def test_time_to_collision(judge, case, state, speed, expected):
    assert judge(time_to_collision, state, speed) == pytest.approx(expected, rel=1e-12), case


def test_time_to_collision_on_a_turned_ego(judge):
    state = (10.0, 30.27, 0.0, -1.0)
    assert judge(time_to_collision, state, 4.0, pi / 2, (10.0, 20.0)) == pytest.approx(2.0)


def sampled_contact(x, y, w_x, w_y, end, count):
    """The first of many sampled instants at which the point is in the grown rectangle."""
    t = np.linspace(0.0, end, count)
    apart_x = np.maximum(np.abs(x + w_x * t) - 2.5, 0.0)
    apart_y = np.maximum(np.abs(y + w_y * t) - 1.0, 0.0)
    depth = np.hypot(apart_x, apart_y)
    return t, depth


coordinates = st.floats(-12.0, 12.0)
velocities = st.floats(-5.0, 5.0)


@settings(max_examples=300)
@given(coordinates, coordinates, velocities, velocities)
def test_contact_agrees_with_fine_sampling(x, y, w_x, w_y):
    first, last = contact_interval(x, y, w_x, w_y, 2.5, 1.0, R)
    t, distance = sampled_contact(x, y, w_x, w_y, 20.0, 8001)
    spacing = (t[1] - t[0]) * hypot(w_x, w_y)
    inside = t[distance < R - 1e-9]
    if inside.size:
        assert first <= inside[0] + 1e-9
        assert last >= inside[-1] - 1e-9
    if max(first, 0.0) <= min(last, 20.0):
        # Whoever is said to touch comes at least to within half a sample of it.
        assert distance.min() <= R + spacing
        at = max(first, 0.0)
        touch = np.hypot(max(abs(x + w_x * at) - 2.5, 0.0), max(abs(y + w_y * at) - 1.0, 0.0))
        assert touch <= R + 1e-9


@settings(max_examples=300)
@given(coordinates, coordinates)
def test_signed_distance_agrees_with_the_distance_to_the_edges(x, y):
    corners = np.array([(2.5, 1.0), (-2.5, 1.0), (-2.5, -1.0), (2.5, -1.0)])
    nearest = inf
    for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        along = end - start
        part = np.clip(np.dot((x, y) - start, along) / np.dot(along, along), 0.0, 1.0)
        nearest = min(nearest, float(np.hypot(*((x, y) - start - part * along))))
    sign = -1.0 if abs(x) < 2.5 and abs(y) < 1.0 else 1.0
    assert signed_distance(x, y, 2.5, 1.0) == pytest.approx(sign * nearest, abs=1e-12)


@settings(max_examples=100)
@given(
    st.tuples(coordinates, coordinates, velocities, velocities),
    st.floats(0.0, 10.0),
    st.floats(-pi, pi),
    st.tuples(st.floats(-100, 100), st.floats(-100, 100)),
)
def test_nothing_depends_on_the_frame(ego, crowd, state, speed, turn, shift):
    x, y, vx, vy = state
    c, s = cos(turn), sin(turn)
    moved = (c * x - s * y + shift[0], s * x + c * y + shift[1], c * vx - s * vy, s * vx + c * vy)
    at_home = ego(np.array([0.0]), np.zeros((1, 2)), 0.0, speed)
    away = ego(np.array([0.0]), np.array([shift]), turn, speed)
    here, there = crowd((0, [state])), crowd((0, [moved]))
    distance = clearance(at_home, here, CAR, R)[0]
    assert clearance(away, there, CAR, R)[0] == pytest.approx(distance, abs=1e-9)
    # Grazing contact is all or nothing: judged with a body a hair slimmer and a hair wider.
    bounds = [time_to_collision(at_home, here, CAR, R + hair)[0] for hair in (1e-6, -1e-6)]
    assert bounds[0] - 1e-6 <= time_to_collision(away, there, CAR, R)[0] <= bounds[1] + 1e-6


@pytest.mark.parametrize(
    ("case", "state", "speed", "expected"),
    [
        ("standing 8 m ahead: v^2 / 2d", (8.0 + R, 0.0, 0.0, 0.0), 4.0, 1.0),
        ("walking away: only the closing speed", (8.0 + R, 0.0, 2.0, 0.0), 4.0, 0.25),
        ("not on a collision course", (8.0, 5.0, 0.0, 0.0), 4.0, 0.0),
        ("walks into the side: braking is no remedy", (-2.0, 2.0, 0.0, -1.0), 0.0, 0.0),
        ("runs into the rear", (-7.0, 0.0, 3.0, 0.0), 1.0, 0.0),
        ("touched already", (0.1, 0.0, 0.0, 0.0), 4.0, 0.0),
    ],
)
def test_deceleration_to_avoid_crash(judge, case, state, speed, expected):
    assert judge(_deceleration, state, speed) == pytest.approx(expected), case


def _deceleration(*drive):
    return proximity(*drive).deceleration


@pytest.mark.parametrize(("step", "pedestrian", "name"), [(1, 0, "step"), (0, 1, "pedestrian")])
def test_tracks_of_different_runs_are_refused(ego, crowd, step, pedestrian, name):
    walks = [(step, [(3.0, 0.0, 0.0, 0.0)])]
    track = crowd(*walks)
    object.__setattr__(track, "pedestrian", track.pedestrian + pedestrian)
    with pytest.raises(ValueError, match=rf"{name} 1 is outside 0\.\.0"):
        clearance(ego(np.array([0.0])), track, CAR, R)


def test_an_empty_crowd_has_no_records(ego, crowd):
    assert clearance(ego(np.array([0.0])), crowd(), CAR, R).shape == (0,)
    assert time_to_collision(ego(np.array([0.0])), crowd(), CAR, R).shape == (0,)
