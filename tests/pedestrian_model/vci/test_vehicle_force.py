"""Many people and many cars: only those within reach are looked at, and nobody is overlooked."""

from __future__ import annotations

import numpy as np
import pytest
from crowd_forces import forces_apart, target_of
from hypothesis import given, settings
from hypothesis import strategies as st

from pedestrian_model import (
    SIM,
    Crowd,
    CrowdModel,
    DivergenceError,
    Vehicles,
    vehicle_influence,
)


def traffic(m, seed, side):
    """m vehicles anywhere about: forwards, in reverse, standing, of all sizes."""
    rng = np.random.default_rng(seed)
    return Vehicles.create(
        rng.uniform(-30.0, side + 30.0, m),
        rng.uniform(-30.0, side + 30.0, m),
        rng.uniform(-7.0, 7.0, m),
        np.array([14.0, 4.0, -1.5, 0.0, 0.1])[rng.integers(0, 5, m)],
        rng.uniform(0.0, 9.0, m),
        rng.uniform(0.5, 3.0, m),
        rng.uniform(0.5, 2.5, m),
    )


@settings(max_examples=15)
@given(seed=st.integers(0, 10**6))
def test_the_force_is_that_of_all_vehicles(random_crowd, seed):
    crowd, vehicles = random_crowd(300, seed, density=0.02), traffic(40, seed, side=120.0)
    near = forces_apart(CrowdModel(cell_list_from=0), crowd, vehicles).vehicle
    every, _ = vehicle_influence(crowd.position, crowd.velocity, vehicles)
    np.testing.assert_allclose(near, every, rtol=1e-12, atol=40 * 1e-9)


def test_the_long_nose_of_a_fast_car_reaches_far(random_crowd):
    ahead = 2.5 + 1.394358 * 14.0
    crowd = random_crowd(120, 0)
    crowd.position[0] = 500.0 + ahead + 5.0, 500.0
    cars = Vehicles.create(500.0, 500.0, 0.0, np.array([14.0, 0.0, 0.0, 0.0, 0.0]))
    assert forces_apart(CrowdModel(), crowd, cars).vehicle[0, 0] > 1e-3
    backwards = Vehicles.create(500.0, 500.0, np.pi, np.array([-14.0, 0.0, 0.0, 0.0, 0.0]))
    np.testing.assert_allclose(
        forces_apart(CrowdModel(), crowd, backwards).vehicle[0],
        forces_apart(CrowdModel(), crowd, cars).vehicle[0],
        rtol=1e-6,
        atol=1e-9,
    )


def test_between_steps_vehicles_drive_on_towards_people(random_crowd):
    """A car that drives 3 m in a step of 0.2 s is felt where it is in each sub-step."""
    crowd, cars = random_crowd(200, 4, density=0.1), traffic(12, 4, side=45.0)
    cells, ring = (
        CrowdModel(SIM, 0.2, cell_list_from=limit).step(crowd, cars) for limit in (0, 1000)
    )
    np.testing.assert_allclose(cells.position, ring.position, rtol=0.0, atol=1e-9)


@pytest.mark.parametrize("cell_list_from", [0, 1000])
def test_everybody_sees_the_first_standing_car_in_the_way(random_crowd, cell_list_from):
    """All at once or one by one, in any order of the cars: the same targets."""
    crowd, cars = random_crowd(150, 7, density=0.2), traffic(30, 7, side=27.0)
    model = CrowdModel(cell_list_from=cell_list_from)
    target = forces_apart(model, crowd, cars).target
    assert (target != target_of(crowd)).any(axis=1).sum() > 20
    for i in range(0, 150, 7):
        one = crowd.select(np.arange(150) == i)
        np.testing.assert_array_equal(forces_apart(model, one, cars).target[0], target[i])


def test_a_vehicle_that_is_not_finite_is_named_among_many(random_crowd):
    for column in (0, 1, 2, 3, 4, 6):  # x, y, heading, speed, front, width
        cars = traffic(9, 0, side=10.0)
        cars.array[4, :4] = 2.0, 5.0, 0.0, 4.0  # forwards, people ahead: its rear does not matter
        cars.array[4, column] = np.nan
        with pytest.raises(DivergenceError, match="vehicle 4, column"):
            CrowdModel(cell_list_from=0).step(random_crowd(50, 0), cars)


def test_a_vehicle_at_the_end_of_the_world_is_out_of_reach(random_crowd):
    crowd = random_crowd(50, 0)
    far = Vehicles.create([1e9, -1e9, 1e9, 0.0, 1e6], [0.0, 0.0, -1e9, 1e9, 1e6], 0.5, 30.0)
    forces = forces_apart(CrowdModel(cell_list_from=0), crowd, far)
    np.testing.assert_array_equal(forces.vehicle, 0.0)
    assert isinstance(CrowdModel(cell_list_from=0).step(crowd, far), Crowd)
