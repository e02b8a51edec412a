"""Manoeuvres: motions within the jerk, shifted plans, and the stop at the end of the path."""

from __future__ import annotations

from copy import deepcopy

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from controller import Manoeuvre
from controller._jit import kernel
from controller.planning.motions import aim, approach, shift

aim = kernel(aim)


approach = kernel(approach)


shift = kernel(shift)


DT = 0.05


def aimed(speed, before, wanted, slowest, fastest, *, jerk=8.0, horizon=60):
    m = Manoeuvre.empty(horizon)
    motion = (m.distance[None], m.speed[None], m.acceleration[None])
    aim(speed, before, np.array([[wanted, slowest]]), fastest, (jerk, jerk), DT, motion)
    return m


def steady(speed, horizon):
    m = Manoeuvre.empty(horizon)
    m.speed[:] = speed
    m.distance[:] = DT * speed * np.arange(horizon + 1)
    return m


@given(
    speed=st.floats(0.0, 20.0),
    before=st.floats(-8.0, 8.0),
    wanted=st.floats(-8.0, 5.0),
    slowest=st.floats(0.0, 4.0),
    fastest=st.floats(0.0, 20.0),
    jerk=st.floats(1.0, 20.0),
)
def test_a_manoeuvre_is_the_vehicles_motion_within_the_jerk(
    speed, before, wanted, slowest, fastest, jerk
):
    if speed > fastest:
        before = min(before, 0.0)  # no faster than that is driven, whatever the jerk
    m = aimed(speed, before, wanted, slowest, fastest, jerk=jerk)
    assert (m.distance[0], m.speed[0]) == (0.0, speed)
    assert (m.speed >= 0.0).all()
    assert m.speed[1:] == pytest.approx(m.speed[:-1] + DT * m.acceleration[:-1], abs=1e-12)
    assert m.distance[1:] == pytest.approx(m.distance[:-1] + DT * m.speed[:-1], abs=1e-9)
    assert m.speed.max() <= max(speed, fastest) + 1e-12
    a = np.concatenate([[before], m.acceleration[:-1]])
    free = (m.speed[1:] > 1e-9) & (np.abs(m.speed[1:] - fastest) > 1e-9)
    assert (np.abs(np.diff(a))[free] <= jerk * DT + 1e-9).all()  # but for the ends of the range


@given(speed=st.floats(0.0, 20.0), wanted=st.floats(0.5, 3.0), fastest=st.floats(0.0, 20.0))
def test_driving_on_ends_at_the_wanted_speed(speed, wanted, fastest):
    m = aimed(speed, 0.0, wanted, 0.0, fastest, horizon=2000)
    assert m.speed[-1] == pytest.approx(fastest, abs=1e-3)
    if speed <= fastest:
        assert (np.diff(m.speed) >= -1e-12).all()  # without overshoot


@given(speed=st.floats(0.0, 8.0), wanted=st.floats(-6.0, -0.5), slowest=st.floats(0.0, 3.0))
def test_braking_ends_at_the_slowest_speed(speed, wanted, slowest):
    assume(speed >= slowest)
    m = aimed(speed, 0.0, wanted, slowest, 8.0, horizon=2000)
    assert m.speed[-1] == pytest.approx(slowest, abs=1e-3)
    assert (np.diff(m.speed) <= 1e-12).all()
    assert m.speed.min() >= slowest - 0.3  # jerk-limited: the brake is not let go at once


def test_an_acceleration_is_reached_with_the_jerk_and_then_held():
    m = aimed(10.0, 0.0, -2.0, 0.0, 20.0, jerk=10.0)
    assert m.acceleration[:6] == pytest.approx([-0.5, -1.0, -1.5, -2.0, -2.0, -2.0])


def test_a_shifted_plan_is_what_was_planned():
    m = aimed(4.0, 0.0, -2.5, 1.4, 4.0)
    later = deepcopy(m)
    shift(m.speed[1], True, 6.0, DT, (later.distance, later.speed, later.acceleration))
    assert np.array_equal(later.speed[:-1], m.speed[1:])
    assert later.speed[-1] == m.speed[-1]  # held
    assert later.distance[:-1] == pytest.approx(m.distance[1:] - m.distance[1], abs=1e-12)
    assert later.acceleration[:-2] == pytest.approx(m.acceleration[1:-1], abs=1e-9)


def test_a_shifted_plan_begins_at_the_speed_that_is():
    m = steady(4.0, 60)
    shift(3.5, False, 6.0, DT, (m.distance, m.speed, m.acceleration))
    assert (m.speed[0], m.speed[1], m.speed[-1]) == (3.5, 4.0, pytest.approx(4.0 - 6.0 * DT))
    assert m.distance[1] == pytest.approx(3.5 * DT)


@given(speed=st.floats(0.0, 15.0), room=st.floats(0.5, 60.0), fastest=st.floats(1.0, 15.0))
def test_at_the_end_of_the_way_the_stop_is_comfortable(speed, room, fastest):
    assume(speed**2 / 3.0 + 0.7 * speed <= room)  # such a stop is possible
    m = Manoeuvre.empty(400)
    approach(
        speed, 0.0, room, (2.5, fastest, (8.0, 8.0)), DT, (m.distance, m.speed, m.acceleration)
    )
    assert np.allclose(np.diff(m.distance), DT * m.speed[:-1])
    assert m.distance[-1] <= room + 0.05
    assert m.speed.max() <= max(speed, fastest) + 0.05
    assert m.acceleration.min() >= (-3.1 if speed > fastest else -2.5)
    if fastest * 20.0 > room + 20.0:
        assert m.distance[-1] > room - 0.2
