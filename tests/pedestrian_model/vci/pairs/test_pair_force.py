"""Forces between two pedestrians."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from crowd_forces import forces_apart

from pedestrian_model import SIM, Crowd, CrowdModel, Vehicles


def decay(parameters, distance, kind):
    """|f_r| or |f_n| at a skin-to-skin distance, with every anisotropy equal to one."""
    only = replace(
        parameters,
        repulsion_anisotropy=1.0,
        navigation_anisotropy=0.0,
        collision_stiffness=0.0,
    )
    apart = distance + 2.0 * parameters.body_radius
    two = Crowd.create(
        [(0.0, 0.0), (apart, 0.0)], [(0.0, 1.0), (0.0, 0.0)], 1.4, [[(9.0, 9.0)], [(9.0, 9.0)]]
    )
    return np.hypot(*getattr(forces_apart(CrowdModel(only), two, Vehicles.empty()), kind)[0])


@pytest.mark.parametrize(
    ("kind", "distance", "size"),
    [
        ("repulsion", 0.0, 325.219),
        ("repulsion", 1.0, 55.895),
        ("navigation", 0.0, 417.844),
        ("navigation", 2.0, 22.607),
    ],
)
def test_golden_values_of_the_smoothed_linear_decay(kind, distance, size):
    assert decay(SIM, distance, kind) == pytest.approx(size, abs=6e-4)


def test_nobody_beyond_the_interaction_radius_is_felt():
    model = CrowdModel()
    for apart, felt in ((7.999, True), (8.0, True), (8.001, False)):
        two = Crowd.create(
            [(0.0, 0.0), (apart, 0.0)], [(1.0, 0.0), (0.0, 0.0)], 1.0, [[(0.0, 0.0)]] * 2
        )
        forces = forces_apart(model, two, Vehicles.empty())
        assert bool(np.any(forces.repulsion)) is felt


def test_head_on_both_give_way_to_their_right():
    two = Crowd.create(
        [(0.0, 0.0), (2.0, 0.0)], [(1.0, 0.0), (-1.0, 0.0)], 1.0, [[(9.0, 0.0)], [(-9.0, 0.0)]]
    )
    navigation = forces_apart(CrowdModel(), two, Vehicles.empty()).navigation
    assert navigation[0, 1] < 0.0 < navigation[1, 1]
    np.testing.assert_array_equal(navigation[0], -navigation[1])


def test_two_at_one_velocity_do_not_walk_round_each_other():
    two = Crowd.create(
        [(0.0, 0.0), (1.0, 0.3)], [(1.0, 0.0), (1.0, 0.0009)], 1.0, [[(9.0, 0.0)]] * 2
    )
    np.testing.assert_array_equal(forces_apart(CrowdModel(), two, Vehicles.empty()).navigation, 0.0)


@pytest.mark.parametrize("cell_list_from", [0, 1000])
def test_people_at_one_place_are_parted_in_opposite_ways(cell_list_from):
    model = CrowdModel(cell_list_from=cell_list_from)
    place = np.array([[3.0, 3.0], [3.0, 3.0], [3.0 + 5e-7, 3.0], [9.0, 3.0]])
    crowd = Crowd.create(place, np.zeros((4, 2)), 1.0, [[(3.0, 3.0)]] * 4)
    collision = forces_apart(model, crowd, Vehicles.empty()).collision
    np.testing.assert_allclose(collision[:3].sum(axis=0), 0.0, atol=1e-9)
    pair = forces_apart(model, crowd.select(np.array([True, True, False, False])), Vehicles.empty())
    np.testing.assert_array_equal(pair.collision[0], -pair.collision[1])
    assert np.hypot(*pair.collision[0]) == pytest.approx(9825.125 * 0.54, rel=1e-12)
