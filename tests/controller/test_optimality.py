"""The linear algebra behind "exact" on small problems made to be degenerate.

Minimise |V - target|^2 subject to lower <= rows V <= upper, with dyadic numbers, so that many
constraints meet in one point, rows repeat and bounds coincide. Judged by the conditions of Karush,
Kuhn & Tucker, sufficient as the problem is convex, and by HiGHS.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from controller import LongitudinalModel, MpcParameters, Outcome
from controller.active_set import INFEASIBLE, solve_exactly
from controller.osqp_backend import OsqpBackend
from controller.speed_problem import SLACK, UNDECIDED, SpeedProblem
from controller.verification import certifies_infeasibility, refine

BOX = 4.0  # all variables within -BOX ... BOX


@st.composite
def problems(draw, feasible):
    N, extra = draw(st.integers(1, 5)), draw(st.integers(0, 6))
    halves = st.integers(-4, 4).map(lambda i: 0.5 * i)
    dense = np.array([[draw(halves) for _ in range(N)] for _ in range(extra)]).reshape(extra, N)
    dense[~dense.any(axis=1)] = 1.0
    rows = np.concatenate([np.eye(N), dense])
    inside = rows @ [draw(halves) for _ in range(N)]
    gap, shift = st.sampled_from([0.0, 0.5, 1.0, 3.0, np.inf]), st.integers(-3, 3)
    shifted = np.array([0 if feasible else draw(shift) for _ in inside])
    lower = inside + shifted - [draw(gap) for _ in inside]
    upper = inside + shifted + [draw(gap) for _ in inside]
    lower[:N], upper[:N] = np.clip(lower[:N], -BOX, BOX), np.clip(upper[:N], -BOX, BOX)
    target = np.array([draw(st.floats(-8.0, 8.0)) for _ in range(N)])
    return rows, lower - SLACK, upper + SLACK, target  # as the controller's: never a single point


def assert_optimal(problem, multipliers, V):
    rows, lower, upper, target = problem
    values = rows @ V
    assert (values <= upper + 1e-8).all()
    assert (values >= lower - 1e-8).all()
    scale = max(1.0, np.abs(multipliers).max())
    np.testing.assert_allclose(2.0 * (V - target) + rows.T @ multipliers, 0.0, atol=1e-7 * scale)
    at_upper, at_lower = multipliers > 1e-8 * scale, multipliers < -1e-8 * scale
    np.testing.assert_allclose(values[at_upper], upper[at_upper], atol=1e-8)
    np.testing.assert_allclose(values[at_lower], lower[at_lower], atol=1e-8)


def feasible_by_highs(rows, lower, upper):
    A, b = np.concatenate([rows, -rows]), np.concatenate([upper, -lower])
    kept = np.isfinite(b)
    free, zero = [(None, None)] * rows.shape[1], np.zeros(rows.shape[1])
    return linprog(zero, A_ub=A[kept], b_ub=b[kept], bounds=free, method="highs").status == 0


@settings(max_examples=400, deadline=None)
@given(problem=problems(feasible=True))
def test_the_dual_method_ends_at_the_optimum(problem):
    rows, *_, target = problem
    multipliers, V = np.zeros(len(rows)), np.zeros(len(target))
    assert solve_exactly(*problem, multipliers, V) >= 0
    assert_optimal(problem, multipliers, V)


@settings(max_examples=300, deadline=None)
@given(problem=problems(feasible=True), seed=st.integers(0, 2**16), noise=st.floats(0.0, 1e-3))
def test_what_refine_verifies_is_the_optimum_whatever_it_started_from(problem, seed, noise):
    rows, *_, target = problem
    multipliers, V = np.zeros(len(rows)), np.zeros(len(target))
    solve_exactly(*problem, multipliers, V)
    for start in (
        multipliers * (1.0 + noise),
        np.random.default_rng(seed).normal(size=len(rows)),
        np.full(len(rows), np.nan),
    ):
        W = np.zeros(len(target))
        if refine(*problem, start, W) >= 0:
            assert_optimal(problem, start, W)
            np.testing.assert_allclose(W, V, atol=1e-7)


@settings(max_examples=400, deadline=None)
@given(problem=problems(feasible=False))
def test_infeasibility_is_certified_if_and_only_if_there_is_no_point(problem):
    rows, lower, upper, target = problem
    multipliers, V = np.zeros(len(rows)), np.zeros(len(target))
    outcome = solve_exactly(*problem, multipliers, V)
    assert outcome >= 0 or outcome == INFEASIBLE
    assert (outcome >= 0) is feasible_by_highs(rows, lower, upper)
    if outcome == INFEASIBLE:
        assert certifies_infeasibility(rows, lower, upper, -2 * BOX, 2 * BOX, multipliers)


@settings(max_examples=200, deadline=None)
@given(problem=problems(feasible=True), seed=st.integers(0, 2**16))
def test_nothing_certifies_that_a_feasible_problem_is_not(problem, seed):
    rows, lower, upper, _ = problem
    generator = np.random.default_rng(seed)
    normal, signs = generator.normal(size=len(rows)), generator.choice([-1.0, 0, 1], len(rows))
    for certificate in (normal, signs):
        assert not certifies_infeasibility(rows, lower, upper, -BOX - 1, BOX + 1, certificate)


def test_a_certificate_counts_only_the_right_way_round():
    rows = np.array([[1.0], [1.0]])
    problem = (rows, np.array([1.0, -1.0]), np.array([2.0, 0.0]), -5.0, 5.0)  # empty
    assert certifies_infeasibility(*problem, np.array([-1.0, 1.0]))
    assert not certifies_infeasibility(*problem, np.array([1.0, -1.0]))


@pytest.mark.parametrize(
    ("guess", "corrections"), [([0.0, 0.0, 1.9], 0), ([0.0, 0.0, 0.0], 1), ([-5.0, 0.0, 0.0], 2)]
)
def test_refine_adds_what_is_missed_and_drops_what_pulls(guess, corrections):
    """V nearest to (2, 2) on the near side of v_1 + v_2 = 2: (1, 1), with multiplier 2."""
    rows = np.array([[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    lower, upper = np.array([-9.0, -9.0, -np.inf]), np.array([9.0, 9.0, 2.0])
    multipliers, V = np.array(guess), np.zeros(2)
    assert refine(rows, lower, upper, np.array([2.0, 2.0]), multipliers, V) == corrections
    np.testing.assert_allclose(V, [1.0, 1.0], atol=1e-14)
    np.testing.assert_allclose(multipliers, [0.0, 0.0, 2.0], atol=1e-14)


@pytest.mark.parametrize("gap", [10.7, 10.8, 11.0, np.inf])
def test_osqp_from_a_cold_start_finds_the_active_set_of_an_easy_problem(gap):
    """Harder ones, where the car just stops, can take thousands of iterations."""
    problem = SpeedProblem(LongitudinalModel(), MpcParameters())
    assert problem.update(0.0, 4.0, 400.0, np.full(15, gap)) == UNDECIDED
    bounds = (problem.rows, problem.lower, problem.upper, problem.target)
    exact = np.zeros(15)
    assert solve_exactly(*bounds, np.zeros(len(problem.rows)), exact) >= 0
    speeds, multipliers = problem.target.copy(), np.zeros(len(problem.rows))
    assert OsqpBackend(problem, 4000).solve(speeds, multipliers)[0] is Outcome.SOLVED
    np.testing.assert_allclose(speeds, exact, atol=0.05)
    assert refine(*bounds, multipliers, speeds) >= 0
    np.testing.assert_allclose(speeds, exact, atol=1e-9)


def test_osqp_from_the_optimum_only_confirms_it():
    problem = SpeedProblem(LongitudinalModel(), MpcParameters())
    assert problem.update(0.0, 4.0, 400.0, np.full(15, 9.95)) == UNDECIDED
    bounds = (problem.rows, problem.lower, problem.upper, problem.target)
    speeds, multipliers = np.zeros(15), np.zeros(len(problem.rows))
    assert solve_exactly(*bounds, multipliers, speeds) >= 0
    start = speeds.copy()
    outcome, iterations = OsqpBackend(problem, 4000).solve(speeds, multipliers)
    assert outcome is Outcome.SOLVED
    assert iterations <= 5
    np.testing.assert_allclose(speeds, start, atol=1e-4)
