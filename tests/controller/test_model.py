"""The model's matrices against the recursion they abbreviate."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from controller import LongitudinalModel, ParameterError

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
    model = LongitudinalModel()
    np.testing.assert_allclose(model.A, [[1.0, 0.05], [0.0, 0.995]], rtol=1e-15)
    np.testing.assert_allclose(model.B, [[0.0], [5e-5]], rtol=1e-15)


@given(
    model=MODELS,
    horizon=st.sampled_from([2, 5, 15, 30]),
    position=st.floats(-100.0, 100.0),
    speed=st.floats(0.0, 20.0),
    seed=st.integers(0, 999),
)
def test_prediction_is_the_recursion(model, horizon, position, speed, seed):
    forces = np.random.default_rng(seed).uniform(-8000.0, 8000.0, horizon)
    X = model.S_x(horizon) @ [position, speed] + model.S_u(horizon) @ forces
    positions, speeds = drive(model, position, speed, forces)
    np.testing.assert_allclose(X[0::2], positions, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(X[1::2], speeds, rtol=1e-9, atol=1e-9)


@given(model=MODELS, horizon=st.sampled_from([2, 5, 15]))
def test_each_column_is_the_answer_to_one_impulse(model, horizon):
    S_x, S_u = model.S_x(horizon), model.S_u(horizon)
    assert S_x.shape == (2 * horizon, 2)
    assert S_u.shape == (2 * horizon, horizon)
    for j, impulse in enumerate(np.eye(horizon)):
        positions, speeds = drive(model, 0.0, 0.0, impulse)
        np.testing.assert_allclose(S_u[0::2, j], positions, rtol=1e-9, atol=1e-15)
        np.testing.assert_allclose(S_u[1::2, j], speeds, rtol=1e-9, atol=1e-15)


def test_no_force_moves_the_next_position():
    assert not LongitudinalModel().S_u(15)[0].any()


@pytest.mark.parametrize(
    ("name", "value"),
    [("mass", 0.0), ("mass", np.nan), ("friction", -1.0), ("time_step", np.inf)],
)
def test_refuses_what_is_no_vehicle(name, value):
    with pytest.raises(ParameterError, match=rf"{name} = .*expected.*\["):
        LongitudinalModel(**{name: value})
