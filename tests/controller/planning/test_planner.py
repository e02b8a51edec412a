"""The planner's force: that of the QP's optimum; with a soft corridor there always is one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from smoothing_cases import (
    FOLLOWING,
    FREE,
    MODEL,
    N,
    forces,
    room_of,
    rooms,
    speeds,
)

from controller import Evaluation, Planner, PlannerParameters
from controller._jit import kernel
from controller.planning import Road
from controller.planning.smoothing import SmoothingProblem
from controller.qp.active_set import solve_exactly

solve_exactly = kernel(solve_exactly)


class Fixed:
    """A crowd that moves with the ego: as far from it under each manoeuvre."""

    def __init__(self, room):
        self.room = room

    def evaluate(self, manoeuvre, *, creeps=False):
        gap = self.room + FOLLOWING.safe_distance - manoeuvre.distance[1:]
        return Evaluation(gap, FREE, FREE)

    def prefer(self):
        pass


@given(speed=speeds, force=forces, room=rooms, threat_free=st.floats(0.0, 25.0))
@example(speed=4.0, force=-3096.4822905369288, room=(0, 2, 0.0, 0.0), threat_free=0.0)
@settings(max_examples=60)
def test_the_corridor_always_leaves_a_plan(speed, force, room, threat_free):
    problem = SmoothingProblem(MODEL, FOLLOWING)
    problem.aim_at(np.full(len(problem.nodes), 4.0), speed, 0.0)
    corridor = room_of(*room)
    problem.bound(speed, force, 4.0, corridor, np.full(N, threat_free))
    multipliers, z = np.zeros(len(problem.rows)), np.zeros(len(problem.nodes))
    bounds = (problem.rows, problem.lower, problem.upper, problem.target)
    assert solve_exactly(*bounds, multipliers, z) >= 0
    reached = problem.rows @ z
    assert (reached >= problem.lower - 1e-9).all()
    assert (reached <= problem.upper + 1e-9).all()
    plan = Planner(MODEL, FOLLOWING).plan(speed, force, 4.0, Road(FREE), Fixed(corridor))
    assert "no QP solution" not in plan.status
    assert abs(plan.force) <= 8000.0
    # the bounds as they round: the difference of two forces may round to more than 1,000 N
    assert speed <= 1e-3 or force - 1000.0 <= plan.force <= force + 1000.0


class Beside:
    """People beside the way whatever is driven: a plan once made goes on for its cost."""

    def evaluate(self, manoeuvre, *, creeps=False):
        return Evaluation(FREE, FREE, np.full(N, 5.9))

    def prefer(self):
        pass


@pytest.mark.parametrize("crowd", [None, Beside()], ids=["nobody", "people about"])
def test_lanes_speeds_are_kept_to_whatever_the_manoeuvre(crowd):
    planner = Planner(MODEL, replace(FOLLOWING, reference_speed=10.0))
    dt, speed, force = MODEL.time_step, 10.0, 10.0 * MODEL.friction
    times = dt * np.arange(1, N + 1)
    for k in range(60):
        falling = np.maximum(11.0 - 2.0 * (k * dt + times), 6.0)
        fastest = min(10.0, max(11.0 - 2.0 * k * dt, 6.0))
        force = planner.plan(speed, force, fastest, Road(FREE, falling), crowd).force
        speed = MODEL.decay * speed + MODEL.speed_per_force * force
        assert speed <= falling[0] + 1e-3
    assert speed > 5.5


class StepsOut:
    """Somebody for whose sake the ego has to be slow for a while, from 1.2 s ahead on."""

    def __init__(self, horizon, threat_free):
        self.nobody = np.full(horizon, np.inf)
        self.threat_free = np.full(horizon, np.inf)
        self.threat_free[24:30] = threat_free

    def evaluate(self, manoeuvre, *, creeps=False):
        return Evaluation(self.nobody, self.threat_free, self.nobody)

    def prefer(self):
        pass


@pytest.mark.parametrize(("speed", "heeds"), [(4.0, False), (8.0, True), (12.0, True)])
def test_on_faster_roads_calm_speeds_are_kept_earlier(speed, heeds):
    """At 4 m/s half a second before is soon enough; from 12 m/s it takes longer at 3 m/s^2."""
    parameters = PlannerParameters(reference_speed=speed)
    parameters = replace(parameters, manoeuvres=replace(parameters.manoeuvres, threat_weight=0.0))
    horizon = parameters.horizon
    planner, freely = Planner(MODEL, parameters), MODEL.friction * speed
    free = Road(np.full(horizon, np.inf))
    planner.plan(speed, freely, speed, free, StepsOut(horizon, speed / 2))
    slowest = planner._plan.speed[24:31].min()
    gently = speed - 3.0 * 30 * MODEL.time_step
    assert slowest == pytest.approx(max(speed / 2, gently) if heeds else speed, rel=0.05)


class BesideTheWay:
    """Somebody who could step on the way 40 m ahead; the layer would act from full braking on."""

    PLACE, CALM, FULLY = 40.0, 5.0, 8.0  # [m], [m/s], [m/s^2]

    def __init__(self, horizon):
        self.nobody = np.full(horizon, np.inf)
        self.driven = 0.0

    def fastest(self, station):
        """From which the hardest braking still does [m/s]; beyond the place any."""
        left = self.PLACE - station
        return np.where(
            left > 0.0, np.sqrt(self.CALM**2 + 2.0 * self.FULLY * np.maximum(left, 0.0)), np.inf
        )

    def evaluate(self, manoeuvre, *, creeps=False):
        threat_free = self.fastest(self.driven + manoeuvre.distance[1:])
        heeded = np.where(manoeuvre.speed[1:] > threat_free, threat_free, np.inf)
        return Evaluation(self.nobody, heeded, self.nobody)

    def prefer(self):
        pass


def test_what_could_happen_ahead_is_approached_gently():
    """At 50 km/h a plan keeps threat-free speeds, but never brakes as hard as they fall."""
    parameters = PlannerParameters(reference_speed=13.9)
    planner, beside = Planner(MODEL, parameters), BesideTheWay(parameters.horizon)
    anywhere, speed, force, hardest = Road(np.full(parameters.horizon, np.inf)), 13.9, 0.0, 0.0
    while beside.driven < beside.PLACE:
        force = planner.plan(speed, force, 13.9, anywhere, beside).force
        after = MODEL.decay * speed + MODEL.speed_per_force * force
        hardest = max(hardest, (speed - after) / MODEL.time_step)
        beside.driven, speed = beside.driven + MODEL.time_step * speed, after
        assert speed <= beside.fastest(beside.driven) + 0.1
    assert speed <= beside.CALM + 0.4
    assert 2.0 < hardest < 3.5
