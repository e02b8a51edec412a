"""The planner in a closed loop with people who do what was predicted: docs/planner.md has proofs.

"As planned" always stays a plan that lacks no stopping distance. Whether it is taken is a matter of
cost: with a closeness weight beyond all else nothing is ever missing; with the usual one some
centimetres are bought where they save seconds.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from controller import (
    LongitudinalModel,
    Manoeuvre,
    ManoeuvreParameters,
    Observation,
    Planner,
    PlannerParameters,
    PlanningController,
)
from controller._jit import kernel
from controller.defaults import STANDSTILL
from controller.driving_constants import CREEPING, CREEPS_NEARER, PATIENCE
from controller.planning.costs import stopping_need
from controller.planning.motions import aim
from controller.planning.parameters import Weights

stopping_need = kernel(stopping_need)
aim = kernel(aim)

MODEL = LongitudinalModel()
N, DT, V_R = PlannerParameters().horizon, MODEL.time_step, 4.0
LEAST = ManoeuvreParameters().minimum_distance
STEPS = round(PATIENCE / DT)  # before it creeps
FREE = np.full(N, np.inf)  # no vehicle, no light
BOUGHT = 0.2  # [m]


@dataclass(frozen=True)
class Drive:
    """What came of it."""

    lacking: float  # [m] of stopping distance, at worst
    closest: float  # [m]
    driven: float  # [m]


def drive(bystanders, speed, at, until, steps=STEPS, **changes):
    """A drive behind people at stations ``at`` [m] from a first step that can still stop."""
    parameters = PlannerParameters(manoeuvres=ManoeuvreParameters(**changes))
    weights = Weights.of(parameters, parameters.manoeuvres)
    controller = PlanningController(Planner(MODEL, parameters))
    controller.applied(MODEL.friction * speed)
    crowd = bystanders(room_for_a_stop(speed, weights) + np.asarray(at), until, N)
    x, v, lacking, closest = 0.0, speed, -np.inf, np.inf
    for k in range(steps):
        crowd.step, crowd.front = k, x
        decision = controller.control(Observation(x, v, crowd.gap(), FREE, foresight=crowd))
        assert decision.acting == "mpc"
        x += DT * v
        v = max(0.0, MODEL.decay * v + MODEL.speed_per_force * decision.force)
        crowd.step, crowd.front = k + 1, x
        closest = min(closest, crowd.gap())
        if v > STANDSTILL:
            lacking = max(lacking, stopping_need(v, weights) - crowd.gap())
    return Drive(lacking, closest, x)


def room_for_a_stop(speed, weights):
    """The least gap [m] at which the search's hardest braking is admissible."""
    m = Manoeuvre.empty(N)
    hardest = min(ManoeuvreParameters().accelerations)
    motion = (m.distance[None], m.speed[None], m.acceleration[None])
    aim(speed, 0.0, np.array([[hardest, 0.0]]), V_R, (8.0, 8.0), DT, motion)
    return max(s + stopping_need(v, weights) for s, v in zip(m.distance, m.speed, strict=True))


@st.composite
def standing(draw):
    """A speed, and one to three people: how far beyond the closest place, and until which step."""
    speed = draw(st.floats(0.0, V_R))
    count = draw(st.integers(1, 3))
    at = [draw(st.sampled_from([0.0, 0.3, 2.0]) | st.floats(0.0, 15.0)) for _ in range(count)]
    until = [draw(st.sampled_from([np.inf]) | st.integers(1, STEPS)) for _ in range(count)]
    return speed, at, until


@given(standing())
@settings(max_examples=20)
def test_with_closeness_beyond_all_else_a_stop_stays_possible(bystanders, case):
    drove = drive(bystanders, *case, closeness_weight=1e9)
    assert drove.lacking <= 1e-4
    assert drove.closest >= LEAST - 1e-4


@given(standing())
@settings(max_examples=20)
def test_one_that_creeps_keeps_what_is_left_of_the_distance(bystanders, case):
    drove = drive(bystanders, *case, steps=2 * STEPS, closeness_weight=1e9)
    assert drove.closest >= LEAST - CREEPS_NEARER - 1e-4


@given(standing())
@settings(max_examples=25)
def test_with_the_usual_weight_some_centimetres_are_bought(bystanders, case):
    drove = drive(bystanders, *case)
    assert drove.lacking <= BOUGHT
    assert drove.closest >= LEAST - BOUGHT


@pytest.mark.parametrize("speed", [0.0, 2.0, 4.0])
def test_it_drives_up_to_who_stays_and_past_who_leaves(bystanders, speed):
    waits = drive(bystanders, speed, [10.0], [np.inf])
    passes = drive(bystanders, speed, [10.0], [20])
    assert LEAST - 0.1 < waits.closest < PlannerParameters().safe_distance
    assert passes.driven > waits.driven + 3.0


def test_an_ego_that_has_waited_creeps_and_stops_nearer(bystanders):
    """After ``PATIENCE`` it comes nearer to who stays than it otherwise does, slowly."""
    controller = PlanningController(Planner(MODEL, PlannerParameters()))
    crowd = bystanders(np.array([LEAST + 0.5]), [np.inf], N)
    x, v, fastest, waited = 0.0, 0.0, 0.0, np.inf
    for k in range(6 * STEPS):
        crowd.step, crowd.front = k, x
        force = controller.control(Observation(x, v, crowd.gap(), FREE, foresight=crowd)).force
        x += DT * v
        v = max(0.0, MODEL.decay * v + MODEL.speed_per_force * force)
        waited, fastest = x if k == STEPS else waited, max(fastest, v)
    assert waited < 0.1
    assert x == pytest.approx(0.5 + CREEPS_NEARER, abs=0.05)
    assert fastest <= CREEPING


def test_a_plan_may_end_too_fast_for_full_braking():
    weights = Weights.of(PlannerParameters(), ManoeuvreParameters())
    assert stopping_need(V_R, weights) < V_R**2 / (2.0 * 8.0) + LEAST  # full braking is not enough


@pytest.mark.parametrize("room", [2.0, 4.2, 9.0])
def test_it_drives_up_to_where_the_way_ends(room):
    """To the waiting place inside a junction at green, say: it does not wait where it stands."""
    controller = PlanningController(Planner(MODEL, PlannerParameters()))
    x, v, hardest = 0.0, 0.0, 0.0
    end = np.full(N, room + Observation(x, v, np.inf, FREE).safe_distance)
    for _ in range(300):
        seen = Observation(x, v, np.inf, end)
        force = controller.control(seen).force
        x += DT * v
        after = max(0.0, MODEL.decay * v + MODEL.speed_per_force * force)
        hardest, v = max(hardest, (v - after) / DT), after
    assert room - 0.5 < x < room + 0.1
    assert hardest < 2.0


def stations(bystanders, at, to_clear, steps=3 * STEPS):
    """Station [m] after each step from a standstill, behind somebody at ``at`` who stays."""
    controller = PlanningController(Planner(MODEL, PlannerParameters()))
    crowd = bystanders(np.array([at]), [np.inf], N)
    x, v, found = 0.0, 0.0, []
    for k in range(steps):
        crowd.step, crowd.front = k, x
        seen = Observation(x, v, crowd.gap(), FREE, foresight=crowd, to_clear=to_clear - x)
        force = controller.control(seen).force
        x += DT * v
        v = max(0.0, MODEL.decay * v + MODEL.speed_per_force * force)
        found.append(x)
    return found


def test_it_drives_on_from_where_it_would_block_others(bystanders):
    """With its rear on a crossing it drives on for less room than it would need elsewhere.

    In the end it creeps to the same place in either case.
    """
    places = np.arange(2.5, 4.5, 0.2)
    elsewhere, blocking = (
        np.array([stations(bystanders, at, to_clear) for at in places]) for to_clear in (0.0, 1.0)
    )
    soon, blocking_soon = elsewhere[:, STEPS - 1], blocking[:, STEPS - 1]
    driven = blocking_soon > soon + 1.0
    assert driven.any()
    assert (soon[driven] == 0.0).all(), "it stands where nobody is blocked"
    np.testing.assert_allclose(blocking_soon[driven], places[driven] - LEAST, atol=0.1)
    assert (blocking_soon >= soon).all()
    np.testing.assert_allclose(blocking[:, -1], elsewhere[:, -1], atol=0.01)
    np.testing.assert_allclose(blocking[:, -1], places - LEAST + CREEPS_NEARER, atol=0.01)
