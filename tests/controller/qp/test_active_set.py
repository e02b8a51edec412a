"""The dual active-set method: at the optimum, or with a proof that there is none."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from least_squares_cases import (
    BOX,
    assert_optimal,
    feasible_by_highs,
    optimum,
    small_problems,
)

from controller._jit import kernel
from controller.qp.active_set import INFEASIBLE, solve_exactly
from controller.qp.verification import certifies_infeasibility

solve_exactly = kernel(solve_exactly)


def test_the_dual_method_meets_the_optimality_conditions(problems):
    """Karush, Kuhn and Tucker: stationary, feasible, multipliers of one sign where bounds bind."""
    bound_somewhere = 0
    for _, problem in problems(400, seed=1):
        found = optimum(problem)
        if found is None:
            continue
        V, y = found
        values = problem.rows @ V
        np.testing.assert_allclose(2.0 * (V - problem.target) + problem.rows.T @ y, 0.0, atol=1e-7)
        assert (values <= problem.upper + 1e-9).all()
        assert (values >= problem.lower - 1e-9).all()
        np.testing.assert_allclose(values[y > 1e-9], problem.upper[y > 1e-9], atol=1e-9)
        np.testing.assert_allclose(values[y < -1e-9], problem.lower[y < -1e-9], atol=1e-9)
        bound_somewhere += bool(np.abs(y).max() > 0.0)
    assert bound_somewhere > 100


def test_the_dual_method_says_infeasible_exactly_where_lp_does(problems, edge):
    said = {True: 0, False: 0}
    for reference, problem in problems(400, seed=2):
        found = optimum(problem) is not None
        margin = reference.margin()
        if abs(margin) > edge:
            assert found is (margin > 0.0), reference
        said[found] += 1
    assert min(said.values()) > 15


@settings(max_examples=150)
@given(problem=small_problems(feasible=True))
def test_the_dual_method_ends_at_the_optimum(problem):
    rows, *_, target = problem
    multipliers, V = np.zeros(len(rows)), np.zeros(len(target))
    assert solve_exactly(*problem, multipliers, V) >= 0
    assert_optimal(problem, multipliers, V)


@settings(max_examples=150)
@given(problem=small_problems(feasible=False))
def test_infeasibility_is_certified_exactly_if_there_is_no_point(problem):
    rows, lower, upper, target = problem
    multipliers, V = np.zeros(len(rows)), np.zeros(len(target))
    outcome = solve_exactly(*problem, multipliers, V)
    assert outcome >= 0 or outcome == INFEASIBLE
    assert (outcome >= 0) is feasible_by_highs(rows, lower, upper)
    if outcome == INFEASIBLE:
        assert certifies_infeasibility(rows, lower, upper, -2 * BOX, 2 * BOX, multipliers)
