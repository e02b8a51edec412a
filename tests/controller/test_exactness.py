"""The parts that make a solve exact: refinement, the dual method, certificates, cold OSQP."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

import numpy as np
import pytest

from controller import LongitudinalModel, MpcParameters, Outcome
from controller.active_set import INFEASIBLE, solve_exactly
from controller.daqp_backend import DaqpBackend
from controller.osqp_backend import OsqpBackend
from controller.speed_problem import (
    CANNOT_HOLD_SPEED,
    CANNOT_STOP,
    UNDECIDED,
    SpeedProblem,
)
from controller.verification import certifies_infeasibility, refine

MODEL, PARAMETERS = LongitudinalModel(), MpcParameters()
LIMIT = PARAMETERS.iteration_limit
BOX = (PARAMETERS.speed_min - 1.0, PARAMETERS.speed_max + 1.0)


@pytest.fixture
def problems(draw):
    """Yields (reference, speed problem with its bounds set), those that no single row refutes."""

    def some(count, seed):
        generator, speeds = np.random.default_rng(seed), SpeedProblem(MODEL, PARAMETERS)
        while count > 0:
            reference = draw(generator, MODEL, PARAMETERS)
            code = speeds.update(
                reference.position,
                reference.speed,
                reference.previous_force,
                reference.obstacle_positions,
            )
            if code in (UNDECIDED, CANNOT_STOP, CANNOT_HOLD_SPEED):
                count -= 1
                yield reference, speeds

    return some


def bounds(problem):
    return problem.rows, problem.lower, problem.upper, problem.target


def optimum(problem):
    """Speeds and multipliers by the dual method; None where it finds no plan."""
    speeds, multipliers = np.empty(15), np.zeros(56)
    if solve_exactly(*bounds(problem), multipliers, speeds) < 0:
        return None
    return speeds, multipliers


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


def test_the_dual_method_says_infeasible_exactly_where_the_lp_does(problems, edge):
    said = {True: 0, False: 0}
    for reference, problem in problems(400, seed=2):
        found = optimum(problem) is not None
        margin = reference.margin()
        if abs(margin) > edge:
            assert found is (margin > 0.0), reference
        said[found] += 1
    assert min(said.values()) > 15


def test_refinement_repairs_a_wrong_active_set_or_declines(problems):
    generator, tried, repaired = np.random.default_rng(0), 0, 0
    for _, problem in problems(300, seed=3):
        found = optimum(problem)
        if found is None:
            continue
        tried += 1
        V, y = found
        guess = y * generator.uniform(0.5, 1.5, size=len(y))
        guess[generator.integers(len(y), size=2)] = generator.normal(size=2)
        solution = np.empty_like(V)
        if refine(*bounds(problem), guess, solution) >= 0:
            np.testing.assert_allclose(solution, V, atol=1e-9)
            repaired += 1
    assert repaired > 0.8 * tried > 100


def test_refinement_of_garbage_is_right_or_declined(problems):
    generator = np.random.default_rng(0)
    for _, problem in problems(300, seed=4):
        found = optimum(problem)
        solution = np.empty(15)
        garbage = generator.normal(size=56) * 10.0 ** generator.integers(-9, 9)
        if refine(*bounds(problem), garbage, solution) >= 0:
            assert found is not None
            np.testing.assert_allclose(solution, found[0], atol=1e-9)


def test_a_certificate_never_refutes_what_is_feasible(problems):
    """Certificates of infeasible problems, and any other vector, against feasible bounds."""
    generator = np.random.default_rng(0)
    vectors = [generator.normal(size=56) for _ in range(5)]
    certified = 0
    for _, problem in problems(400, seed=5):
        y = np.zeros(56)
        if solve_exactly(*bounds(problem), y, np.empty(15)) == INFEASIBLE:
            assert certifies_infeasibility(*bounds(problem)[:3], *BOX, y)
            certified += 1
            vectors.append(y)
            continue
        for vector in vectors:
            assert not certifies_infeasibility(*bounds(problem)[:3], *BOX, vector)
    assert certified > 15


@pytest.mark.parametrize("junk", [0.0, np.nan, np.inf])
def test_junk_is_no_certificate(junk, problems):
    for _, problem in problems(1, seed=6):
        assert not certifies_infeasibility(*bounds(problem)[:3], *BOX, np.full(56, junk))


@pytest.mark.parametrize("backend", [OsqpBackend, DaqpBackend])
def test_a_cold_solver_and_the_refinement_agree_with_the_dual_method(backend, problems):
    """So the two ways to a plan, from the exact start and from nothing, lead to the same."""
    feasible, agreed = 0, 0
    for _, problem in problems(150, seed=7):
        speeds, multipliers = np.zeros(15), np.zeros(56)
        outcome, iterations = backend(problem, LIMIT).solve(speeds, multipliers)
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
def test_an_interrupt_in_the_solver_reaches_its_handler_and_the_solve_ends_well(problems):
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
