"""The problem in speeds is the paper's problem in forces, row by row and proof by proof."""

from __future__ import annotations

import numpy as np
import pytest
from paper_qp import prediction_matrices, quadratic_program

from controller import LongitudinalModel, MpcParameters
from controller.paper_mpc.mpc import check_plan
from controller.paper_mpc.speed_problem import (
    CANNOT_HOLD_SPEED,
    SLACK,
    SPEED_BOUNDS_CROSS,
    UNDECIDED,
    SpeedProblem,
)


@pytest.mark.parametrize("horizon", [2, 3, 5, 15])
@pytest.mark.parametrize(
    "model", [LongitudinalModel(), LongitudinalModel(300.0, 3000.0, 0.1)], ids=["paper", "decay 0"]
)
def test_plans_are_feasible_in_speeds_if_and_only_if_in_forces(horizon, model):
    parameters = MpcParameters(
        horizon=horizon, force_limit=8.0 * model.mass, force_rate_limit=2.0 * model.mass
    )
    problem, generator = SpeedProblem(model, parameters), np.random.default_rng(horizon)
    S_x, S_u = prediction_matrices(model, horizon)
    assert problem.rows.shape == (4 * horizon - 4, horizon)
    seen = set()
    for _ in range(1500):
        speed = generator.uniform(0.0, 4.0)
        previous = model.mass * generator.uniform(-1.0, 1.0)
        U = previous + np.cumsum(generator.uniform(-1.05, 1.05, horizon)) * 2.0 * model.mass
        x_p = 8.0 + np.full(horizon, generator.uniform(0.0, 3.0) * horizon * model.time_step * 2)
        qp = quadratic_program(model, parameters, np.array([0.0, speed]), previous, x_p)
        V = S_x[1::2] @ [0.0, speed] + S_u[1::2] @ U
        code = problem.update(0.0, speed, previous, x_p)
        values = problem.rows @ V
        within = code == UNDECIDED and bool(
            (values <= problem.upper).all() and (values >= problem.lower).all()
        )
        violation = qp.violation(U)
        if not 0.0 < violation < 1e-6:
            assert within is (violation == 0.0)
        seen.add(within)
    assert seen == {True, False}


def test_cost_is_the_papers_up_to_a_constant():
    model, parameters = LongitudinalModel(), MpcParameters()
    problem, generator = SpeedProblem(model, parameters), np.random.default_rng(0)
    x_k, (S_x, S_u) = np.array([3.0, 2.0]), prediction_matrices(model, 15)
    qp = quadratic_program(model, parameters, x_k, 0.0, np.full(15, np.inf))
    differences = []
    for _ in range(5):
        U = generator.uniform(-8000.0, 8000.0, 15)
        V = S_x[1::2] @ x_k + S_u[1::2] @ U
        differences.append(((V - problem.target) ** 2).sum() - (0.5 * U @ qp.P @ U + qp.q @ U))
    np.testing.assert_allclose(differences, differences[0], rtol=1e-9)


def test_no_proof_refuses_a_plan_that_only_just_stops():
    """A plan at all its widened bounds: the hardest braking, 1e-9 m/s beyond the limits."""
    model, parameters = LongitudinalModel(), MpcParameters()
    problem = SpeedProblem(model, parameters)
    speed, previous = 4.0, 400.0
    per_step, changes = model.speed_per_force * previous, []
    for _ in range(15):
        per_step = max(per_step - 0.05 - SLACK, -0.4 - SLACK)
        changes.append(per_step)
    speeds, v = [], speed
    for change in changes:
        v = max(0.0, model.decay * v + change)
        speeds.append(v)
    positions = np.concatenate([[0.2], 0.2 + 0.05 * np.cumsum(speeds[:-1])])
    for i in range(2, 15):
        x_p = np.full(15, np.inf)
        x_p[i] = 8.0 + positions[i]
        assert problem.update(0.0, speed, previous, x_p) == UNDECIDED
        x_p[i] -= 1e-7
        assert problem.update(0.0, speed, previous, x_p) != UNDECIDED


@pytest.mark.parametrize("rate", [800.0, 3000.0])  # of the forces: within c2 and c3, and beyond
@pytest.mark.parametrize("counted", [0, 1, 2])
def test_a_plan_is_judged_by_its_worst_violation_over_tolerance(counted, rate):
    """Positions, speeds, forces: each in turn, the tolerances of the other two out of reach."""
    model, parameters = LongitudinalModel(), MpcParameters(horizon=5)
    limits = SpeedProblem(model, parameters).limits
    tolerances = np.full(3, 1e15)
    tolerances[counted] = (1e-6, 1e-6, 1e-2)[counted]
    generator, violated = np.random.default_rng(2), 0
    S_x, S_u = prediction_matrices(model, 5)
    for _ in range(300):
        speed, previous = generator.uniform(0.0, 20.0), generator.uniform(-8000.0, 8000.0)
        U = previous + np.cumsum(generator.uniform(-rate, rate, 5))
        x_p = generator.uniform(5.0, 15.0, 5)
        qp = quadratic_program(model, parameters, np.array([0.0, speed]), previous, x_p)
        V = S_x[1::2] @ [0.0, speed] + S_u[1::2] @ U
        excess = np.maximum(qp.lower - qp.G @ U, qp.G @ U - qp.upper)
        expected = (excess / np.repeat(tolerances[[2, 2, 1, 0]], 5)).max()
        forces = np.empty(5)
        residual = check_plan((0.0, speed, previous), x_p, V, forces, limits, tolerances)
        np.testing.assert_allclose(forces, U, rtol=1e-9, atol=1e-6)
        assert residual == pytest.approx(max(0.0, expected), rel=1e-6, abs=1e-3)
        violated += residual > 1.0
    assert 5 < violated <= 300


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_plan_that_is_no_number_is_never_accepted(value):
    limits = SpeedProblem(LongitudinalModel(), MpcParameters(horizon=2)).limits
    x_p, V = np.full(2, np.inf), np.array([4.0, value])
    assert check_plan((0.0, 4.0, 400.0), x_p, V, np.empty(2), limits, np.ones(3)) == np.inf


@pytest.mark.parametrize(
    ("previous", "proof"), [(-1200.0, SPEED_BOUNDS_CROSS), (-5500.0, CANNOT_HOLD_SPEED)]
)
def test_the_violation_of_an_accepted_plan_is_no_proof(previous, proof):
    """The brake is released at full rate, and the lowest speed is close to v_min."""
    model, parameters = LongitudinalModel(), MpcParameters()
    problem = SpeedProblem(model, parameters)

    def code(lowest_speed: float) -> int:
        speed = lowest_speed
        for force in np.arange(previous, 0.0, parameters.force_rate_limit)[:0:-1]:
            speed = (speed - model.speed_per_force * force) / model.decay
        return problem.update(0.0, speed, previous, np.full(15, np.inf))

    assert code(-0.5 * parameters.speed_tolerance) == UNDECIDED
    assert code(-2.0 * parameters.speed_tolerance) == proof
