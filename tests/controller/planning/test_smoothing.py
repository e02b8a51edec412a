"""The planner's QP, against its cost and limits written out plainly, DAQP and HiGHS."""

from __future__ import annotations

import hashlib

import daqp
import numpy as np
import pytest
from smoothing_cases import (
    FOLLOWING,
    FREE,
    MODEL,
    bounded,
    drawn,
)

from controller import PlannerParameters
from controller.planning.smoothing import WIDER, SmoothingProblem, nodes_of


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
def test_the_distance_to_the_target_is_the_cost(plain_problem, seed):
    g = np.random.default_rng(seed)
    parameters = PlannerParameters(horizon=20, effort_weight=g.uniform(0, 1))
    n = len(nodes_of(20))
    wanted = g.uniform(0.0, 4.0, n)
    plain = plain_problem(3.0, 500.0, -1.3, wanted, 4.0, FREE[:20], MODEL, parameters)
    problem = bounded(plain)
    L = np.linalg.inv(problem.speeds_of)
    u, v = g.uniform(0.0, 5.0, (2, n))
    ours = [np.sum((L @ x - problem.target) ** 2) for x in (u, v)]
    assert ours[1] - ours[0] == pytest.approx(plain.cost(v) - plain.cost(u), rel=1e-9)


def test_the_constants_have_the_same_bytes_on_every_processor():
    problem = SmoothingProblem(MODEL, PlannerParameters())
    constants = (problem.speeds_of, problem.rows, *problem.gradients)
    together = b"".join(array.tobytes() for array in constants)
    assert hashlib.sha256(together).hexdigest()[:16] == "601de27c1e271d56"


@pytest.mark.parametrize("seed", range(20))
def test_rows_and_bounds_are_the_written_ones(plain_problem, seed):
    plain = drawn(plain_problem, seed)
    problem = bounded(plain)
    z = np.random.default_rng(seed).uniform(0.0, 5.0, len(problem.nodes))
    v = problem.speeds_of @ z
    G, lower, upper = plain.rows()
    D, room = plain.distances()
    assert problem.rows @ z == pytest.approx(np.concatenate([G @ v, D @ v]), abs=1e-12)
    assert problem.lower[: len(G)] == pytest.approx(lower - WIDER, abs=1e-12)
    assert problem.upper[: len(G)] == pytest.approx(upper + WIDER, abs=1e-12)
    assert (problem.upper[len(G) :] >= room).all()


@pytest.mark.parametrize("seed", range(40))
def test_the_corridor_gives_way_by_exactly_what_no_plan_avoids(plain_problem, seed):
    plain = drawn(plain_problem, seed)
    problem = bounded(plain)
    _, room = plain.distances()
    known = np.isfinite(room)
    given_way = problem.upper[-len(room) :][known] - WIDER - room[known]
    each, together = plain.unavoidable()
    assert given_way == pytest.approx(each[known], abs=1e-7)
    assert together == pytest.approx(each.sum(), abs=1e-6)  # one plan attains all of them


@pytest.mark.parametrize("seed", range(12))
def test_a_penalty_beyond_the_largest_multiplier_is_exact(plain_problem, seed):
    plain = drawn(plain_problem, seed)
    problem = bounded(plain)
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
    for _ in range(250):
        other = any_plan(g, plain, lower, upper)
        nearer = v + 10.0 ** g.uniform(-4.0, 0.0) * (other - v)  # the limits are convex
        assert penalised(nearer) >= best - 1e-5


def test_the_calm_speed_is_kept_as_far_as_braking_allows():
    problem = SmoothingProblem(MODEL, FOLLOWING)
    threat_free = FREE.copy()
    threat_free[:10] = 1.0
    problem.bound(4.0, 400.0, 4.0, FREE, threat_free)
    n = len(problem.nodes)
    first = MODEL.decay * 4.0 + MODEL.speed_per_force * (400.0 - 1000.0)
    hardest = np.maximum(first - 8.0 * 0.05 * (problem.nodes - 1), 0.0)
    expected = np.where(problem.nodes <= 10, np.maximum(hardest, 1.0), 4.0)
    assert problem.upper[:n] == pytest.approx(expected + WIDER, abs=1e-12)
