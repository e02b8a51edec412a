"""Costs of a manoeuvre: speed, acceleration, passing speeds, room for a stop."""

from __future__ import annotations

import math

import numpy as np
import pytest

from controller import Manoeuvre, ManoeuvreParameters, PlannerParameters
from controller._jit import kernel
from controller.planning.cost_to_go import time_to_go
from controller.planning.costs import corridor, cost, stopping_need
from controller.planning.motions import aim
from controller.planning.parameters import Weights

corridor = kernel(corridor)


stopping_need = kernel(stopping_need)


aim = kernel(aim)


DT = 0.05


FREE = np.inf


NOBODY_LATER = np.empty((0, 4))


def weights(**changes):
    return Weights.of(PlannerParameters(), ManoeuvreParameters(**changes))


def aimed(speed, before, wanted, slowest, fastest, *, jerk=8.0, horizon=60):
    m = Manoeuvre.empty(horizon)
    motion = (m.distance[None], m.speed[None], m.acceleration[None])
    aim(speed, before, np.array([[wanted, slowest]]), fastest, (jerk, jerk), DT, motion)
    return m


def costs(
    m,
    w,
    *,
    gap=FREE,
    threat_free=FREE,
    passing=FREE,
    allowed=FREE,
    later_crossings=NOBODY_LATER,
    wanted=4.0,
):
    N = len(m.speed) - 1
    *full, allowed = (np.full(N, x, dtype=float) for x in (gap, threat_free, passing, allowed))
    motion = (m.distance, m.speed, m.acceleration)
    return cost(motion, (*full, later_crossings), allowed, wanted, DT, w)


def steady(speed, horizon):
    m = Manoeuvre.empty(horizon)
    m.speed[:] = speed
    m.distance[:] = DT * speed * np.arange(horizon + 1)
    return m


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


def test_the_cost_of_others_by_hand():
    m, n = steady(2.0, 20), 20 * DT
    own = costs(m, weights())[0]
    w = weights(closeness_weight=20.0, threat_weight=1.0, precaution_weight=3.0)
    assert costs(m, w, threat_free=1.0)[1] == pytest.approx(n * 1.0 / 4.0)
    assert costs(m, w, passing=1.5)[1] == pytest.approx(n * 3.0 * 0.5 / 4.0)
    assert costs(m, w, passing=2.0)[1] == 0.0
    need = stopping_need(2.0, w)
    whole, others, missing = costs(m, w, gap=need - 0.5)
    assert (whole - own, missing) == (pytest.approx(others), pytest.approx(0.5))
    comfortable = math.sqrt(2.0 * 2.0 * max(0.0, need - 0.5 - w.minimum_distance))
    assert others == pytest.approx(n * (20.0 * 0.5 * 0.5 + 3.0 * (2.0 - comfortable) / 4.0))


def test_a_person_in_front_is_approached_as_far_as_a_comfortable_stop_allows():
    """From 2 m/s a stop with 2 m/s^2 takes 1 m."""
    w, m = weights(minimum_distance=1.0, precaution_weight=3.0), steady(2.0, 20)
    assert costs(m, w, gap=2.0)[1] == 0.0
    assert costs(m, w, gap=1.5)[1] == pytest.approx(20 * DT * 3.0 * (2.0 - math.sqrt(2.0)) / 4.0)


def test_beyond_what_is_allowed_each_metre_counts():
    m = steady(4.0, 20)  # 0.2 m per step
    _, others, missing = costs(m, weights(closeness_weight=20.0), allowed=3.8)
    assert missing == pytest.approx(0.2)
    assert others == pytest.approx(DT * 20.0 * 0.2)


def test_who_stands_lacks_no_stopping_distance():
    assert costs(steady(0.0, 20), weights(), gap=0.2)[2] == 0.0


def test_the_corridor_ends_where_stopping_for_all_is_possible():
    w, m, room = weights(), steady(2.0, 4), np.empty(4)
    gap = np.array([5.0, 1.5, np.inf, 5.0])
    allowed = np.array([np.inf, np.inf, 3.0, 0.1])
    corridor(m.distance, m.speed, gap, allowed, w, room)
    first = m.distance[1] + 5.0 - stopping_need(2.0, w)
    second = m.distance[2] + 1.5 - stopping_need(2.0, w)
    assert room == pytest.approx([first, second, 3.0, 0.1])
    corridor(m.distance, m.speed, np.zeros(4), np.full(4, np.inf), w, room)
    assert room == pytest.approx(m.distance[1:])  # never less than the manoeuvre itself


@pytest.mark.parametrize("wanted", [2.5, 0.0])
def test_a_speed_above_the_wanted_one_is_lost_by_gentle_braking(wanted):
    m = aimed(13.9, 0.0, wanted, 0.0, 4.0)
    assert -3.0 - 1e-9 <= m.acceleration.min() < -2.9
    assert m.speed[-1] < 6.0


time_to_go = kernel(time_to_go)


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
