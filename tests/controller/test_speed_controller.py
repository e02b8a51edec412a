"""Who drives, why, and what each controller remembers when the other one did."""

from __future__ import annotations

import math

import numpy as np
import pytest

from controller import (
    LongitudinalModel,
    Mpc,
    MpcParameters,
    Observation,
    Pid,
    PidParameters,
    SpeedController,
)

MODEL = LongitudinalModel()
NOBODY = np.full(15, np.inf)


def see(speed, gap=math.inf, ahead=None, position=0.0):
    """The observation of one pedestrian who stays, or of whoever is ``ahead``."""
    return Observation(
        position, speed, gap, np.full(15, position + gap) if ahead is None else ahead
    )


def test_the_mpc_drives_where_it_has_a_plan():
    mpc = Mpc(MODEL)
    decision = SpeedController(mpc, Pid()).control(see(4.0, 12.0))
    solution = Mpc(MODEL).solve(0.0, 4.0, 0.0, np.full(15, 12.0))
    assert decision.acting == "mpc"
    assert decision.reason == "optimal"
    assert decision.status == "solved"
    assert decision.force == solution.force == decision.plan[0]
    assert decision.plan.shape == (15,)
    assert decision.iterations >= 1
    assert decision.reference_speed == 4.0


def test_the_pid_takes_over_where_there_is_none():
    decision = SpeedController(Mpc(MODEL), Pid()).control(see(4.0, 8.1))
    assert decision.acting == "pid"
    assert decision.reason == "infeasible"
    assert decision.status == "infeasible: too close"
    assert decision.force == Pid().control(4.0, 8.1)
    assert decision.plan is None
    assert decision.reference_speed == pytest.approx(0.04)  # 4 (8.1 - 8) / 10


def test_the_pid_alone_when_it_is_selected():
    controller, pid = SpeedController(None, Pid()), Pid()
    for speed, gap in [(4.0, math.inf), (3.9, 14.0), (2.0, 9.0)]:
        decision = controller.control(see(speed, gap))
        assert decision.force == pid.control(speed, gap)
        assert decision[1:] == ("pid", "selected", "", 0, pid.reference_speed(gap), None)


@pytest.mark.parametrize(
    ("parameters", "reason"),
    [
        (MpcParameters(position_tolerance=1e-15), "solver: not verified"),
    ],
)
def test_a_solution_that_is_not_good_enough_is_not_driven(parameters, reason):
    """10.2 m at 4 m/s has a plan, found by the defaults, but it touches c6."""
    observation = see(4.0, 10.2)
    assert SpeedController(Mpc(MODEL), Pid()).control(observation).reason == "optimal"
    decision = SpeedController(Mpc(MODEL, parameters), Pid()).control(observation)
    assert decision.acting == "pid"
    assert decision.reason == reason
    assert decision.force == Pid().control(4.0, 10.2)


def test_the_pid_starts_from_the_last_error_and_no_integral():
    parameters = PidParameters(K_p=300.0, K_i=1000.0, K_d=100.0)
    controller = SpeedController(Mpc(MODEL), Pid(parameters))
    controller.control(see(4.0, 8.1))  # the PID integrates
    controller.control(see(3.9, math.inf))  # the MPC drives: e = 3.9 - 4
    decision = controller.control(see(3.8, 8.1))  # e = 3.8 - 0.04
    e, before = 3.8 - 0.04, -0.1
    u_i, u_d = 1000.0 * e * 0.05, 100.0 * (e - before) / 0.05
    assert decision.acting == "pid"
    assert decision.force == pytest.approx(max(-8000.0, -(300.0 * e + u_i + u_d)))


def test_plans_continue_from_whatever_force_came_before():
    """c2 and c3 tie u(k) to u(k-1), the PID's too, even where the PID jumped."""
    controller = SpeedController(Mpc(MODEL), Pid())
    braking = controller.control(see(4.0, 8.1)).force
    assert braking < -5000.0
    released = controller.control(see(3.5))
    assert released.acting == "mpc"
    assert released.force == pytest.approx(braking + 1000.0, abs=0.01)
    again = controller.control(see(3.3))
    assert again.force == pytest.approx(released.force + 1000.0, abs=0.01)


def test_at_a_standstill_the_plan_starts_from_no_force():
    """Tied to the PID's braking, c2 and c5 contradict each other and the car would never start."""
    controller = SpeedController(Mpc(MODEL), Pid())
    assert controller.control(see(4.0, 7.0)).force < -7000.0
    decision = controller.control(see(0.0))
    assert decision.acting == "mpc"
    assert decision.force == pytest.approx(1000.0, abs=0.01)


def test_reset_forgets_all():
    sights = [see(4.0), see(4.0, 11.0), see(3.5, 8.1), see(3.0, 9.5), see(0.0, 8.05), see(0.0)]
    controller = SpeedController(Mpc(MODEL), Pid())

    def answers():
        return [
            (d.force, d.acting, d.reason, d.status, d.iterations)
            for d in (controller.control(sight) for sight in sights)
        ]

    first = answers()
    assert {acting for _, acting, *_ in first} == {"mpc", "pid"}
    controller.reset()
    assert answers() == first


def test_a_crossing_is_driven_to_its_end():
    """People step in at random; the car lets them pass, drives on, and never goes backwards."""
    generator = np.random.default_rng(4)
    controller = SpeedController(Mpc(MODEL, MpcParameters()), Pid())
    crossings = [
        (generator.uniform(20.0, 35.0), start, start + 35)
        for start in generator.integers(0, 250, size=12)
    ]

    def closest(k, position):
        inside = [x for x, since, until in crossings if since <= k < until and x > position]
        return min(inside, default=math.inf)

    position, speed, acting = 0.0, 4.0, []
    for k in range(800):
        ahead = np.array([closest(k + i, position) for i in range(1, 16)])
        decision = controller.control(see(speed, closest(k, position) - position, ahead, position))
        acting.append(decision.acting)
        assert abs(decision.force) <= 8000.0 + 1e-3
        position += MODEL.time_step * speed
        speed = max(0.0, MODEL.decay * speed + MODEL.speed_per_force * decision.force)
        assert speed < 4.5
    assert position > 40.0
    assert 0 < acting.count("pid") < 0.5 * len(acting)


def test_a_speed_limit_becomes_the_reference_of_whoever_drives():
    mpc = Mpc(MODEL, MpcParameters())
    limited = SpeedController(mpc, Pid()).control(see(3.0).replaced(speed_limit=3.2))
    aimed = Mpc(MODEL, MpcParameters(reference_speed=3.2)).solve(3.0, 3.0, 0.0, NOBODY)
    assert limited.force == pytest.approx(aimed.force, abs=1e-3)
    assert limited.reference_speed == 3.2
    pid = SpeedController(None, Pid()).control(see(3.0).replaced(speed_limit=3.2))
    assert pid.reference_speed == 3.2
    assert pid.force == pytest.approx(
        Pid(PidParameters(reference_speed=3.2)).control(3.0, math.inf)
    )


def test_a_passing_speed_limit_leaves_no_trace_in_the_plan():
    mpc, fresh = Mpc(MODEL), Mpc(MODEL)
    mpc.solve(0.0, 4.0, 0.0, NOBODY, reference_speed=1.0)
    again = mpc.solve(0.0, 3.0, 0.0, NOBODY)
    assert again.force == pytest.approx(fresh.solve(0.0, 3.0, 0.0, NOBODY).force, abs=1e-3)
