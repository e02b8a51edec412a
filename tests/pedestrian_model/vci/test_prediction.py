"""The prediction is the model itself, N times, and leaves the crowd as it is."""

from __future__ import annotations

import numpy as np
import pytest
from crowd_forces import constant_speed

from pedestrian_model import (
    PRESETS,
    Crowd,
    CrowdModel,
    DivergenceError,
    ParameterError,
    Predictor,
    Surroundings,
    VehicleError,
    Vehicles,
)
from pedestrian_model.vci.constants import pack


@pytest.mark.parametrize("n", [0, 1, 30, 90])
@pytest.mark.parametrize("time_step", [0.05, 0.12])
@pytest.mark.parametrize("cell_list_from", [0, 1000])
def test_prediction_is_stepping_bit_by_bit(
    random_crowd, random_vehicles, n, time_step, cell_list_from
):
    crowd, vehicles = random_crowd(n, n), random_vehicles(n)
    poses = constant_speed(vehicles, time_step, 15)
    before = crowd.position.tobytes() + crowd.velocity.tobytes() + crowd.waypoint_index.tobytes()
    predictor = Predictor(time_step=time_step, horizon=15, cell_list_from=cell_list_from)
    predicted = predictor.predict(crowd, poses)
    after = crowd.position.tobytes() + crowd.velocity.tobytes() + crowd.waypoint_index.tobytes()
    assert after == before
    assert predicted.shape == (15, n, 2)
    model, now = CrowdModel(time_step=time_step, cell_list_from=cell_list_from), crowd
    for k in range(15):
        now = model.step(now, Vehicles(poses[k].copy()))
        np.testing.assert_array_equal(predicted[k], now.position)


def test_a_curved_path_is_followed(random_crowd):
    crowd = random_crowd(20, 0)
    angle = np.linspace(0.0, 0.8, 10)
    poses = np.stack(
        [Vehicles.create(6.0 * np.sin(a), 6.0 - 6.0 * np.cos(a), a, 4.0).array for a in angle]
    )
    predicted = Predictor(horizon=10).predict(crowd, poses)
    now = crowd
    for k in range(10):
        now = CrowdModel().step(now, Vehicles(poses[k].copy()))
    np.testing.assert_array_equal(predicted[-1], now.position)


def test_the_buffer_is_reused_when_the_crowd_changes_its_size(random_crowd, random_vehicles):
    vehicles = random_vehicles(0)
    predictor = Predictor(horizon=5)
    poses = constant_speed(vehicles, 0.05, 5)
    first = predictor.predict(random_crowd(30, 0), poses)
    kept = first.copy()
    assert predictor.predict(random_crowd(30, 1), poses) is first
    assert not np.array_equal(first, kept)
    assert predictor.predict(random_crowd(50, 1), poses).shape == (5, 50, 2)
    np.testing.assert_array_equal(predictor.predict(random_crowd(30, 0), poses), kept)


def test_a_moving_car_is_avoided_in_the_prediction(walkers):
    crowd = walkers([(8.0, -1.5)], [(8.0, 9.0)])
    predictor = Predictor(horizon=30)
    free = predictor.predict(crowd, constant_speed(Vehicles.empty(), 0.05, 30))[-1, 0, 1]
    held = predictor.predict(crowd, constant_speed(Vehicles.create(0.0, 0.0, 0.0, 4.0), 0.05, 30))[
        -1, 0, 1
    ]
    assert held < free - 0.5


def test_bad_trajectories_horizons_and_states_are_named(random_crowd):
    crowd, predictor = random_crowd(5, 0), Predictor(horizon=4)
    with pytest.raises(VehicleError, match=r"expected \(4, any, 7\)"):
        predictor.predict(crowd, np.zeros((5, 1, 7)))
    with pytest.raises(VehicleError, match="C-contiguous float64"):
        predictor.predict(crowd, np.zeros((4, 2, 7))[:, ::2])
    with pytest.raises(VehicleError, match="C-contiguous float64"):
        predictor.predict(crowd, np.zeros((4, 1, 7), dtype=np.float32))
    with pytest.raises(ParameterError, match="horizon = 0"):
        Predictor(horizon=0)
    crowd.position[3, 0] = np.nan
    with pytest.raises(DivergenceError, match="pedestrian 3"):
        predictor.predict(crowd, np.zeros((4, 0, 7)))


def test_alone_one_long_step_leads_where_two_short_ones_do(walkers):
    crowd = walkers([(0.0, 0.0)], [(20.0, 0.0)])
    crowd.velocity[:] = 0.7, 0.1  # the limit of the acceleration does not act
    free = Vehicles.empty()
    fine = Predictor(horizon=40).predict(crowd, constant_speed(free, 0.05, 40))[1::2]
    poses = constant_speed(free, 0.1, 20)
    long = Predictor(time_step=0.1, horizon=20, longest_step=0.1)
    error = np.abs(long.predict(crowd, poses) - fine).max()
    long.law = (pack(long.parameters), *long.law[1:4], 0.0)  # as the crowd would make the step
    assert error < 5e-3
    assert error < 0.3 * np.abs(long.predict(crowd, poses) - fine).max()


@pytest.mark.parametrize("preset", ["SIM", "MIXED"])
@pytest.mark.parametrize("speed", [0.0, 2.0, 4.0])
def test_among_others_one_long_step_is_near_two_short_ones(walkers, speed, preset):
    """Also people of MIXED, k_des dt/m = 1.8 in a long step, whose speeds settle in two short ones.

    The long step's larger mass makes it 0.98.
    """
    law = PRESETS[preset]
    car, g = Vehicles.create(-6.0, 0.0, 0.0, speed), np.random.default_rng(0)
    x, y = (a.ravel() + g.uniform(-0.5, 0.5, 20) for a in np.mgrid[0.0:10.0:2.5, -5.0:5.0:2.0])
    crowd = walkers(np.column_stack([x, y]), np.column_stack([x, -3.0 * y]))
    fine = Predictor(law, horizon=60).predict(crowd, constant_speed(car, 0.05, 60))[1::2]
    poses = constant_speed(car, 0.1, 30)
    poses[:, :, 0] += 0.025 * speed  # where the car is on the average in two steps
    long = Predictor(law, time_step=0.1, horizon=30, longest_step=0.1)
    error = np.abs(long.predict(crowd, poses) - fine).max(axis=2)
    assert error[9].mean() < 0.015
    assert error[-1].mean() < 0.08


def test_a_step_of_the_crowds_length_is_the_crowds_own(random_crowd):
    crowd, poses = random_crowd(20, 1), constant_speed(Vehicles.empty(), 0.05, 10)
    usual = Predictor(horizon=10).predict(crowd, poses)
    allowed = Predictor(horizon=10, longest_step=0.1).predict(crowd, poses)
    assert usual.tobytes() == allowed.tobytes()


def test_what_people_wish_at_the_end_of_a_prediction():
    """One whose way goes on, one on the last leg, one before a closed signal, one who turns."""
    crowd = Crowd.create(
        [(0.0, 0.0), (0.0, 20.0), (0.0, 40.0), (0.0, 60.0)],
        [(1.2, 0.0)] * 4,
        1.2,
        [
            [(30.0, 0.0), (30.0, 9.0)],
            [(0.0, 20.0), (10.0, 20.0)],
            [(10.0, 40.0), (30.0, 40.0)],
            [(1.0, 60.0), (1.0, 99.0)],
        ],
        signals=[[-1, -1], [-1, -1], [0, -1], [-1, -1]],
    )
    surroundings = Surroundings(closed=np.array([True]))
    predictor = Predictor(horizon=20)
    end = predictor.predict(crowd, constant_speed(Vehicles.empty(), 0.05, 20), surroundings)[-1]
    on, last, waits, turned = predictor.desired_velocities(crowd, surroundings)
    assert on == pytest.approx([1.2, 0.0, np.inf])
    assert last == pytest.approx([1.2, 0.0, (10.0 - end[1, 0]) / 1.2])
    assert waits == pytest.approx([1.2, 0.0, (10.0 - end[2, 0]) / 1.2])
    assert np.hypot(*turned[:2]) == pytest.approx(1.2)
    assert turned[1] > 1.19
    assert turned[2] == pytest.approx(np.hypot(1.0 - end[3, 0], 99.0 - end[3, 1]) / 1.2)


def test_who_has_arrived_or_has_no_speed_wishes_nothing():
    crowd = Crowd.create(
        [(0.0, 0.0), (500.0, 0.0)], np.zeros((2, 2)), [1.2, 0.0], [[(0, 0)], [(9, 9)]]
    )
    predictor = Predictor(horizon=1)
    predictor.predict(crowd, constant_speed(Vehicles.empty(), 0.05, 1))
    assert predictor.desired_velocities(crowd).tolist() == [[0.0, 0.0, np.inf]] * 2
