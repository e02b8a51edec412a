"""The sub-forces: golden values, and the kernel against the independent reference."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from crowd_forces import forces_apart

from pedestrian_model import SIM, TABLE2, Crowd, CrowdModel, Vehicles


@pytest.mark.parametrize("parameters", [SIM, TABLE2, replace(SIM, navigation_anisotropy=2.7)])
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("cell_list_from", [0, 1000])
def test_every_sub_force_agrees_with_the_reference(
    reference, random_crowd, random_vehicles, parameters, seed, cell_list_from
):
    crowd, vehicles = random_crowd(41, seed, density=0.3), random_vehicles(seed)
    forces = forces_apart(CrowdModel(parameters, cell_list_from=cell_list_from), crowd, vehicles)
    expected = reference.forces(
        parameters,
        crowd.position,
        crowd.velocity,
        crowd.desired_speed,
        forces.target,
        vehicles.array,
    )
    names = ("repulsion", "collision", "navigation", "vehicle", "destination", "beta")
    for name, values in zip(names, expected, strict=True):
        np.testing.assert_allclose(
            getattr(forces, name), values, rtol=1e-9, atol=1e-8, err_msg=name
        )


@pytest.mark.parametrize("seed", range(4))
def test_a_step_agrees_with_the_reference(reference, random_crowd, random_vehicles, seed):
    crowd, vehicles = random_crowd(30, seed), random_vehicles(seed + 100)
    model = CrowdModel()
    after = model.step(crowd, vehicles)
    x, v = reference.step(
        SIM,
        crowd.position,
        crowd.velocity,
        crowd.desired_speed,
        forces_apart(model, crowd, vehicles).target,
        vehicles.array,
        0.05,
    )
    np.testing.assert_allclose(after.position, x, rtol=0.0, atol=1e-11)
    np.testing.assert_allclose(after.velocity, v, rtol=0.0, atol=1e-10)


@pytest.mark.parametrize("n", [1, 2, 7, 8, 9, 15, 16, 17, 24, 33])
def test_no_size_of_crowd_loses_a_pair(reference, random_crowd, n):
    crowd = random_crowd(n, seed=n)
    forces = forces_apart(CrowdModel(), crowd, Vehicles.empty())
    for i in range(n):
        expected = sum(
            reference.pair(
                SIM, crowd.position[i], crowd.velocity[i], crowd.position[j], crowd.velocity[j]
            )[0]
            for j in range(n)
            if j != i
        )
        np.testing.assert_allclose(
            forces.repulsion[i], expected if n > 1 else 0.0, rtol=1e-9, atol=1e-9
        )


def test_beta_removes_the_destination_force_near_a_vehicle():
    car = Vehicles.create(0.0, 0.0, 0.0, 0.0)
    y = np.array([1.3, 1.7, 2.4, 9.0])
    crowd = Crowd.create(
        np.stack([np.zeros(4), y], axis=1), np.zeros((4, 2)), 1.4, [[(0.0, 20.0)]] * 4
    )
    beta = forces_apart(CrowdModel(), crowd, car).beta
    assert beta[0] == 0.0
    assert 0.0 < beta[1] < beta[2] <= 1.0
    assert beta[3] == 1.0


def test_the_total_is_the_sum_of_the_equation_of_motion(random_crowd, random_vehicles):
    f = forces_apart(CrowdModel(), random_crowd(20, 0), random_vehicles(1))
    total = f.repulsion + f.collision + f.navigation + f.vehicle + f.beta[:, None] * f.destination
    np.testing.assert_allclose(f.total, total, rtol=1e-15)


def test_more_candidates_than_the_buffer_holds(reference):
    """A crush of 1,500 on 8 m x 8 m: everyone feels nearly everyone."""
    rng = np.random.default_rng(8)
    crowd = Crowd.create(
        rng.uniform(0.0, 8.0, (1500, 2)),
        rng.normal(0.0, 1.0, (1500, 2)),
        1.0,
        [[(0.0, 0.0)]] * 1500,
    )
    forces = forces_apart(CrowdModel(), crowd, Vehicles.empty())
    for i in (0, 700, 1499):
        sums = np.zeros((3, 2))
        for j in range(1500):
            if j != i:
                sums += reference.pair(
                    SIM, crowd.position[i], crowd.velocity[i], crowd.position[j], crowd.velocity[j]
                )
        for name, expected in zip(("repulsion", "collision", "navigation"), sums, strict=True):
            np.testing.assert_allclose(getattr(forces, name)[i], expected, rtol=1e-9, atol=1e-6)


@pytest.mark.parametrize("stray", [(1e8, -1e8), (400.0, 0.0), (0.0, 1e5)])
def test_a_stray_pedestrian_far_away_changes_nothing(random_crowd, stray):
    crowd = random_crowd(150, 3)
    one = Crowd.create([stray], [(0.0, 0.0)], 1.0, [[stray]])
    model = CrowdModel(cell_list_from=0)
    alone = forces_apart(model, crowd, Vehicles.empty()).total
    together = forces_apart(model, crowd.concatenate(one), Vehicles.empty()).total
    np.testing.assert_allclose(together[:150], alone, rtol=1e-9, atol=1e-8)
    np.testing.assert_array_equal(together[150], 0.0)
