"""What one should see: people pass each other, make way for a car, walk round a standing one."""

from __future__ import annotations

import numpy as np
import pytest

from pedestrian_model import SIM, TABLE2, CrowdModel, Vehicles

NOBODY = Vehicles.empty()


def lane(n, spread, seed):
    """(n, 2) places in a block about the x axis, no two closer than 0.6 m."""
    rng = np.random.default_rng(seed)
    places = [np.array([8.0, 0.2])]
    while len(places) < n:
        place = rng.uniform((6.0, -spread), (16.0, spread))
        if min(np.hypot(*(place - other)) for other in places) > 0.6:
            places.append(place)
    return np.array(places)


def closest_approach(parameters, crowd):
    """The least distance between the centres of two, and the crowd at the end [15 s]."""
    model = CrowdModel(parameters)
    closest = np.inf
    for _ in range(300):
        crowd = model.step(crowd, NOBODY)
        closest = min(closest, np.hypot(*(crowd.position[0] - crowd.position[1])))
    return closest, crowd


@pytest.mark.parametrize("offset", [0.1, -0.1, 0.2, 0.5])
@pytest.mark.parametrize("speed", [1.0, 1.394293])
def test_head_on_pairs_pass_without_overlap(walkers, offset, speed):
    crowd = walkers([(0.0, 0.0), (12.0, offset)], [(20.0, 0.0), (-8.0, offset)], speed)
    closest, after = closest_approach(SIM, crowd)
    assert closest > 2.0 * SIM.body_radius
    assert after.position[0, 0] > 12.0
    assert after.position[1, 0] < 0.0


def test_exactly_head_on_shoulders_touch_under_sim_alone(walkers):
    """At full speed and without any offset the soft bodies are compressed by 4 cm under SIM;
    under TABLE2 people walk through each other, which is why SIM is the preset to simulate."""
    slow, fast = (
        walkers([(0.0, 0.0), (12.0, 0.0)], [(20.0, 0.0), (-8.0, 0.0)], speed)
        for speed in (1.2, 1.394293)
    )
    assert closest_approach(SIM, slow)[0] > 2.0 * SIM.body_radius
    assert closest_approach(SIM, fast)[0] == pytest.approx(0.4957, abs=1e-4)
    assert closest_approach(TABLE2, fast)[0] < 0.1


@pytest.mark.parametrize("u", [1.0, 2.0, 4.0])
@pytest.mark.parametrize("seed", [0, 1])
def test_a_standing_crowd_makes_way_for_a_car(walkers, clearance, u, seed):
    places = lane(30, 3.0, seed)
    crowd = walkers(places, places, walking=False)
    model = CrowdModel()
    for k in range(int(28.0 / u / 0.05)):
        car = Vehicles.create(-6.0 + u * k * 0.05, 0.0, 0.0, u)
        assert (clearance(crowd.position, car) > 0.0).all(), f"somebody is inside at step {k}"
        crowd = model.step(crowd, car)


def test_a_creeping_car_may_count_as_standing_for_its_angle(walkers):
    """Its contour does in any case; at 0.2 m/s and above both models take the same step."""
    crowd = walkers([(1.0, -2.0), (-1.0, 3.0)], [(1.0, 9.0), (-1.0, -9.0)])

    def after(speed, **reading):
        step = CrowdModel(**reading).step(crowd, Vehicles.create(0.0, 0.0, 0.3, speed))
        return step.velocity.tobytes()

    for speed in (0.19, -0.19):
        assert after(speed, creep=False) == after(0.0)
        assert after(speed) != after(0.0)
    for speed in (0.0, 0.2, 2.0):
        assert after(speed, creep=False) == after(speed)
