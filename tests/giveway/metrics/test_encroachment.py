"""Post-encroachment time: by hand on straight paths, by brute force on any path."""

from __future__ import annotations

from math import inf, nan, pi

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from giveway.geometry.bodies import VehicleShape
from giveway.metrics import encroachment

CAR = VehicleShape(length=5.0, width=2.0)
R = 0.27
DT = 0.05
TIME = DT * np.arange(401)  # 20 s


def rounded_off(walking_speed: float, driving_speed: float) -> float:
    """By how much rounded corners shorten the time between leaving the strip and being reached.

    A time tau before the circle's centre is R outside the ego's side, it is sqrt(2 R w tau) deep
    in the rounded corner (w: the walking speed, to first order), so the ego comes that much
    earlier; the separation sqrt(2 R w tau) / v - tau less is most at R w / (2 v^2).
    """
    return R * walking_speed / (2.0 * driving_speed**2)


def test_the_pedestrian_first(driving, crowd, walking):
    # The ego at 4 m/s reaches x = 20 at t = 5 s. Walking +y at 1.3 m/s, the circle leaves the
    # strip's left edge (y = 1) at t = 3.02 s, between two records.
    crossing = crowd(walking(TIME, (20.0, 1.0 + R - 3.02 * 1.3), (0.0, 1.3)))
    pet = encroachment(driving(TIME, 4.0), crossing, CAR, R).time
    assert pet == pytest.approx([1.98 - rounded_off(1.3, 4.0)], abs=5e-4)


def test_the_ego_first(driving, crowd, walking):
    # The rear bumper leaves x = 20 at (20 + 5) / 4 = 6.25 s; the walker enters at 8.03 s.
    crossing = crowd(walking(TIME, (20.0, -1.0 - R - 8.03 * 1.3), (0.0, 1.3)))
    pet = encroachment(driving(TIME, 4.0), crossing, CAR, R).time
    assert pet == pytest.approx([1.78 - rounded_off(1.3, 4.0)], abs=5e-4)


def test_standing_in_the_way_until_taken_away(driving, crowd):
    # Gone after t = 2 s (its last record, step 40); the ego touches the place at (20 - R) / 4.
    standing = crowd((0, [(20.0, 0.0, 0.0, 0.0)] * 41))
    pet = encroachment(driving(TIME, 4.0), standing, CAR, R).time
    assert pet == pytest.approx([(20.0 - R) / 4.0 - 2.0], abs=1e-9)


def test_walking_ahead_on_the_egos_own_path(driving, crowd, walking):
    # 10 m ahead at the same speed: the ego's bumper touches the circle's place (10 - R) / 4 later.
    ahead = crowd(walking(TIME[:100], (10.0, 0.0), (4.0, 0.0)))
    pet = encroachment(driving(TIME, 4.0), ahead, CAR, R).time
    assert pet == pytest.approx([(10.0 - R) / 4.0], abs=1e-9)


def test_a_collision_is_zero(driving, crowd, walking):
    crossing = crowd(walking(TIME, (20.0, -1.3 * 5.5), (0.0, 1.3)))
    assert encroachment(driving(TIME, 4.0), crossing, CAR, R).time == [0.0]


@pytest.mark.parametrize(
    ("case", "place", "velocity", "instants"),
    [
        ("walks alongside", (5.0, 3.0), (1.3, 0.0), 401),
        ("stops short of the strip", (20.0, -1.0 - R - 1e-6), (0.0, 0.0), 401),
        ("crosses beyond the end of the ego's track", (90.0, -5.0), (0.0, 1.3), 401),
        ("crosses before the start of the ego's track", (-20.0, -5.0), (0.0, 1.3), 401),
        ("a single record beside the path", (20.0, 4.0), (0.0, 1.3), 1),
    ],
)
def test_paths_that_never_cross(driving, crowd, walking, case, place, velocity, instants):
    walk = crowd(walking(TIME[:instants], place, velocity))
    pet = encroachment(driving(TIME, 4.0), walk, CAR, R).time
    assert np.isnan(pet).all(), case


def test_an_ego_that_waits_before_the_crossing_never_reaches_it(ego, crowd, walking):
    front = np.column_stack((np.minimum(4.0 * TIME, 15.0), np.zeros(TIME.size)))
    crossing = crowd(walking(TIME, (20.0, -8.0), (0.0, 1.3)))
    assert np.isnan(encroachment(ego(TIME, front), crossing, CAR, R).time).all()


def test_every_pedestrian_gets_its_own(driving, crowd, walking):
    track = crowd(
        walking(TIME, (20.0, 1.0 + R - 3.02 * 1.3), (0.0, 1.3)),
        walking(TIME, (5.0, 9.0), (0.0, 0.0)),
        walking(TIME, (20.0, -1.0 - R - 8.03 * 1.3), (0.0, 1.3)),
    )
    pet = encroachment(driving(TIME, 4.0), track, CAR, R).time
    less = rounded_off(1.3, 4.0)
    assert pet == pytest.approx([1.98 - less, nan, 1.78 - less], abs=5e-4, nan_ok=True)


def test_a_curve_counts_the_place_where_it_is_crossed(ego, crowd, walking):
    # A quarter circle of radius 20 m about (0, 20) at 4 m/s, then straight on along +y. Walking
    # along y = 25 towards -x, a pedestrian leaves the strip's left edge (x = 19) at t = 9 s; the
    # bumper is at y = 25 at (10 pi + 5) / 4.
    arc = np.minimum(4.0 * TIME / 20.0, pi / 2)
    beyond = np.maximum(4.0 * TIME - 10.0 * pi, 0.0)
    front = np.column_stack((20.0 * np.sin(arc), 20.0 - 20.0 * np.cos(arc) + beyond))
    crossing = crowd(walking(TIME, (19.0 - R + 9.0, 25.0), (-1.0, 0.0)))
    pet = encroachment(ego(TIME, front, arc, 4.0), crossing, CAR, R).time
    assert pet == pytest.approx([(10 * pi + 5) / 4 - 9.0 - rounded_off(1.0, 4.0)], abs=5e-4)


@pytest.mark.parametrize(("place", "expected"), [((1.0, 0.0), nan), ((-1.0, 0.0), 0.0)])
def test_a_run_of_one_instant(driving, crowd, place, expected):
    track = crowd((0, [(*place, 0.0, 1.3)]))
    pet = encroachment(driving(TIME[:1], 4.0), track, CAR, R).time
    assert pet == pytest.approx([expected], nan_ok=True)


def brute_force(front, heading, walk, radius, finer=10):
    """The smallest time between any interpolated ego pose and any place of the pedestrian."""
    fine = np.linspace(0.0, len(front) - 1.0, (len(front) - 1) * finer + 1)
    coarse = np.arange(len(front))
    centre = front - 2.5 * np.column_stack((np.cos(heading), np.sin(heading)))
    at = np.column_stack([np.interp(fine, coarse, column) for column in centre.T])
    psi = np.interp(fine, coarse, heading)
    person = np.column_stack([np.interp(fine, coarse, column) for column in walk[:, :2].T])
    apart = person[:, None] - at[None, :]
    along = np.abs(apart[..., 0] * np.cos(psi) + apart[..., 1] * np.sin(psi))
    across = np.abs(apart[..., 1] * np.cos(psi) - apart[..., 0] * np.sin(psi))
    touching = np.hypot(np.maximum(along - 2.5, 0.0), np.maximum(across - 1.0, 0.0)) <= radius
    who, when = np.nonzero(touching)
    return DT * np.abs(fine[who] - fine[when]).min() if who.size else inf


@settings(max_examples=40)
@given(
    st.floats(-0.3, 0.3),
    st.floats(0.5, 4.0),
    st.tuples(st.floats(-2.0, 12.0), st.floats(-8.0, 8.0)),
    st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0)),
)
@example(0.2, 4.0, (9.0, -1.0), (0.0, 1.3))
@example(-0.3, 2.0, (4.0, 4.0), (0.0, -2.0))
def test_agrees_with_brute_force(ego, crowd, walking, yaw_rate, speed, place, velocity):
    time = DT * np.arange(81)
    heading = yaw_rate * time
    steps = DT * speed * np.column_stack((np.cos(heading), np.sin(heading)))[:-1]
    front = np.vstack(([0.0, 0.0], np.cumsum(steps, axis=0)))
    walk = walking(time, place, velocity)
    pet = encroachment(ego(time, front, heading, speed), crowd(walk), CAR, R).time[0]
    pet = inf if np.isnan(pet) else pet
    # Both move 2 cm at most between the brute force's samples, so a body 2 cm wider is sure to
    # be sampled wherever the true one touches; between two records a walker may cut 9 mm of a
    # corner of the strip, so a body 15 mm slimmer is sure to be noticed by its records.
    assert brute_force(front, heading, walk[1], R + 0.02) <= pet + DT / 10
    assert pet <= brute_force(front, heading, walk[1], R - 0.015) + DT / 10
