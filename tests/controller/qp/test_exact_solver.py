"""When the solver behind the exact methods is set up: at the start, or where they do not end."""

from __future__ import annotations

import numpy as np
import pytest
from least_squares_cases import optimum

from controller import LongitudinalModel, MpcParameters, Outcome
from controller.paper_mpc.speed_problem import UNDECIDED, SpeedProblem
from controller.qp import exact_solver

LIMIT = MpcParameters().iteration_limit


@pytest.fixture
def set_up(monkeypatch):
    """The solvers that have been set up, by name."""
    names, really = [], exact_solver.make_backend

    def counted(name, *arguments):
        names.append(name)
        return really(name, *arguments)

    monkeypatch.setattr(exact_solver, "make_backend", counted)
    return names


@pytest.fixture
def problem():
    problem = SpeedProblem(LongitudinalModel(), MpcParameters())
    assert problem.update(0.0, 4.0, 400.0, np.full(15, 10.8)) == UNDECIDED
    return problem


def test_osqp_is_set_up_where_the_exact_methods_do_not_end(set_up, problem, monkeypatch):
    solver = exact_solver.ExactSolver(problem, "osqp", LIMIT, box=None)
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
    assert set_up == ["osqp"]
    solver.reset()
    assert solver.solve()[0] is Outcome.SOLVED
    assert set_up == ["osqp", "osqp"]  # a fresh one: what it knew is forgotten


@pytest.mark.parametrize(("name", "box"), [("osqp", (0.0, 20.0)), ("daqp", None)])
def test_others_are_set_up_at_once_so_that_a_missing_one_is_known_at_the_start(
    set_up, problem, name, box
):
    exact_solver.ExactSolver(problem, name, LIMIT, box)
    assert set_up == [name]
