"""The planner's QP, against its cost and limits written out plainly, DAQP and HiGHS."""

from __future__ import annotations

from dataclasses import replace

import daqp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from controller import LongitudinalModel, Planner, PlannerParameters, Prospect
from controller.active_set import solve_exactly
from controller.planning.smoothing import WIDER, SmoothingProblem, nodes_of

N = 60
FREE = np.full(N, np.inf)
MODEL = LongitudinalModel()
FOLLOWING = PlannerParameters(gap_choice=False)  # its QP depends on nothing but its input
D_SAFE = FOLLOWING.safe_distance

speeds = st.one_of(st.sampled_from([0.0, 4.0, 20.0]), st.floats(0.0, 20.0))
forces = st.one_of(st.sampled_from([-8000.0, 0.0, 8000.0]), st.floats(-8000.0, 8000.0))
rooms = st.tuples(
    st.integers(0, N - 1),
    st.integers(1, N),
    st.floats(-20.0, 40.0),
    st.floats(-3.0, 5.0),
)


def room_of(first: int, length: int, room: float, pace: float) -> np.ndarray:
    """Free, but for some steps in which somebody who moves along takes the room [m]."""
    corridor = FREE.copy()
    steps = np.arange(first, min(first + length, N))
    corridor[steps] = room + pace * 0.05 * (steps - first)
    return corridor


class Fixed:
    """A crowd that moves with the ego: as far from it under each manoeuvre."""

    def __init__(self, room):
        self.room = room

    def prospect(self, manoeuvre):
        gap = self.room + D_SAFE - manoeuvre.distance[1:]
        return Prospect(gap, np.zeros(N), FREE)

    def prefer(self):
        pass


def drawn(plain_problem, seed, *, parameters=FOLLOWING):
    """A random problem with somebody in the way."""
    g = np.random.default_rng(seed)
    speed = float(g.choice([0.0, 4.0, g.uniform(0.0, 12.0)]))
    cruise = MODEL.friction * speed
    force = float(g.choice([cruise, g.uniform(-8000.0, 8000.0)])) if speed > 0.0 else 0.0
    room = room_of(g.integers(N), g.integers(1, N), g.uniform(-2.0, 1.2 * speed * 3), 0.0)
    before = (force - cruise) / MODEL.mass if speed > 0.0 else 0.0
    wanted = np.full(len(nodes_of(N, parameters.block_growth)), 4.0)
    return plain_problem(speed, force, before, wanted, 4.0, room, MODEL, parameters)


def bounded(plain, *, soft=True):
    """The room's own problem for a plain one, and whether it has a plan."""
    problem = SmoothingProblem(plain.model, plain.parameters)
    problem.aim_at(plain.wanted, plain.speed, plain.acceleration)
    found = problem.bound(
        plain.speed, plain.previous_force, plain.fastest, plain.room, FREE, soft=soft
    )
    return problem, found


def any_plan(g, plain, lower, upper):
    """(n,) [m/s] within the vehicle's limits, and else at random."""
    h, n = plain.intervals, len(plain.intervals)
    v = [g.uniform(lower[0], upper[0])]
    for i in range(1, n):
        most = upper[n] * h[i] * g.choice([0.1, 1.0])
        v.append(float(np.clip(v[-1] + g.uniform(-most, most), lower[i], upper[i])))
    return np.array(v)


def test_the_intervals_grow_up_to_the_horizon():
    assert list(nodes_of(5, 0.0)) == [1, 2, 3, 4, 5]
    assert list(nodes_of(12, 0.5)) == [1, 2, 3, 5, 7, 11, 12]
    nodes = nodes_of(60, 0.25)
    assert nodes[-1] == 60
    assert len(nodes) < 20  # a third of the unknowns


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("growth", [0.0, 0.25])
def test_the_distance_to_the_target_is_the_cost(plain_problem, seed, growth):
    g = np.random.default_rng(seed)
    parameters = PlannerParameters(horizon=20, block_growth=growth, effort_weight=g.uniform(0, 1))
    n = len(nodes_of(20, growth))
    wanted = g.uniform(0.0, 4.0, n)
    plain = plain_problem(3.0, 500.0, -1.3, wanted, 4.0, FREE[:20], MODEL, parameters)
    problem, _ = bounded(plain)
    L = np.linalg.inv(np.column_stack([problem.speeds(e) for e in np.eye(n)]))
    u, v = g.uniform(0.0, 5.0, (2, n))
    ours = [np.sum((L @ x - problem.target) ** 2) for x in (u, v)]
    assert ours[1] - ours[0] == pytest.approx(plain.cost(v) - plain.cost(u), rel=1e-9)


@pytest.mark.parametrize("seed", range(20))
def test_rows_and_bounds_are_the_written_ones(plain_problem, seed):
    plain = drawn(plain_problem, seed)
    problem, _ = bounded(plain)
    z = np.random.default_rng(seed).uniform(0.0, 5.0, len(problem.nodes))
    v = problem.speeds(z)
    G, lower, upper = plain.rows()
    D, room = plain.distances()
    assert problem.rows @ z == pytest.approx(np.concatenate([G @ v, D @ v]), abs=1e-12)
    assert problem.lower[: len(G)] == pytest.approx(lower - WIDER, abs=1e-12)
    assert problem.upper[: len(G)] == pytest.approx(upper + WIDER, abs=1e-12)
    assert (problem.upper[len(G) :] >= room).all()


@pytest.mark.parametrize("seed", range(40))
def test_the_corridor_gives_way_by_exactly_what_no_plan_avoids(plain_problem, seed):
    plain = drawn(plain_problem, seed)
    problem, _ = bounded(plain)
    _, room = plain.distances()
    known = np.isfinite(room)
    given_way = problem.upper[-len(room) :][known] - WIDER - room[known]
    each, together = plain.unavoidable()
    assert given_way == pytest.approx(each[known], abs=1e-7)
    assert together == pytest.approx(each.sum(), abs=1e-6)  # one plan attains all of them


@pytest.mark.parametrize("seed", range(12))
def test_no_plan_is_better_under_a_penalty_beyond_the_largest_multiplier(plain_problem, seed):
    plain = drawn(plain_problem, seed)
    problem, _ = bounded(plain)
    G, lower, upper = plain.rows()
    D, room = plain.distances()
    P, q = plain.quadratic()
    widened = np.minimum(problem.upper[-len(room) :], 1e30)
    v, _, flag, info = daqp.solve(
        P,
        q,
        np.concatenate([G, D]),
        np.concatenate([upper, widened]),
        np.concatenate([lower, np.full(len(room), -1e30)]),
        np.zeros(len(G) + len(D), dtype=np.int32),
    )
    assert flag == 1
    penalty = 1.01 * np.abs(info["lam"]).max() + 1.0

    def penalised(x):
        return plain.cost(x) + penalty * np.maximum(D @ x - room, 0.0).sum()

    g = np.random.default_rng(seed)
    best = penalised(v)
    for _ in range(1000):
        other = any_plan(g, plain, lower, upper)
        nearer = v + 10.0 ** g.uniform(-4.0, 0.0) * (other - v)  # the limits are convex
        assert penalised(nearer) >= best - 1e-5


@pytest.mark.parametrize("seed", range(60))
@pytest.mark.parametrize("solver", ["osqp", "daqp"])
def test_the_force_is_that_of_the_plain_problems_optimum(plain_problem, seed, solver):
    plain = drawn(plain_problem, seed, parameters=replace(FOLLOWING, solver=solver))
    G, lower, upper = plain.rows()
    D, room = plain.distances()
    each, _ = plain.unavoidable()
    P, q = plain.quadratic()
    v, _, flag, _ = daqp.solve(
        P,
        q,
        np.concatenate([G, D]),
        np.concatenate([upper, np.minimum(room + each, 1e30)]) + 1e-7,
        np.concatenate([lower, np.full(len(room), -1e30)]) - 1e-7,
        np.zeros(len(G) + len(D), dtype=np.int32),
        primal_tol=1e-9,
    )
    assert flag == 1
    plan = Planner(MODEL, plain.parameters).plan(
        plain.speed, plain.previous_force, 4.0, FREE, Fixed(plain.room)
    )
    assert plan.status == "solved"
    wanted = (v[0] - MODEL.decay * plain.speed) / MODEL.speed_per_force
    assert plan.force == pytest.approx(np.clip(wanted, -8000.0, 8000.0), abs=0.1)


@given(speed=speeds, force=forces, room=rooms, calm=st.floats(0.0, 25.0))
@settings(max_examples=150, deadline=None)
def test_a_soft_corridor_always_leaves_a_plan(speed, force, room, calm):
    problem = SmoothingProblem(MODEL, FOLLOWING)
    problem.aim_at(np.full(len(problem.nodes), 4.0), speed, 0.0)
    corridor = room_of(*room)
    assert problem.bound(speed, force, 4.0, corridor, np.full(N, calm), soft=True)
    multipliers, z = np.zeros(len(problem.rows)), np.zeros(len(problem.nodes))
    bounds = (problem.rows, problem.lower, problem.upper, problem.target)
    assert solve_exactly(*bounds, multipliers, z) >= 0
    reached = problem.rows @ z
    assert (reached >= problem.lower - 1e-9).all()
    assert (reached <= problem.upper + 1e-9).all()
    for gap_choice in (True, False):
        planner = Planner(MODEL, replace(FOLLOWING, gap_choice=gap_choice))
        plan = planner.plan(speed, force, 4.0, FREE, Fixed(corridor))
        assert plan.found
        assert "no QP solution" not in plan.status
        assert abs(plan.force) <= 8000.0
        assert speed <= 1e-3 or abs(plan.force - force) <= 1000.0


@given(speed=speeds, force=forces, room=rooms)
@settings(max_examples=60, deadline=None)
def test_a_hard_corridor_is_refused_if_and_only_if_braking_cannot_keep_it(
    plain_problem, speed, force, room
):
    parameters = replace(FOLLOWING, soft=False)
    wanted = np.full(len(nodes_of(N, parameters.block_growth)), 4.0)
    plain = plain_problem(speed, force, 0.0, wanted, 4.0, room_of(*room), MODEL, parameters)
    each, _ = plain.unavoidable()
    _, found = bounded(plain, soft=False)
    plan = Planner(MODEL, parameters).plan(speed, force, 4.0, FREE, Fixed(plain.room))
    if each.max() > 1e-6:
        assert not found
        assert plan.status == "infeasible: cannot keep the distance"
    elif bounded(replace(plain, room=plain.room - 1e-6), soft=False)[1]:  # else rounding decides
        assert found
        assert plan.found


def test_the_calm_speed_is_kept_as_far_as_braking_allows():
    problem = SmoothingProblem(MODEL, FOLLOWING)
    calm = FREE.copy()
    calm[:10] = 1.0
    problem.bound(4.0, 400.0, 4.0, FREE, calm, soft=True)
    n = len(problem.nodes)
    first = MODEL.decay * 4.0 + MODEL.speed_per_force * (400.0 - 1000.0)
    hardest = np.maximum(first - 8.0 * 0.05 * (problem.nodes - 1), 0.0)
    expected = np.where(problem.nodes <= 10, np.maximum(hardest, 1.0), 4.0)
    assert problem.upper[:n] == pytest.approx(expected + WIDER, abs=1e-12)
