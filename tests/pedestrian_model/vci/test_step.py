"""A step: limits, sub-steps, way-points, determinism, in place or not, and bad states."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from crowd_forces import forces_apart
from hypothesis import given, settings
from hypothesis import strategies as st

from pedestrian_model import (
    SIM,
    Crowd,
    CrowdModel,
    DivergenceError,
    ParameterError,
    Predictor,
    Vehicles,
    arrived,
)

NOBODY = Vehicles.empty()


def bytes_of(crowd):
    return crowd.position.tobytes() + crowd.velocity.tobytes() + crowd.waypoint_index.tobytes()


@settings(max_examples=40)
@given(st.integers(0, 10**6))
def test_acceleration_and_speed_keep_their_limits(random_crowd, random_vehicles, seed):
    crowd, vehicles = random_crowd(30, seed, density=2.0), random_vehicles(seed)
    slow_enough = replace(SIM, max_speed=6.0)  # above any initial speed
    after = CrowdModel(slow_enough).step(crowd, vehicles)
    change = np.hypot(*(after.velocity - crowd.velocity).T) / 0.05
    assert (change <= 5.0 + 1e-9).all()
    after = CrowdModel().step(crowd, vehicles)
    assert (np.hypot(*after.velocity.T) <= 2.5 + 1e-12).all()


def test_a_step_is_exact_under_constant_force():
    """x += v dt + F/(2m) dt^2, v += F/m dt, with F limited to m a_max."""
    one = Crowd.create([(0.0, 0.0)], [(-1.0, 0.0)], 1.4, [[(100.0, 0.0)]])
    after = CrowdModel(time_step=0.02).step(one, NOBODY)
    assert after.velocity[0, 0] == pytest.approx(-1.0 + 5.0 * 0.02, rel=1e-14)
    assert after.position[0, 0] == pytest.approx(-0.02 + 2.5 * 0.02**2, rel=1e-14)


def test_a_free_walker_reaches_desired_speed_and_destination(walkers):
    crowd = walkers([(0.0, 0.0)], [(30.0, 0.0)], speed=1.3, walking=False)
    model = CrowdModel()
    speeds = []
    for _ in range(1000):
        crowd = model.step(crowd, NOBODY)
        speeds.append(np.hypot(*crowd.velocity[0]))
    assert max(speeds) == pytest.approx(1.3, rel=2e-3)
    np.testing.assert_allclose(crowd.position[0], (30.0, 0.0), atol=1e-3)
    assert speeds[-1] < 1e-3


def test_the_same_state_gives_the_same_bytes(random_crowd, random_vehicles):
    crowd, vehicles = random_crowd(400, 5), random_vehicles(5, side=28.0)
    one, other = CrowdModel(), CrowdModel()
    other.step(random_crowd(700, 6), vehicles)  # a workspace with a past
    a = b = crowd
    for _ in range(20):
        a, b = one.step(a, vehicles), other.step(b, vehicles)
    assert bytes_of(a) == bytes_of(b)


def test_step_leaves_the_old_state_and_advance_replaces_it(random_crowd, random_vehicles):
    crowd, vehicles = random_crowd(30, 1), random_vehicles(1)
    before = bytes_of(crowd)
    model = CrowdModel(time_step=0.3)
    after = model.step(crowd, vehicles)
    assert bytes_of(crowd) == before
    model.advance(crowd, vehicles)
    assert bytes_of(crowd) == bytes_of(after) != before


@pytest.mark.parametrize("time_step", [0.1, 0.12, 1.0])
def test_a_long_step_is_short_steps_with_the_vehicle_driving_on(random_crowd, time_step):
    crowd = random_crowd(30, 2)
    car = Vehicles.create(-2.0, 4.0, 0.4, 3.0)
    long = CrowdModel(time_step=time_step).step(crowd, car)
    count = int(np.ceil(time_step / 0.05 - 1e-9))
    dt = time_step / count
    model = CrowdModel(time_step=dt)
    for k in range(count):
        at = np.array([-2.0, 4.0]) + k * dt * 3.0 * np.array([np.cos(0.4), np.sin(0.4)])
        crowd = model.step(crowd, Vehicles.create(at[0], at[1], 0.4, 3.0))
    np.testing.assert_allclose(long.position, crowd.position, rtol=0.0, atol=1e-9)


def test_waypoints_are_passed_in_order_but_never_the_last():
    route = np.array([(3.0, 0.0), (3.0, 4.0), (8.0, 4.0)])
    crowd = Crowd.create([(0.0, 0.0)], [(1.0, 0.0)], 1.3, [route])
    model = CrowdModel()
    closest, indices = np.full(3, np.inf), []
    for _ in range(600):
        crowd = model.step(crowd, NOBODY)
        closest = np.minimum(closest, np.linalg.norm(route - crowd.position, axis=1))
        indices.append(int(crowd.waypoint_index[0]))
        assert not arrived(crowd, 0.2)[0] or crowd.waypoint_index[0] == 2
    assert indices == sorted(indices)
    assert set(indices) == {0, 1, 2}
    assert (closest <= 0.5).all()
    assert arrived(crowd, 0.2)[0]


def test_waypoints_within_reach_are_passed_together():
    near = [(0.1, 0.0), (0.2, 0.0), (0.3, 0.1), (5.0, 0.0)]
    crowd = Crowd.create([(0.0, 0.0)], [(0.0, 0.0)], 1.0, [near])
    assert CrowdModel().step(crowd, NOBODY).waypoint_index[0] == 3
    strict = CrowdModel(replace(SIM, waypoint_radius=0.15))
    assert strict.step(crowd, NOBODY).waypoint_index[0] == 1


def test_an_empty_crowd_stays_empty():
    assert len(CrowdModel().step(Crowd.empty(), Vehicles.create(0.0, 0.0, 0.0, 1.0))) == 0
    assert len(forces_apart(CrowdModel(), Crowd.empty(), NOBODY).total) == 0


@pytest.mark.parametrize("cell_list_from", [0, 1000])
@pytest.mark.parametrize("value", [np.nan, np.inf, 1e200])
def test_a_state_that_is_not_finite_is_named(random_crowd, cell_list_from, value):
    crowd = random_crowd(20, 0)
    crowd.velocity[7, 1] = value
    model = CrowdModel(cell_list_from=cell_list_from)
    with pytest.raises(DivergenceError, match="pedestrian 7"):
        model.step(crowd, NOBODY)
    with pytest.raises(DivergenceError, match="pedestrian 7"):
        forces_apart(model, crowd, NOBODY)


def test_a_vehicle_that_is_not_finite_is_named(random_crowd):
    car = Vehicles.create([0.0, 9.0], 0.0, 0.0, 1.0)
    car.array[1, 3] = np.nan
    with pytest.raises(DivergenceError, match="vehicle 1, column speed"):
        CrowdModel().step(random_crowd(5, 0), car)


@pytest.mark.parametrize("time_step", [0.0, -0.05, np.nan, np.inf])
def test_the_time_step_is_checked(time_step):
    with pytest.raises(ParameterError, match="time_step"):
        CrowdModel(time_step=time_step)


@pytest.mark.parametrize("gain_by_step", [0.99, 1.01, 1.9, 3.4])
def test_a_step_that_makes_speeds_swing_is_refused_and_no_other(gain_by_step):
    """The limit is where the error of the speed changes its sign from step to step."""
    dt = 0.05
    parameters = replace(SIM, destination_gain=gain_by_step * SIM.mass / dt)
    factor = 1.0 - gain_by_step
    if factor < 0.0:
        for kind in (CrowdModel, Predictor):
            with pytest.raises(ParameterError, match=r"destination_gain = .* swing .* 1600 N s/m"):
                kind(parameters, dt)
        CrowdModel(parameters, dt * 0.9 / gain_by_step)  # a finer step will do
        return
    crowd = Crowd.create([(0.0, 0.0)], [(0.0, 0.0)], 1.3, [[(1e6, 0.0)]])
    model, short = CrowdModel(parameters, dt), []
    for _ in range(40):
        model.advance(crowd, Vehicles.empty())
        short.append(1.3 - crowd.velocity[0, 0])
    assert min(short) > -1e-9


def test_a_destination_too_sharp_for_the_step_is_refused():
    with pytest.raises(ParameterError, match=r"= 0\.05 m: .* more than v_max dt/2 = 0\.06"):
        CrowdModel(replace(SIM, destination_smoothing=0.05))
