"""Manoeuvres: what they do, what they cost, and that a plan stays admissible as time goes on."""

from __future__ import annotations

import math
from copy import deepcopy

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from controller import ControllerError, Manoeuvre, ManoeuvreParameters, PlannerParameters
from controller._jit import kernel
from controller.planning.cost_to_go import time_to_go
from controller.planning.costs import corridor, cost, stopping_need
from controller.planning.motions import aim, approach, shift
from controller.planning.parameters import Weights

time_to_go = kernel(time_to_go)
corridor = kernel(corridor)
stopping_need = kernel(stopping_need)
aim = kernel(aim)
approach = kernel(approach)
shift = kernel(shift)

DT = 0.05
FREE = np.inf
NOBODY_LATER = np.empty((0, 4))


def weights(**changes):
    return Weights.of(PlannerParameters(), ManoeuvreParameters(**changes))


def aimed(speed, before, wanted, slowest, fastest, *, jerk=8.0, horizon=60):
    m = Manoeuvre.empty(horizon)
    motion = (m.distance[None], m.speed[None], m.acceleration[None])
    aim(speed, before, np.array([[wanted, slowest]]), fastest, jerk, DT, motion)
    return m


def costs(
    m, w, *, gap=FREE, conflicts=0.0, calm=FREE, allowed=FREE, crossers=NOBODY_LATER, wanted=4.0
):
    N = len(m.speed) - 1
    *full, allowed = (np.full(N, x, dtype=float) for x in (gap, conflicts, calm, allowed))
    motion = (m.distance, m.speed, m.acceleration)
    return cost(motion, (*full, crossers), allowed, wanted, DT, w)


def steady(speed, horizon):
    m = Manoeuvre.empty(horizon)
    m.speed[:] = speed
    m.distance[:] = DT * speed * np.arange(horizon + 1)
    return m


# --- what they do -------------------------------------------------------------------------------


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


# --- what they cost -----------------------------------------------------------------------------


def test_what_a_stop_needs():
    w = weights(minimum_distance=1.0, headway=0.1)
    assert stopping_need(0.0, w) == 1.0
    assert stopping_need(4.0, w) == pytest.approx(1.4)


def test_a_free_way_costs_the_missing_speed_and_the_acceleration():
    w = weights(time_weight=1.0, acceleration_weight=0.05, later_weight=0.0, final_weight=0.0)
    assert costs(steady(4.0, 20), w) == (0.0, 0.0, 0.0)
    assert costs(steady(3.0, 20), w)[0] == pytest.approx(20 * DT * 0.25)
    assert costs(steady(3.0, 20), w, wanted=3.0)[0] == 0.0
    m = steady(4.0, 20)
    m.acceleration[0] = 2.0
    assert costs(m, w)[0] == pytest.approx(DT * 0.05 * 4.0)


def test_speed_at_the_end_counts_as_far_as_the_way_goes_on():
    """4 m/s with 0.75 m left, of b = 6 m/s^2: 3 m/s can be braked from; behind who drives, more."""
    only = {"time_weight": 0.0, "acceleration_weight": 0.0, "final_weight": 1.0}
    w = weights(**only, later_weight=2.0, deceleration=6.0)
    m = steady(4.0, 20)
    before_a_line = np.full(20, m.distance[-1] + 0.75)
    regained = 2.0 * time_to_go(NOBODY_LATER, 3.0, 4.0)
    assert costs(m, w, allowed=before_a_line)[0] == pytest.approx(0.25 + regained)
    behind_a_car = before_a_line[-1] + 4.0 * DT * np.arange(-19, 1)
    assert costs(m, w, allowed=behind_a_car)[0] == pytest.approx(0.0)
    assert costs(m, w)[0] == pytest.approx(0.0)


# --- what lies beyond the horizon ---------------------------------------------------------------


def crosser(ahead, enters, leaves, along=0.0):
    return np.array([[ahead, along, enters, leaves]])


def test_who_has_been_passed_or_is_late_costs_no_time():
    assert time_to_go(NOBODY_LATER, 4.0, 4.0) == 0.0
    assert time_to_go(crosser(-1.0, 0.0, 3.0), 4.0, 4.0) == 0.0  # behind the front
    assert time_to_go(crosser(4.0, 1.5, 3.0), 4.0, 4.0) == 0.0  # the ego is there after 1 s
    assert time_to_go(crosser(4.0, 0.0, 0.0), 4.0, 4.0) == 0.0  # never comes


def test_speed_is_regained_with_what_driving_off_allows():
    """From 2 to 4 m/s with 2.5 m/s^2: 0.8 s at 3 m/s in the mean, of which a quarter is lost."""
    assert time_to_go(NOBODY_LATER, 2.0, 4.0) == pytest.approx(0.2, abs=0.06)


def test_the_base_policy_arrives_when_crossing_people_have_left():
    """8 m ahead, gone after 4 s: 2.0 m/s less 1 m of distance keep it from standing there."""
    lost = time_to_go(crosser(8.0, 0.0, 4.0), 4.0, 4.0)
    # It is a metre short of 8 m after 4 s instead of 1.75 s, then regains its speed.
    assert lost == pytest.approx(4.0 - 7.0 / 4.0 + 0.3, abs=0.35)


def test_who_stays_costs_the_whole_of_what_is_left():
    standing = time_to_go(crosser(1.0, 0.0, np.inf), 0.0, 4.0)
    assert standing == pytest.approx(6.0)
    assert 0.0 < time_to_go(crosser(12.0, 0.0, np.inf), 4.0, 4.0) < standing


def test_who_walks_ahead_along_the_way_is_followed():
    followed = time_to_go(crosser(1.0, 0.0, np.inf, along=2.0), 2.0, 4.0)
    assert followed == pytest.approx(3.0, abs=0.3)  # half of the speed, for six seconds


@given(
    crossers=st.lists(
        st.tuples(
            st.floats(-5.0, 40.0), st.floats(-2.0, 2.0), st.floats(0.0, 8.0), st.floats(0.0, 12.0)
        ),
        max_size=5,
    ),
    speed=st.floats(0.0, 14.0),
    wanted=st.floats(1.0, 14.0),
)
@settings(max_examples=200)
def test_what_is_lost_later_is_a_finite_time_and_none_is_won(crossers, speed, wanted):
    people = np.array(crossers, dtype=float).reshape(-1, 4)
    lost = time_to_go(people, speed, wanted)
    alone = time_to_go(NOBODY_LATER, speed, wanted)
    assert 0.0 <= alone <= lost + 1e-9
    assert lost <= 6.0 + 1e-9


def test_the_cost_of_others_by_hand():
    m, n = steady(2.0, 20), 20 * DT
    own = costs(m, weights())[0]
    w = weights(
        nearness_weight=0.3,
        closeness_weight=20.0,
        conflict_weight=0.6,
        conflict_growth=0.25,
        threat_weight=1.0,
    )
    half = math.sqrt(0.5)  # of v_r
    assert costs(m, w, conflicts=0.5)[1] == pytest.approx(n * 0.6 * 0.5 * half)
    assert costs(m, w, conflicts=3.0)[1] == pytest.approx(n * 0.6 * (1 + 2 * 0.25) * half)
    assert costs(m, w, calm=1.0)[1] == pytest.approx(n * 1.0 / 4.0)
    assert costs(m, w, gap=4.0)[1] == pytest.approx(n * 0.3 * 0.5 * 0.5)  # half d_safe, half v_r
    assert costs(m, w, gap=8.0)[1] == 0.0
    need = stopping_need(2.0, w)
    whole, others, missing = costs(m, w, gap=need - 0.5)
    nearness = 0.3 * (1.0 - (need - 0.5) / 8.0) * 0.5
    assert (whole - own, missing) == (pytest.approx(others), pytest.approx(0.5))
    assert others == pytest.approx(n * (nearness + 20.0 * 0.5 * 0.5))


def test_conflict_weight_is_cubic_above_the_shared_space_speed():
    w = weights(conflict_weight=0.6)._replace(reference_speed=8.0)
    slow, shared, fast = (costs(steady(v, 20), w, conflicts=1.0)[1] for v in (1.0, 4.0, 8.0))
    assert shared == pytest.approx(2.0 * slow)  # the square root
    assert fast == pytest.approx(math.sqrt(2.0) * 8.0 * shared)


def test_beyond_what_is_allowed_each_metre_counts():
    m = steady(4.0, 20)  # 0.2 m per step
    _, others, missing = costs(m, weights(closeness_weight=20.0), allowed=3.8)
    assert missing == pytest.approx(0.2)
    assert others == pytest.approx(DT * 20.0 * 0.2)


def test_who_stands_lacks_no_stopping_distance():
    assert costs(steady(0.0, 20), weights(), gap=0.2)[2] == 0.0


def test_the_corridor_ends_where_stopping_for_all_is_possible():
    w, m, room = weights(), steady(2.0, 4), np.empty(4)
    gap = np.array([5.0, 0.9, np.inf, 5.0])
    allowed = np.array([np.inf, np.inf, 3.0, 0.1])
    corridor(m.distance, m.speed, gap, allowed, w, room)
    first = m.distance[1] + 5.0 - stopping_need(2.0, w)
    second = m.distance[2] + 0.9 - stopping_need(2.0, w)
    assert room == pytest.approx([first, second, 3.0, 0.1])
    corridor(m.distance, m.speed, np.zeros(4), np.full(4, np.inf), w, room)
    assert room == pytest.approx(m.distance[1:])  # never less than the manoeuvre itself


# --- parameters ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"accelerations": ()}, "accelerations"),
        ({"accelerations": (-1.0,), "slowest": (0.0,)}, "accelerations"),
        ({"slowest": (0.0,)}, "slowest"),
        ({"jerk": 0.0}, "jerk"),
        ({"deceleration": -1.0}, "deceleration"),
        ({"conflict_weight": np.nan}, "conflict_weight"),
    ],
)
def test_parameters_out_of_range_are_refused_by_name(changes, name):
    with pytest.raises(ControllerError, match=name):
        ManoeuvreParameters(**changes)


@pytest.mark.parametrize(
    "changes", [{"horizon": 3}, {"reference_speed": 0.0}, {"effort_weight": -1.0}]
)
def test_a_planner_that_cannot_be_is_refused_by_name(changes):
    with pytest.raises(ControllerError, match=next(iter(changes))):
        PlannerParameters(**changes)


@pytest.mark.parametrize("wanted", [2.5, 0.0])
def test_a_speed_above_the_wanted_one_is_lost_by_gentle_braking(wanted):
    m = aimed(13.9, 0.0, wanted, 0.0, 4.0)
    assert -3.0 - 1e-9 <= m.acceleration.min() < -2.9
    assert m.speed[-1] < 6.0


@given(speed=st.floats(0.0, 15.0), room=st.floats(0.5, 60.0), fastest=st.floats(1.0, 15.0))
def test_at_the_end_of_the_way_the_stop_is_comfortable(speed, room, fastest):
    assume(speed**2 / 3.0 + 0.7 * speed <= room)  # such a stop is possible
    m = Manoeuvre.empty(400)
    approach(speed, 0.0, room, (2.5, fastest, 8.0), DT, (m.distance, m.speed, m.acceleration))
    assert np.allclose(np.diff(m.distance), DT * m.speed[:-1])
    assert m.distance[-1] <= room + 0.05
    assert m.speed.max() <= max(speed, fastest) + 0.05
    assert m.acceleration.min() >= (-3.1 if speed > fastest else -2.5)
    if fastest * 20.0 > room + 20.0:
        assert m.distance[-1] > room - 0.2
