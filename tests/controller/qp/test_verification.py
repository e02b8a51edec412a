"""Refinement to the verified optimum, and certificates of infeasibility."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from least_squares_cases import BOX, assert_optimal, bounds, optimum, small_problems

from controller import MpcParameters
from controller._jit import kernel
from controller.qp.active_set import INFEASIBLE, solve_exactly
from controller.qp.verification import (
    certifies_infeasibility,
    largest_outside,
    largest_size,
    refine,
)

solve_exactly = kernel(solve_exactly)
refine = kernel(refine)

PARAMETERS = MpcParameters()
SPEEDS = (PARAMETERS.speed_min - 1.0, PARAMETERS.speed_max + 1.0)  # [m/s] that are possible


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
            assert certifies_infeasibility(*bounds(problem)[:3], *SPEEDS, y)
            certified += 1
            vectors.append(y)
            continue
        for vector in vectors:
            assert not certifies_infeasibility(*bounds(problem)[:3], *SPEEDS, vector)
    assert certified > 15


@pytest.mark.parametrize("junk", [0.0, np.nan, np.inf])
def test_junk_is_no_certificate(junk, problems):
    for _, problem in problems(1, seed=6):
        assert not certifies_infeasibility(*bounds(problem)[:3], *SPEEDS, np.full(56, junk))


@settings(max_examples=300)
@given(
    problem=small_problems(feasible=True), seed=st.integers(0, 2**16), noise=st.floats(0.0, 1e-3)
)
def test_what_refine_verifies_is_the_optimum_from_any_start(problem, seed, noise):
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


@settings(max_examples=200)
@given(problem=small_problems(feasible=True), seed=st.integers(0, 2**16))
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


def test_the_largest_of_some_values():
    values = np.array([1.0, -3.0, 2.0, 0.0])
    assert largest_size(values) == 3.0
    assert np.isnan(largest_size(np.array([1.0, np.nan, 2.0])))
    assert largest_outside(values, np.zeros(4, dtype=np.int64)) == 1
    assert largest_outside(values, np.array([0, -1, 0, 0])) == 2
    assert largest_outside(values, np.array([1, -1, 1, 0])) == -1
