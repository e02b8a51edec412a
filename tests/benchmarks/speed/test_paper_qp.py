"""The paper's QP against scalar inequalities and a scalar cost, written out one by one."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from paper_qp import prediction_matrices, quadratic_program, state_matrices

from controller import LongitudinalModel, MpcParameters

N = 6
PARAMETERS = MpcParameters(
    horizon=N,
    reference_speed=3.0,
    safe_distance=7.0,
    speed_min=0.5,
    speed_max=11.0,
    force_limit=5000.0,
    force_rate_limit=700.0,
    speed_weight=2.5,
)
MODEL = LongitudinalModel(mass=1300.0, friction=80.0, time_step=0.04)


def trajectory(position, speed, forces):
    """x_1(k+1) ... x_1(k+N) and x_2(k+1) ... x_2(k+N)."""
    positions, speeds = [], []
    for u in forces:
        position += MODEL.time_step * speed
        speed += MODEL.time_step / MODEL.mass * (u - MODEL.friction * speed)
        positions.append(position)
        speeds.append(speed)
    return positions, speeds


@st.composite
def cases(draw):
    position = draw(st.floats(-50.0, 50.0))
    return (
        position,
        draw(st.floats(0.0, 12.0)),
        draw(st.floats(-5000.0, 5000.0)),
        position + np.array([draw(st.floats(5.0, 20.0)) for _ in range(N)]),
        np.array([draw(st.floats(-6000.0, 6000.0)) for _ in range(N)]),
    )


MODELS = st.builds(
    LongitudinalModel,
    mass=st.floats(200.0, 4e4),
    friction=st.floats(0.0, 2000.0),
    time_step=st.floats(0.001, 0.1),
)


def drive(model: LongitudinalModel, position: float, speed: float, forces):
    """Forward Euler of M s'' + alpha s' = u, one step after the other."""
    positions, speeds = [], []
    for u in forces:
        acceleration = (u - model.friction * speed) / model.mass
        position, speed = (
            position + model.time_step * speed,
            speed + model.time_step * acceleration,
        )
        positions.append(position)
        speeds.append(speed)
    return np.array(positions), np.array(speeds)


def test_matrices_of_the_paper():
    A, B = state_matrices(LongitudinalModel())
    np.testing.assert_allclose(A, [[1.0, 0.05], [0.0, 0.995]], rtol=1e-15)
    np.testing.assert_allclose(B, [[0.0], [5e-5]], rtol=1e-15)


@given(
    model=MODELS,
    horizon=st.sampled_from([2, 5, 15, 30]),
    position=st.floats(-100.0, 100.0),
    speed=st.floats(0.0, 20.0),
    seed=st.integers(0, 999),
)
def test_prediction_is_the_recursion(model, horizon, position, speed, seed):
    forces = np.random.default_rng(seed).uniform(-8000.0, 8000.0, horizon)
    S_x, S_u = prediction_matrices(model, horizon)
    X = S_x @ [position, speed] + S_u @ forces
    positions, speeds = drive(model, position, speed, forces)
    np.testing.assert_allclose(X[0::2], positions, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(X[1::2], speeds, rtol=1e-9, atol=1e-9)


@given(model=MODELS, horizon=st.sampled_from([2, 5, 15]))
def test_each_column_is_the_answer_to_one_impulse(model, horizon):
    S_x, S_u = prediction_matrices(model, horizon)
    assert S_x.shape == (2 * horizon, 2)
    assert S_u.shape == (2 * horizon, horizon)
    for j, impulse in enumerate(np.eye(horizon)):
        positions, speeds = drive(model, 0.0, 0.0, impulse)
        np.testing.assert_allclose(S_u[0::2, j], positions, rtol=1e-9, atol=1e-15)
        np.testing.assert_allclose(S_u[1::2, j], speeds, rtol=1e-9, atol=1e-15)


def test_no_force_moves_the_next_position():
    _, S_u = prediction_matrices(LongitudinalModel(), 15)
    assert not S_u[0].any()


@given(case=cases())
def test_every_row_is_one_inequality_of_the_paper(case):
    position, speed, previous, x_p, U = case
    qp = quadratic_program(MODEL, PARAMETERS, np.array([position, speed]), previous, x_p)
    positions, speeds = trajectory(position, speed, U)
    slack = []  # (to the lower bound, to the upper bound) of each row
    for u in U:  # c1
        slack.append((u + 5000.0, 5000.0 - u))
    for u, before in zip(U, [previous, *U[:-1]], strict=True):  # c2, c3
        slack.append((u - before + 700.0, 700.0 - (u - before)))
    for v in speeds:  # c5, c4
        slack.append((v - 0.5, 11.0 - v))
    for x, obstacle in zip(positions, x_p, strict=True):  # c6
        slack.append((np.inf, obstacle - x - 7.0))
    expected = np.array(slack)
    values = qp.G @ U
    np.testing.assert_allclose(values - qp.lower, expected[:, 0], rtol=1e-9, atol=1e-7)
    np.testing.assert_allclose(qp.upper - values, expected[:, 1], rtol=1e-9, atol=1e-7)
    assert qp.violation(U) == pytest.approx(max(0.0, -expected.min()), abs=1e-7)


@given(case=cases())
def test_cost_is_the_weighted_squared_speed_error_and_a_constant(case):
    position, speed, previous, x_p, U = case
    qp = quadratic_program(MODEL, PARAMETERS, np.array([position, speed]), previous, x_p)

    def cost(forces):
        return sum(2.5 * (v - 3.0) ** 2 for v in trajectory(position, speed, forces)[1])

    gain = 0.5 * U @ qp.P @ U + qp.q @ U
    assert gain == pytest.approx(cost(U) - cost(np.zeros(N)), rel=1e-8, abs=1e-8)


def test_an_absent_pedestrian_is_no_constraint():
    qp = quadratic_program(MODEL, PARAMETERS, np.zeros(2), 0.0, np.full(N, np.inf))
    assert np.isposinf(qp.upper[3 * N :]).all()
    assert np.isneginf(qp.lower[3 * N :]).all()


def test_cost_is_convex():
    qp = quadratic_program(MODEL, PARAMETERS, np.zeros(2), 0.0, np.full(N, np.inf))
    np.testing.assert_allclose(qp.P, qp.P.T, rtol=1e-14)
    assert np.linalg.eigvalsh(qp.P).min() > 0.0
