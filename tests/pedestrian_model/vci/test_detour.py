"""The detour: pedestrians walk round a standing car."""

from __future__ import annotations

import numpy as np
import pytest
from crowd_forces import forces_apart

from pedestrian_model import CrowdModel, Vehicles


@pytest.mark.parametrize("across", [-1.5, 0.0, 0.5, 2.4])
@pytest.mark.parametrize("start", [-6.0, -2.5])
def test_a_walker_gets_round_a_standing_car(walkers, clearance, across, start):
    car = Vehicles.create(0.0, 0.0, 0.0, 0.0)
    crowd = walkers([(across, start)], [(across, 8.0)])
    model = CrowdModel()
    for _ in range(500):
        crowd = model.step(crowd, car)
        assert clearance(crowd.position, car)[0] > 0.0
    np.testing.assert_allclose(crowd.position[0], (across, 8.0), atol=0.2)


def test_a_walker_gets_round_a_car_lengthwise_at_any_heading(walkers, clearance):
    for heading in (0.0, 0.6, 2.0, -1.2):
        car = Vehicles.create(0.0, 0.0, heading, 0.1)
        ahead = np.array([np.cos(heading), np.sin(heading)])
        crowd = walkers([-7.0 * ahead], [7.0 * ahead])
        model = CrowdModel()
        for _ in range(500):
            crowd = model.step(crowd, car)
            assert clearance(crowd.position, car)[0] > 0.0
        np.testing.assert_allclose(crowd.position[0], 7.0 * ahead, atol=0.2)


def test_a_crowd_gets_round_a_standing_car(walkers, clearance):
    rng = np.random.default_rng(4)
    grid = np.stack(np.meshgrid(np.arange(-3.0, 3.1, 1.2), [-8.0, -6.8, -5.6]), -1).reshape(-1, 2)
    start = grid + rng.uniform(-0.2, 0.2, grid.shape)
    car = Vehicles.create(0.0, 0.0, 0.0, 0.0)
    crowd = walkers(start, start + (0.0, 16.0))
    model = CrowdModel()
    for _ in range(600):
        crowd = model.step(crowd, car)
        assert (clearance(crowd.position, car) > 0.0).all()
    assert (crowd.position[:, 1] > 4.0).all()


def test_the_way_round_leads_over_a_corner_with_room_to_spare(walkers):
    car = Vehicles.create(0.0, 0.0, 0.0, 0.0)
    model = CrowdModel()
    room = 0.2151011 + 0.27 + 0.3
    target = forces_apart(model, walkers([(1.0, -5.0)], [(1.0, 5.0)]), car).target[0]
    np.testing.assert_allclose(target, (2.5 + room, -1.0 - room), atol=1e-12)  # the near end
    clear = forces_apart(model, walkers([(4.0, -5.0)], [(4.0, 5.0)]), car).target[0]
    np.testing.assert_array_equal(clear, (4.0, 5.0))


def test_nobody_walks_round_a_car_that_moves(walkers):
    crowd = walkers([(1.0, -5.0)], [(1.0, 5.0)])
    for speed, detours in ((0.0, True), (0.19, True), (-0.19, True), (0.2, False), (-2.0, False)):
        target = forces_apart(CrowdModel(), crowd, Vehicles.create(0.0, 0.0, 0.0, speed)).target[0]
        assert bool(target[1] != 5.0) is detours


def test_the_first_of_two_standing_cars_is_walked_round_first(walkers):
    cars = Vehicles.create([0.0, 0.0], [6.0, 0.0], 0.0, 0.0)
    crowd = walkers([(0.5, -5.0)], [(0.5, 12.0)])
    model = CrowdModel()
    assert forces_apart(model, crowd, cars).target[0, 1] == pytest.approx(-1.7851011)
    for _ in range(700):
        crowd = model.step(crowd, cars)
    np.testing.assert_allclose(crowd.position[0], (0.5, 12.0), atol=0.2)


def test_a_destination_beside_the_standing_car_is_reached(walkers, clearance):
    car = Vehicles.create(0.0, 0.0, 0.0, 0.0)
    crowd = walkers([(0.0, -5.0)], [(0.5, 1.75)])  # inside the margin, on the far side
    model = CrowdModel()
    for _ in range(600):
        crowd = model.step(crowd, car)
        assert clearance(crowd.position, car)[0] > 0.0
    assert crowd.position[0, 1] > 1.0
    assert np.hypot(*(crowd.position[0] - (0.5, 1.75))) < 0.6


def test_inside_the_car_or_on_the_way_in_ways_are_finite(walkers):
    car = Vehicles.create(0.0, 0.0, 0.0, 0.0)
    crowd = walkers([(0.3, 0.2), (0.0, -5.0)], [(0.0, 9.0), (0.1, 0.1)])
    target = forces_apart(CrowdModel(), crowd, car).target
    np.testing.assert_array_equal(target, [(0.0, 9.0), (0.1, 0.1)])


def test_without_the_detour_a_walker_stays_beside_the_car(walkers):
    """The published forces alone have a local minimum there; the switch is the detour and no more.

    Where no car stands, both models take the same step to the bit.
    """
    crowd = walkers([(0.0, -6.0)], [(0.0, 12.0)])
    parked, driving = (Vehicles.create(0.0, 0.0, 0.0, speed) for speed in (0.0, 2.0))
    ends = {}
    for detour in (True, False):
        model, walker = CrowdModel(detour=detour), crowd.copy()
        for _ in range(600):
            model.advance(walker, parked)
        ends[detour] = walker.position[0, 1]
    assert ends[True] > 10.0
    assert ends[False] < -1.0
    steps = [CrowdModel(detour=detour).step(crowd, driving) for detour in (True, False)]
    assert steps[0].velocity.tobytes() == steps[1].velocity.tobytes()
