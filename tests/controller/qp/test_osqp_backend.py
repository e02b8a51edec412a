"""OSQP: from a cold start, from the optimum, out of iterations, interrupted."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

import numpy as np
import pytest
from least_squares_cases import bounds, optimum

from controller import LongitudinalModel, MpcParameters, Outcome
from controller._jit import kernel
from controller.paper_mpc.speed_problem import UNDECIDED, SpeedProblem
from controller.qp.active_set import solve_exactly
from controller.qp.osqp_backend import OsqpBackend
from controller.qp.verification import refine

solve_exactly = kernel(solve_exactly)
refine = kernel(refine)

LIMIT = MpcParameters().iteration_limit


def test_a_cold_solver_refined_agrees_with_the_dual_method(problems):
    """So the two ways to a plan, from the exact start and from nothing, lead to the same."""
    feasible, agreed = 0, 0
    for _, problem in problems(150, seed=7):
        speeds, multipliers = np.zeros(15), np.zeros(56)
        outcome, iterations = OsqpBackend(problem, LIMIT).solve(speeds, multipliers)
        found = optimum(problem)
        if outcome is Outcome.INFEASIBLE:
            assert found is None
        if found is None:
            assert outcome is not Outcome.SOLVED
            continue
        feasible += 1
        if outcome is Outcome.SOLVED and refine(*bounds(problem), multipliers, speeds) >= 0:
            np.testing.assert_allclose(speeds, found[0], atol=1e-9)
            assert iterations >= 1
            agreed += 1
    assert agreed > 0.9 * feasible > 50


def test_osqp_reports_that_it_ran_out_of_iterations(problems):
    outcomes = set()
    for _, problem in problems(20, seed=8):
        backend = OsqpBackend(problem, iteration_limit=1)
        outcomes.add(backend.solve(np.zeros(15), np.zeros(56))[0])
    assert Outcome.ITERATION_LIMIT in outcomes
    assert outcomes <= {Outcome.SOLVED, Outcome.ITERATION_LIMIT, Outcome.INACCURATE}


@pytest.mark.skipif(sys.platform == "win32", reason="signals as of POSIX")
def test_an_interrupt_reaches_its_handler_and_the_solve_ends(problems):
    """OSQP catches Ctrl-C while it solves: who pressed it must hear of it nevertheless."""
    heard = []
    before = signal.signal(signal.SIGINT, lambda *_: heard.append(True))
    script = f"for i in 1 2 3 4 5 6 7 8 9 10; do sleep 0.02; kill -INT {os.getpid()}; done"
    try:
        for _, problem in problems(1, seed=9):
            backend = OsqpBackend(problem, LIMIT)
            with subprocess.Popen(["sh", "-c", script]) as sender:
                while sender.poll() is None:
                    outcome, _ = backend.solve(np.zeros(15), np.zeros(56))
                    assert outcome in (Outcome.SOLVED, Outcome.INFEASIBLE)
    finally:
        signal.signal(signal.SIGINT, before)
    assert len(heard) >= 5


@pytest.mark.parametrize("gap", [10.7, 10.8, 11.0, np.inf])
def test_cold_osqp_finds_the_active_set_of_an_easy_problem(gap):
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
