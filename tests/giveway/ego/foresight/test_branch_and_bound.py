"""Branch and bound finds what judging each manoeuvre to its end finds, bit by bit."""

from __future__ import annotations

import numpy as np
import pytest

from controller import (
    LongitudinalModel,
    ManoeuvreParameters,
    Planner,
    PlannerParameters,
    SafetyParameters,
)
from controller.planning import Road
from giveway.ego.foresight.crowd_foresight import CrowdForesight, EgoAssumptions, plan_predictor
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import EgoPath
from pedestrian_model import (
    OPEN_GROUND,
    SIM,
    Crowd,
    CrowdModel,
    DivergenceError,
    Vehicles,
)

N, DT, LENGTH, WIDTH = 40, 0.05, 5.0, 2.0
FRONT = 20.0  # [m]
MODEL = LongitudinalModel(time_step=DT)
BEND = EgoPath.through([(0.0, 0.0), (25.0, 0.0), (40.0, 5.0), (60.0, 25.0)])


class OneByOne:
    """A foresight that cannot search itself."""

    def __init__(self, foresight):
        self.evaluate, self.prefer = foresight.evaluate, foresight.prefer


def foresight(**changes):
    worst = SafetyParameters().worst
    ego = EgoAssumptions(VehicleShape(LENGTH, WIDTH), 1.25, 0.05, 8.0, worst)
    predictor = plan_predictor(SIM, DT, N)
    return CrowdForesight(predictor, BEND, ego._replace(**changes), horizon=N, time_step=DT)


def people(seed, count=12):
    """People on both sides of the way ahead who cross it."""
    g = np.random.default_rng(seed)
    side = g.choice([-1.0, 1.0], count)
    x, y = g.uniform(FRONT + 1.0, FRONT + 14.0, count), side * g.uniform(0.5, 5.0, count)
    to = np.column_stack([x, -side * 12.0])
    velocity = np.column_stack([np.zeros(count), -side * g.uniform(0.0, 1.6, count)])
    return Crowd.create(np.column_stack([x, y]), velocity, 1.3, [[point] for point in to])


def poses():
    there = np.zeros((N, 2, 7))
    there[:, :, 4:] = LENGTH / 2, LENGTH / 2, WIDTH
    there[:, 1, :2] = FRONT + 8.0, -6.0  # somebody's parked car
    return there


def drive(seed, searching, steps=25):
    """What the planner decides on, step by step, and what it expects of people."""
    parameters = PlannerParameters(horizon=N, manoeuvres=ManoeuvreParameters())
    planner, ahead, crowd = Planner(MODEL, parameters), foresight(), people(seed)
    asked = ahead if searching else OneByOne(ahead)
    walk = CrowdModel(SIM, DT)
    speed, force, front, told = 4.0, 0.0, FRONT, []
    for _ in range(steps):
        ahead.look(crowd, OPEN_GROUND, (poses(), 0, front), speed)
        plan = planner.plan(speed, force, 4.0, Road(np.full(N, 30.0)), asked)
        search, expected = planner._search, ahead.best
        told.append((plan, *(a.copy() for a in (search.gap, search.threat_free, search.passing))))
        told[-1] += (None if expected is None else expected.copy(),)
        force, front = plan.force, front + DT * speed
        speed = max(0.0, MODEL.decay * speed + MODEL.speed_per_force * force)
        crowd = walk.step(crowd, Vehicles.empty())
    return told


@pytest.mark.parametrize("seed", range(6))
def test_branch_and_bound_finds_the_same_manoeuvres_and_plans(seed):
    searched, judged = drive(seed, searching=True), drive(seed, searching=False)
    manoeuvres = {plan.manoeuvre for plan, *_ in judged}
    assert len(manoeuvres) > 1
    for (plan, *found), (other, *expected) in zip(searched, judged, strict=True):
        assert plan == other
        for one, two in zip(found, expected, strict=True):
            assert np.array_equal(one, two)


def test_who_has_lost_is_not_rolled_out_any_farther():
    ahead, crowd = foresight(), people(6)
    planner = Planner(MODEL, PlannerParameters(horizon=N))
    ahead.look(crowd, OPEN_GROUND, (poses(), 0, FRONT), 4.0)
    planner.plan(4.0, 0.0, 4.0, Road(np.full(N, 30.0)), ahead)
    predicted = ahead._workspace.arrays[4][0]
    assert predicted.max() == N // 2
    assert (predicted[predicted >= 0] < N // 4).any()


def test_a_crowd_without_a_finite_future_is_named():
    ahead, crowd = foresight(), people(0)
    crowd.position[4] = np.nan
    ahead.look(crowd, OPEN_GROUND, (poses(), 0, FRONT), 4.0)
    planner = Planner(MODEL, PlannerParameters(horizon=N))
    with pytest.raises(DivergenceError, match="pedestrian 4"):
        planner.plan(4.0, 0.0, 4.0, Road(np.full(N, 30.0)), ahead)
