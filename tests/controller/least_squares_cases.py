"""Problems that the tests of the exact linear algebra share.

The small ones are made to be degenerate: minimise |V - target|^2 subject to lower <= rows V <=
upper, with dyadic numbers, so that many constraints meet in one point, rows repeat and bounds
coincide. They are judged by the conditions of Karush, Kuhn & Tucker, sufficient as the problem is
convex, and by HiGHS.
"""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st
from scipy.optimize import linprog

from controller._jit import kernel
from controller.paper_mpc.speed_problem import SLACK
from controller.qp.active_set import solve_exactly

solve_exactly = kernel(solve_exactly)

BOX = 4.0  # all variables of the small problems within -BOX ... BOX


@st.composite
def small_problems(draw, feasible):
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


def bounds(problem):
    return problem.rows, problem.lower, problem.upper, problem.target


def optimum(problem):
    """Speeds and multipliers by the dual method; None where it finds no plan."""
    speeds, multipliers = np.empty(15), np.zeros(56)
    if solve_exactly(*bounds(problem), multipliers, speeds) < 0:
        return None
    return speeds, multipliers
