"""Prediction by any model is that model, N times; constant velocity has a compiled one, too."""

from __future__ import annotations

import numpy as np
import pytest
from crowd_forces import constant_speed

from pedestrian_model import (
    PLAIN_MODELS,
    SIM,
    Crowd,
    CrowdModel,
    ParameterError,
    PlainModel,
    Predictor,
    StepwisePredictor,
    Surroundings,
    Vehicles,
    Walls,
    unmoved,
)

DT, N = 0.05, 15
WALLED = Surroundings(Walls.create([[-20.0, -3.0, 20.0, -3.0]]), np.array([True]))


@pytest.mark.parametrize("name", PLAIN_MODELS)
@pytest.mark.parametrize("n", [0, 1, 30])
def test_prediction_is_stepping_bit_by_bit(random_crowd, random_vehicles, name, n):
    crowd, poses = random_crowd(n, n), constant_speed(random_vehicles(n), DT, N)
    before = crowd.position.tobytes() + crowd.velocity.tobytes() + crowd.waypoint_index.tobytes()
    predicted = StepwisePredictor(PlainModel(name), N).predict(crowd, poses)
    after = crowd.position.tobytes() + crowd.velocity.tobytes() + crowd.waypoint_index.tobytes()
    assert after == before
    assert predicted.shape == (N, n, 2)
    now, model = crowd.copy(), PlainModel(name)
    for k in range(N):
        model.advance(now, Vehicles(poses[k].copy()))
        np.testing.assert_array_equal(predicted[k], now.position)


def test_by_vci_it_is_what_the_compiled_prediction_is(random_crowd, random_vehicles):
    crowd, poses = random_crowd(30, 4), constant_speed(random_vehicles(4), DT, N)
    compiled, asked = Predictor(horizon=N), StepwisePredictor(CrowdModel(), N)
    np.testing.assert_array_equal(compiled.predict(crowd, poses), asked.predict(crowd, poses))
    np.testing.assert_array_equal(
        compiled.desired_velocities(crowd), asked.desired_velocities(crowd)
    )


def passers(n=12, seed=3):
    """People who wait, walk and arrive, beside a wall and about a car, one before a red light."""
    g = np.random.default_rng(seed)
    place, to = g.uniform(-6.0, 6.0, (2, n, 2))
    ways = [np.stack([half, end]) for half, end in zip((place + to) / 2.0, to, strict=True)]
    light = [np.array([0 if i == 2 else -1, -1]) for i in range(n)]
    walking = g.normal(0.0, 0.8, (n, 2))
    return Crowd.create(place, walking, g.uniform(0.8, 1.7, n), ways, signals=light)


@pytest.mark.parametrize(("step", "off"), [(DT, 1e-9), (0.1, 0.02)])
def test_constant_velocity_is_vci_of_people_whom_nothing_moves(step, off):
    crowd, horizon = passers(), round(3.0 / step)
    poses = constant_speed(Vehicles.create([-8.0], [0.0], [0.0], [4.0]), step, horizon)
    compiled = Predictor(unmoved(SIM), step, horizon, detour=False, longest_step=step)
    asked = StepwisePredictor(PlainModel("constant-velocity", SIM, step), horizon)
    one, other = compiled.predict(crowd, poses, WALLED), asked.predict(crowd, poses, WALLED)
    np.testing.assert_allclose(one, other, rtol=0.0, atol=off)
    np.testing.assert_allclose(
        compiled.desired_velocities(crowd, WALLED),
        asked.desired_velocities(crowd, WALLED),
        atol=0.1,
    )


class Counting:
    """A model that remembers how often it was asked, and pushes people the more."""

    parameters, time_step = SIM, DT

    def __init__(self):
        self.asked = 0

    def reset(self):
        self.asked = 0

    def advance(self, crowd, vehicles, surroundings=None):
        self.asked += 1
        crowd.position[:] += self.asked


def test_a_model_that_remembers_begins_anew_each_time(random_crowd):
    crowd, predictor = random_crowd(3, 1), StepwisePredictor(Counting(), 4)
    poses = np.zeros((4, 0, 7))
    first = predictor.predict(crowd, poses)
    np.testing.assert_array_equal(first[-1], crowd.position + 10.0)
    np.testing.assert_array_equal(predictor.predict(crowd, poses), first)


def test_a_horizon_is_asked_for():
    with pytest.raises(ParameterError, match="horizon = 0 steps"):
        StepwisePredictor(PlainModel("orca"), 0)
