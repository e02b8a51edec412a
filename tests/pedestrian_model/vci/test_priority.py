"""People with priority walk on before a vehicle that can still stop; all others as in the paper.

A car comes along x towards a crossing from x = 8 to 12 m; somebody crosses at x = 10 m.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from crowd_forces import constant_speed, forces_apart

from pedestrian_model import Crowd, CrowdError, CrowdModel, Predictor, Vehicles
from pedestrian_model.vci.priority import DECELERATION, FADE, LEAST_GAP

KERB, STOP = 3.5, 7.0  # [m] half the road's width; where the car's front is to stand
SPEED = 1.4
HALF = 2.5  # [m] of the car's length


def somebody(y=-KERB, x=10.0, priority=1.0, target=8.0):
    return Crowd.create([[x, y]], [[0.0, SPEED]], SPEED, [[(x, target)]], priority=priority)


def car(front, speed, y=-1.75):
    return Vehicles.create(front - HALF, y, 0.0, speed)


def crossing(priority, vehicles_at, x=10.0):
    """Somebody's places (k, 2) from kerb to kerb, or during 20 s."""
    model, now, places = CrowdModel(), somebody(x=x, priority=priority), []
    for k in range(400):
        places.append(now.position[0].copy())
        if now.position[0, 1] > KERB:
            break
        now = model.step(now, vehicles_at(0.05 * k))
    return np.array(places)


def gives_way(time):
    """The car drives 5 m at 4 m/s, brakes with 3 m/s^2 and stands a metre before the crossing."""
    brakes = 4.0 / 3.0  # [s]
    left = max(0.0, 5.0 / 4.0 + brakes - time)  # [s] until it stands
    yet = 1.5 * min(left, brakes) ** 2 + 4.0 * max(0.0, left - brakes)  # [m] to be driven
    return car(STOP - yet, min(4.0, 3.0 * left))


def pushed_back(places):
    return (np.maximum.accumulate(places[:, 1]) - places[:, 1]).max()


def test_a_car_that_gives_way_pushes_nobody_with_priority_back():
    alone = crossing(0.0, lambda _: Vehicles.empty())
    held, free = crossing(0.0, gives_way), crossing(1.0, gives_way)
    assert pushed_back(held) > 0.3
    assert len(held) > len(alone) + 20  # a second
    np.testing.assert_allclose(free, alone, atol=1e-9)


@pytest.mark.parametrize("x", [8.3, 9.0, 11.0])
def test_a_car_before_the_crossing_turns_nobody_from_their_way(x):
    places = crossing(1.0, lambda _: car(STOP, 0.0), x=x)
    np.testing.assert_allclose(places[:, 0], x, atol=1e-9)
    assert pushed_back(places) == 0.0


def test_a_car_that_cannot_stop_any_more_repels_as_in_the_paper():
    needed = 4.0**2 / (2.0 * DECELERATION)
    coming = car(10.0 - needed - LEAST_GAP + 0.01, 4.0)
    model, relying = CrowdModel(), somebody(y=-2.5)
    paper = model.step(somebody(y=-2.5, priority=0.0), coming)
    np.testing.assert_array_equal(model.step(relying, coming).velocity, paper.velocity)
    assert paper.velocity[0, 1] < SPEED
    in_time = car(10.0 - needed - LEAST_GAP - FADE - 0.01, 4.0)
    alone = model.step(relying, Vehicles.empty())
    np.testing.assert_array_equal(model.step(relying, in_time).velocity, alone.velocity)


@pytest.mark.parametrize("front", [10.0, 11.0, 14.0])
def test_round_a_car_on_the_crossing_people_go_as_in_the_paper(clearance, front):
    paper, law = (crossing(priority, lambda _: car(front, 0.0)) for priority in (0.0, 1.0))
    beside = np.argmax(paper[:, 0] > front + LEAST_GAP) or len(paper)  # until past its corner
    np.testing.assert_array_equal(law[:beside], paper[:beside])
    assert law[-1, 1] > KERB
    assert clearance(law, car(front, 0.0)).min() > 0.27  # a body's radius


def test_a_reversing_car_is_one_with_its_front_behind():
    forward, backward = car(4.0, 3.0), Vehicles.create(1.5, -1.75, np.pi, -3.0)
    for y in (-3.0, -2.0, 0.0):
        steps = [CrowdModel().step(somebody(y=y), way) for way in (forward, backward)]
        np.testing.assert_allclose(steps[0].velocity, steps[1].velocity, atol=1e-12)


def test_the_force_sets_in_over_half_a_metre_without_a_jump():
    """From nothing to the paper's as the car comes nearer, in proportion."""
    fronts = np.linspace(6.0, 10.0, 401)
    share = []
    for front in fronts:
        own, paper = (
            forces_apart(CrowdModel(), somebody(y=-2.5, priority=p), car(front, 4.0)).vehicle[0]
            for p in (1.0, 0.0)
        )
        share.append(np.hypot(*own) / np.hypot(*paper))
    share = np.array(share)
    assert share[0] == 0.0
    assert share[-1] == 1.0
    assert (np.diff(share) >= -1e-12).all()
    assert np.diff(share).max() <= (fronts[1] - fronts[0]) / FADE + 1e-9


def test_half_a_priority_leaves_half_of_the_force():
    half, paper = (
        forces_apart(CrowdModel(), somebody(priority=p), car(4.0, 4.0)).vehicle for p in (0.5, 0.0)
    )
    np.testing.assert_allclose(half, 0.5 * paper)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("n", "cell_list_from"), [(60, 1000), (60, 0), (400, 100)])
def test_nobody_else_changes(random_crowd, random_vehicles, n, cell_list_from, seed):
    vehicles = Vehicles(
        np.concatenate([random_vehicles(seed + k).array for k in range(2)])  # more than a handful
    )
    crowd, model = random_crowd(n, seed), CrowdModel(cell_list_from=cell_list_from)
    priority = np.where(np.arange(n) % 2 == 0, 1.0, 0.0)
    paper = model.step(crowd, vehicles)
    law = model.step(replace(crowd, priority=priority), vehicles)
    others = priority == 0.0
    np.testing.assert_array_equal(law.velocity[others], paper.velocity[others])
    assert (law.velocity[~others] != paper.velocity[~others]).any()


@pytest.mark.parametrize(("n", "cell_list_from"), [(40, 1000), (40, 0)])
@pytest.mark.parametrize("time_step", [0.05, 0.12])
def test_prediction_is_stepping_with_priority_too(
    random_crowd, random_vehicles, n, cell_list_from, time_step
):
    crowd = replace(random_crowd(n, 1), priority=np.linspace(0.0, 1.0, n))
    vehicles = random_vehicles(1)
    poses = constant_speed(vehicles, time_step, 10)
    settings = {"time_step": time_step, "cell_list_from": cell_list_from}
    predicted = Predictor(horizon=10, **settings).predict(crowd, poses)
    model, now = CrowdModel(**settings), crowd
    for k in range(10):
        now = model.step(now, Vehicles(poses[k].copy()))
        np.testing.assert_array_equal(predicted[k], now.position)


def test_priority_stays_with_the_person():
    three = Crowd.create(
        np.eye(3, 2), np.zeros((3, 2)), 1.0, [[(9, 9)]] * 3, priority=[0.0, 0.5, 1.0]
    )
    rest = three.select(np.array([False, True, True]))
    np.testing.assert_array_equal(rest.priority, [0.5, 1.0])
    np.testing.assert_array_equal(rest.concatenate(three).priority, [0.5, 1.0, 0.0, 0.5, 1.0])
    np.testing.assert_array_equal(three.copy().priority, three.priority)
    rest.priority[:] = 0.0
    np.testing.assert_array_equal(three.priority, [0.0, 0.5, 1.0])


@pytest.mark.parametrize(
    ("priority", "message"),
    [
        ([0.0, 1.5], r"priority\[1\] = 1.5, expected 0 to 1"),
        ([-0.1, 0.0], r"priority\[0\] = -0.1"),
        ([np.nan, 0.0], r"priority\[0\] = nan"),
        ([0.0], r"priority has shape \(1,\), expected \(2\)"),
    ],
)
def test_what_is_no_priority(priority, message):
    with pytest.raises(CrowdError, match=message):
        Crowd.create(np.eye(2), np.zeros((2, 2)), 1.0, [[(9, 9)]] * 2, priority=priority)
