"""Routes through a city: way-points at full speed, passages side by side, signals that hold."""

from __future__ import annotations

import hashlib
from dataclasses import replace

import numpy as np
import pytest
from crowd_forces import constant_speed, forces_apart

from pedestrian_model import (
    OFF_WALKWAYS,
    OPEN_GROUND,
    SIM,
    Crowd,
    CrowdError,
    CrowdModel,
    Predictor,
    Surroundings,
    SurroundingsError,
    Vehicles,
    Walls,
    arrived,
)

NOBODY = Vehicles.empty()
V0 = SIM.desired_speed


def state_of(crowd):
    return crowd.position.tobytes() + crowd.velocity.tobytes() + crowd.waypoint_index.tobytes()


def plaza(n, **features):
    """People criss-cross on an open plaza; numbers by arithmetic only, equal everywhere."""
    k = np.arange(n)
    place = np.stack([1.3 * (k % 12) + 0.01 * (k * 7 % 13), 1.4 * (k // 12)], axis=1)
    goal = np.stack([16.0 - 1.1 * (k * 5 % 17), 14.0 - 0.9 * (k * 3 % 19)], axis=1)
    return Crowd.create(place, np.zeros((n, 2)), 1.0 + k % 5 / 10, list(goal[:, None]), **features)


def cars():
    return Vehicles.create([-4.0, 7.0], [6.0, 4.0], [0.25, 1.0], [3.0, 0.0])


@pytest.mark.parametrize(("n", "digest"), [(30, "af5dea57320bfcf9"), (150, "f724f23fa8fc4d17")])
def test_the_open_plaza_keeps_its_bits(n, digest):
    """The digests are those of the model before it knew routes, passages, signals and walls."""
    crowd, model = plaza(n), CrowdModel()
    predicted = Predictor().predict(crowd, constant_speed(cars(), 0.05, 15)).tobytes()
    for _ in range(60):
        model.advance(crowd, cars())
    assert hashlib.sha256(predicted + state_of(crowd)).hexdigest()[:16] == digest


def test_features_that_are_not_used_change_no_bit():
    far = Surroundings(Walls.create([(500.0, 0.0, 500.0, 9.0)]), np.array([True, False]))
    plain = plaza(40)
    marked = plaza(40, passages=[np.zeros((1, 3))] * 40, signals=[[-1]] * 40)
    for _ in range(30):
        plain = CrowdModel().step(plain, cars())
        marked = CrowdModel().step(marked, cars(), far)
    assert state_of(plain) == state_of(marked)


def zigzag(leg, length=60.0, degrees=30.0):
    """(k, 2) way-points of a route that turns left and right by turns."""
    count = int(length / leg)
    angle = np.radians(degrees) * np.where(np.arange(count) % 2 == 0, -1.0, 1.0)
    return np.cumsum(leg * np.stack([np.cos(angle), np.sin(angle)], axis=1), axis=0)


@pytest.mark.parametrize("leg", [3.0, 5.0, 10.0])
def test_waypoints_on_the_way_cost_no_speed(leg):
    route = zigzag(leg)
    crowd = Crowd.create([(0.0, 0.0)], V0 * route[:1] / leg, V0, [route])
    model, walked, steps = CrowdModel(), 0.0, 0
    while crowd.waypoint_index[0] < len(route) - 1:
        after = model.step(crowd, NOBODY)
        walked += np.hypot(*(after.position - crowd.position)[0])
        crowd, steps = after, steps + 1
        assert steps < 2000
    assert walked / (steps * 0.05) == pytest.approx(V0, rel=0.02)


def test_the_last_waypoint_is_still_a_place_to_stop():
    crowd = Crowd.create([(0.0, 0.0)], [(0.0, 0.0)], V0, [[(4.0, 0.0), (8.0, 0.0)]])
    model = CrowdModel()
    for _ in range(400):
        model.advance(crowd, NOBODY)
    np.testing.assert_allclose(crowd.position[0], (8.0, 0.0), atol=1e-3)
    assert np.hypot(*crowd.velocity[0]) < 1e-3


def test_whoever_stands_exactly_on_a_waypoint_gets_a_finite_way():
    crowd = Crowd.create([(0.0, 0.0)], [(0.0, 0.0)], 1.0, [[(0.0, 0.0), (5.0, 0.0)]])
    strict = CrowdModel(replace(SIM, waypoint_radius=0.0))
    crowd.position[0] = 1e-12, 0.0
    after = strict.step(crowd, NOBODY)
    assert np.isfinite(after.position).all()


def test_round_a_standing_car_on_a_route(clearance):
    """At a corner of a car nobody stops; the way round still keeps clear of the body."""
    car = Vehicles.create(0.0, 0.0, 0.0, 0.0)
    route = [(0.5, 6.0), (0.5, 30.0), (0.5, 40.0)]
    crowd = Crowd.create([(0.5, -6.0)], [(0.0, V0)], V0, [route])
    model = CrowdModel()
    for _ in range(300):
        model.advance(crowd, car)
        assert clearance(crowd.position, car)[0] > 0.0
    assert crowd.position[0, 1] > 6.0


def abreast(lateral, half_width, direction=(1.0, 0.0)):
    """People side by side, a line to cross 8 m ahead, and their own goals beyond it."""
    lateral = np.asarray(lateral, float)
    n = len(lateral)
    along = np.asarray(direction)
    left = np.array([-along[1], along[0]])
    start = lateral[:, None] * left
    goals = 30.0 * along + start
    return Crowd.create(
        start,
        np.tile(V0 * along, (n, 1)),
        V0,
        [[8.0 * along, goal] for goal in goals],
        passages=[[(*(3.0 * along), half_width), (0.0, 0.0, 0.0)]] * n,
    )


def steps_until_through(crowd):
    """How many steps until all have passed, and the crowd then."""
    model = CrowdModel()
    for k in range(400):
        if (crowd.waypoint_index == 1).all():
            return k, crowd
        crowd = model.step(crowd, NOBODY)
    return 400, crowd


@pytest.mark.parametrize("angle", [0.0, 0.7, -2.0])
def test_a_crowd_goes_through_a_passage_side_by_side(angle):
    direction = np.array([np.cos(angle), np.sin(angle)])
    left = np.array([-direction[1], direction[0]])
    lateral = np.array([-2.4, -1.2, 0.0, 1.2, 2.4])
    steps, through = steps_until_through(abreast(lateral, 3.0, direction))
    # at their own offsets (people keep apart a little), where one point makes a queue
    np.testing.assert_allclose(through.position @ left, lateral, atol=0.4)
    assert steps < 160
    assert steps_until_through(abreast(lateral, 0.0, direction))[0] > steps + 20


def test_beside_or_before_a_line_nothing_is_passed():
    at = [(7.9, 0.0), (8.1, 1.9), (8.1, 2.1), (8.1, -1.9), (12.0, 0.0)]
    passed = [False, True, False, True, True]
    crowd = Crowd.create(
        np.array(at) + (0.0, 50.0),
        np.zeros((5, 2)),
        1.0,
        [[(8.0, 50.0), (90.0, 50.0)]] * 5,
        passages=[[(1.0, 0.0, 2.0), (0.0, 0.0, 0.0)]] * 5,
    )
    narrow = CrowdModel(replace(SIM, waypoint_radius=0.05, repulsion_strength=0.0))
    after = narrow.step(crowd, NOBODY)
    np.testing.assert_array_equal(after.waypoint_index == 1, passed)


def test_who_is_pushed_back_through_a_line_passes_it_once_more():
    """Otherwise a corner between them and the next line could catch them."""
    line = [(0.0, 0.0), (5.0, -6.0)]
    passages = [[(1.0, 0.0, 2.0), (0.0, -1.0, 1.0)]]
    for place, index in (((-1.2, 1.5), 0), ((-0.8, 1.5), 1), ((-1.2, 2.5), 1)):
        crowd = Crowd.create([place], [(0.0, 0.0)], V0, [line], passages=passages)
        crowd.waypoint_index[:] = 1
        CrowdModel().advance(crowd, NOBODY)
        assert crowd.waypoint_index.tolist() == [index], place


def test_who_turns_round_behind_a_line_does_not_pass_it_once_more():
    """At a dead end people go back through the line that they came through."""
    line = [(0.0, 0.0), (-8.0, 0.0)]
    passages = [[(1.0, 0.0, 2.0), (-1.0, 0.0, 2.0)]]
    crowd = Crowd.create([(0.2, 0.0)], [(0.0, 0.0)], V0, [line], passages=passages)
    for _ in range(240):
        CrowdModel().advance(crowd, NOBODY)
    assert crowd.position[0, 0] < -7.0


def test_walls_hold_nobody_on_the_way_off_the_walkways():
    wall = Surroundings(Walls.create([(2.0, -50.0, 2.0, 50.0)]))
    crowd = Crowd.create(
        [(0.0, 0.0), (0.0, 9.0)],
        [(0.0, 0.0)] * 2,
        V0,
        [[(5.0, 0.0)], [(5.0, 9.0)]],
        signals=[[-1], [OFF_WALKWAYS]],
    )
    for _ in range(160):
        CrowdModel().advance(crowd, NOBODY, wall)
    held, free = crowd.position[:, 0]
    assert held < 2.0
    assert free > 4.0


def test_the_aim_is_the_nearest_point_a_body_from_the_ends():
    crowd = abreast([-9.0, -1.0, 0.3, 2.0], 2.0)
    target = forces_apart(CrowdModel(), crowd, NOBODY).target
    np.testing.assert_allclose(target, [(8.0, -1.73), (8.0, -1.0), (8.0, 0.3), (8.0, 1.73)])


def test_the_last_line_is_arrived_at_anywhere_along_it():
    crowd = Crowd.create(
        [(9.8, 1.5), (9.8, 2.5), (8.0, 0.0)],
        np.zeros((3, 2)),
        1.0,
        [[(10.0, 0.0)]] * 3,
        passages=[[(1.0, 0.0, 2.0)]] * 3,
    )
    np.testing.assert_array_equal(arrived(crowd, 0.3), [True, False, False])


def at_the_kerb(n=4, ahead=0):
    """n people 4 m before a kerb with signal 1, two of them past it already if ``ahead``."""
    start = np.stack([np.zeros(n), 1.2 * np.arange(n)], axis=1)
    start[n - ahead :, 0] = 5.0
    crowd = Crowd.create(
        start,
        np.tile([V0, 0.0], (n, 1)),
        V0,
        [[(4.0, y), (12.0, y), (20.0, y)] for y in start[:, 1]],
        passages=[[(1.0, 0.0, 0.6), (1.0, 0.0, 0.6), (0.0, 0.0, 0.0)]] * n,
        signals=[[1, -1, -1]] * n,
    )
    crowd.waypoint_index[n - ahead :] = 1
    return crowd


def test_red_holds_people_at_the_kerb_and_green_lets_them_go():
    closed = np.array([False, True])
    surroundings, model, crowd = Surroundings(closed=closed), CrowdModel(), at_the_kerb(4, ahead=1)
    for _ in range(240):
        model.advance(crowd, NOBODY, surroundings)
        assert (crowd.position[:3, 0] < 4.2).all()
    assert (crowd.waypoint_index[:3] == 0).all()
    np.testing.assert_allclose(crowd.position[:3, 0], 4.0, atol=0.2)
    assert (np.hypot(*crowd.velocity[:3].T) < 0.05).all()
    assert crowd.position[3, 0] > 18.0  # who was past the kerb has walked on
    closed[1] = False
    for _ in range(200):
        model.advance(crowd, NOBODY, surroundings)
    assert (crowd.position[:, 0] > 15.0).all()


def test_green_does_not_slow_anybody():
    crowd = at_the_kerb(1)
    for _ in range(60):
        CrowdModel().advance(crowd, NOBODY, Surroundings(closed=np.array([True, False])))
        assert np.hypot(*crowd.velocity[0]) == pytest.approx(V0, rel=1e-3)


@pytest.mark.parametrize("cell_list_from", [0, 1000])
@pytest.mark.parametrize("red", [True, False])
def test_the_prediction_sees_signals_and_walls_bit_for_bit(red, cell_list_from):
    crowd = at_the_kerb(6, ahead=2)
    walls = Walls.create([(25.0, -1.0, -5.0, -1.0), (-5.0, 7.0, 25.0, 7.0)][::-1])
    surroundings = Surroundings(walls, np.array([False, red]))
    car = Vehicles.create([9.0, 30.0], [2.0, 0.0], 1.57, [1.0, 0.0])
    poses = constant_speed(car, 0.1, 40)
    predictor = Predictor(time_step=0.1, horizon=40, cell_list_from=cell_list_from)
    before = state_of(crowd)
    predicted = predictor.predict(crowd, poses, surroundings)
    assert state_of(crowd) == before
    model, now = CrowdModel(time_step=0.1, cell_list_from=cell_list_from), crowd
    for k in range(40):
        now = model.step(now, Vehicles(poses[k].copy()), surroundings)
        np.testing.assert_array_equal(predicted[k], now.position)
    assert (now.waypoint_index[:4] == 0).all() == red


def test_people_come_and_go_and_the_prediction_stays_exact(random_crowd):
    predictor = Predictor(horizon=6)
    poses = np.zeros((6, 0, 7))
    for n in (5, 40, 39, 0, 41, 12):
        crowd = random_crowd(n, n)
        predicted = predictor.predict(crowd, poses)
        assert predicted.shape == (6, n, 2)
        assert predicted.flags.c_contiguous
        np.testing.assert_array_equal(predicted, Predictor(horizon=6).predict(crowd, poses))


def test_a_direction_put_in_by_hand_has_length_one():
    with pytest.raises(CrowdError, match=r"waypoint_passage\[0\] has direction \[2.0, 0.0\]"):
        replace(at_the_kerb(1), waypoint_passage=np.array([(2.0, 0.0, 1.0)] + [(0.0,) * 3] * 2))


def test_a_signal_beyond_those_given_is_named_not_read():
    crowd = at_the_kerb(2)
    message = r"pedestrian 0: a way-point has signal 1, but surroundings.closed has 1"
    short = Surroundings(closed=np.array([True]))
    with pytest.raises(SurroundingsError, match=message):
        CrowdModel().step(crowd, NOBODY, short)
    with pytest.raises(SurroundingsError, match=message):
        forces_apart(CrowdModel(), crowd, NOBODY, short)
    with pytest.raises(SurroundingsError, match=message):
        Predictor().predict(crowd, np.zeros((15, 0, 7)), short)
    with pytest.raises(SurroundingsError, match="has 0: give one for each signal"):
        CrowdModel().step(crowd, NOBODY, OPEN_GROUND)
