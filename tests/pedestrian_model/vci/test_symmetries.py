"""What must not matter: where, how turned, in which order; and that nothing breaks the model."""

from __future__ import annotations

import numpy as np
from crowd_forces import forces_apart
from hypothesis import given, settings
from hypothesis import strategies as st

from pedestrian_model import Crowd, CrowdModel, Vehicles, vehicle_influence

MODEL = CrowdModel()
seeds = st.integers(0, 2**31 - 1)
angles = st.floats(-10.0, 10.0)
few = settings(max_examples=40)


def turned(crowd, vehicles, angle=0.0, shift=(0.0, 0.0)):
    """The same scene, turned about the origin and then shifted."""
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    a = vehicles.array.copy()
    a[:, :2] = a[:, :2] @ turn.T + shift
    a[:, 2] += angle
    moved = Crowd.create(
        crowd.position @ turn.T + shift,
        crowd.velocity @ turn.T,
        crowd.desired_speed,
        list((crowd.waypoints @ turn.T + shift)[:, None]),
    )
    return moved, Vehicles(a), turn


@few
@given(seeds, st.tuples(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3)))
def test_translation(random_crowd, random_vehicles, seed, shift):
    crowd, vehicles = random_crowd(20, seed), random_vehicles(seed)
    moved, moved_vehicles, _ = turned(crowd, vehicles, shift=shift)
    np.testing.assert_allclose(
        forces_apart(MODEL, moved, moved_vehicles).total,
        forces_apart(MODEL, crowd, vehicles).total,
        rtol=1e-6,
        atol=1e-5,
    )


@few
@given(seeds, angles)
def test_rotation(random_crowd, random_vehicles, seed, angle):
    crowd, vehicles = random_crowd(20, seed), random_vehicles(seed)
    moved, moved_vehicles, turn = turned(crowd, vehicles, angle=angle)
    np.testing.assert_allclose(
        forces_apart(MODEL, moved, moved_vehicles).total,
        forces_apart(MODEL, crowd, vehicles).total @ turn.T,
        rtol=1e-7,
        atol=1e-6,
    )


@few
@given(seeds)
def test_a_mirror_mirrors_everything_but_the_choice_of_the_right(
    random_crowd, random_vehicles, seed
):
    """In general position the mirrored scene has the mirrored forces: sides are taken by the
    relative motion. Only where it does not decide, w.t = 0, does keep-right break the mirror."""
    crowd, vehicles = random_crowd(20, seed), random_vehicles(seed)
    mirror = np.array([1.0, -1.0])
    a = vehicles.array.copy()
    a[:, 1:3] *= -1.0
    mirrored = Crowd.create(
        crowd.position * mirror,
        crowd.velocity * mirror,
        crowd.desired_speed,
        list((crowd.waypoints * mirror)[:, None]),
    )
    np.testing.assert_allclose(
        forces_apart(MODEL, mirrored, Vehicles(a)).total,
        forces_apart(MODEL, crowd, vehicles).total * mirror,
        rtol=1e-9,
        atol=1e-8,
    )


def test_the_exact_head_on_case_does_not_mirror_but_keeps_right(walkers):
    head_on = walkers([(0.0, 0.0), (3.0, 0.0)], [(9.0, 0.0), (-9.0, 0.0)])
    reverse = walkers([(0.0, 0.0), (-3.0, 0.0)], [(-9.0, 0.0), (9.0, 0.0)])
    east = forces_apart(MODEL, head_on, Vehicles.empty()).navigation
    west = forces_apart(MODEL, reverse, Vehicles.empty()).navigation
    assert east[0, 1] < 0.0 < west[0, 1]  # to the right of each
    assert east[0, 1] == -west[0, 1]


@few
@given(seeds, st.sampled_from([0, 1000]))
def test_the_order_of_the_pedestrians_matters_to_rounding_only(
    random_crowd, random_vehicles, seed, cell_list_from
):
    model = CrowdModel(cell_list_from=cell_list_from)
    crowd, vehicles = random_crowd(35, seed), random_vehicles(seed)
    order = np.random.default_rng(seed).permutation(35)
    shuffled = Crowd.create(
        crowd.position[order],
        crowd.velocity[order],
        crowd.desired_speed[order],
        list(crowd.waypoints[order][:, None]),
    )
    a, b = model.step(crowd, vehicles), model.step(shuffled, vehicles)
    np.testing.assert_allclose(b.position, a.position[order], rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(b.velocity, a.velocity[order], rtol=0.0, atol=1e-11)


coordinate = st.one_of(
    st.sampled_from([0.0, 1.0, 2.7151011, -2.7151011, 1.2151011, 1e-300, 1e-7, 1e9, -1e9]),
    st.floats(-1e9, 1e9),
    st.floats(-5.0, 5.0),
)
point = st.tuples(coordinate, coordinate)
slow = st.one_of(st.sampled_from([0.0, 1e-300, 1e-3]), st.floats(-3.0, 3.0))


@settings(max_examples=150)
@given(
    st.lists(st.tuples(point, st.tuples(slow, slow), point), min_size=1, max_size=12),
    st.lists(st.tuples(coordinate, coordinate, slow, st.floats(-30.0, 30.0)), max_size=3),
    st.sampled_from([0, 1000]),
)
def test_nothing_makes_a_state_that_is_not_finite(people, cars, cell_list_from):
    x, v, p = (np.array(column, dtype=float) for column in zip(*people, strict=True))
    crowd = Crowd.create(x, v, 1.4, list(p[:, None]))
    vehicles = Vehicles.create(*np.array(cars).T) if cars else Vehicles.empty()
    model = CrowdModel(cell_list_from=cell_list_from)
    for _ in range(3):
        crowd = model.step(crowd, vehicles)
        assert np.isfinite(crowd.position).all()
        assert (np.hypot(*crowd.velocity.T) <= 2.5 + 1e-9).all()


@few
@given(seeds, angles)
def test_the_influence_turns_with_the_vehicle(seed, angle):
    rng = np.random.default_rng(seed)
    x, v = rng.uniform(-6.0, 6.0, (30, 2)), rng.normal(0.0, 1.0, (30, 2))
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    f, s = vehicle_influence(x, v, Vehicles.create(0.0, 0.0, 0.0, 3.0))
    g, t = vehicle_influence(x @ turn.T, v @ turn.T, Vehicles.create(0.0, 0.0, angle, 3.0))
    np.testing.assert_allclose(g, f @ turn.T, rtol=1e-9, atol=1e-8)
    np.testing.assert_allclose(t, s, rtol=0.0, atol=1e-12)
