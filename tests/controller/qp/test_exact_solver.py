"""When the solver behind the exact methods is set up: at the start, or where they do not end."""

from __future__ import annotations

import numpy as np
import pytest
from least_squares_cases import optimum

from controller import LongitudinalModel, MpcParameters, Outcome
from controller.paper_mpc.speed_problem import UNDECIDED, SpeedProblem
from controller.qp import exact_solver, osqp_backend

LIMIT = MpcParameters().iteration_limit


@pytest.fixture
def set_up(monkeypatch):
    """The problems that OSQP has been set up for."""
    problems, really = [], osqp_backend.OsqpBackend

    def counted(problem, limit):
        problems.append(problem)
        return really(problem, limit)

    monkeypatch.setattr(osqp_backend, "OsqpBackend", counted)
    return problems


@pytest.fixture
def problem():
    problem = SpeedProblem(LongitudinalModel(), MpcParameters())
    assert problem.update(0.0, 4.0, 400.0, np.full(15, 10.8)) == UNDECIDED
    return problem


def test_osqp_is_set_up_where_the_exact_methods_do_not_end(set_up, problem, monkeypatch):
    solver = exact_solver.ExactSolver(problem, LIMIT, box=None)
    assert solver.solve()[0] is Outcome.SOLVED
    found = solver.solution.copy()
    assert set_up == []
    monkeypatch.setattr(exact_solver, "solve_verified", lambda *_: -1)
    for _ in range(2):
        outcome, iterations = solver.solve()
        assert outcome is Outcome.SOLVED
        assert iterations >= 1
        np.testing.assert_allclose(solver.solution, found, atol=1e-9)
    np.testing.assert_allclose(found, optimum(problem)[0], atol=1e-9)
    assert set_up == [problem]
    solver.reset()
    assert solver.solve()[0] is Outcome.SOLVED
    assert set_up == [problem, problem]  # a fresh one: what it knew is forgotten


def test_osqp_is_set_up_at_once_if_infeasibility_must_be_proved(set_up, problem):
    exact_solver.ExactSolver(problem, LIMIT, (0.0, 20.0))
    assert set_up == [problem]
