"""Where background vehicles expect people: those who walk, those who wait, those beside fronts."""

import numpy as np

from giveway.cosimulation.traffic.people_ahead import expected, still, touched_in_front
from giveway.crowd.gap_acceptance import Waiting
from giveway.sumo.background import BackgroundVehicles
from pedestrian_model import Crowd

PLACES = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)]


def crowd() -> Crowd:
    return Crowd.create(PLACES, [(0.0, 1.0)] * 3, 1.2, [[(0.0, 9.0)]] * 3)


def test_who_waits_on_the_sidewalk_is_expected_to_stay_there() -> None:
    held, stays = np.array([False, True, True]), np.array([False, True, False])
    waiting = Waiting(held, stays)
    assert expected(crowd(), waiting).tolist() == [[0.0, 0.0], [0.0, 1.0]]
    there = [[1.0, 0.0], [2.0, 0.0], [2.0, 0.5], [2.0, 1.0]]
    assert still(crowd(), waiting).tolist() == there
    nobody = Waiting(np.zeros(3, dtype=bool), np.zeros(3, dtype=bool))
    assert len(expected(crowd(), nobody)) == len(expected(crowd())) == 6
    assert still(crowd(), nobody).shape == (0, 2)


def test_people_walk_on_and_those_with_priority_to_their_goals() -> None:
    crowd = Crowd.create(
        [(0.0, 0.0), (9.0, 0.0)],
        [(1.0, 0.0), (0.0, 0.0)],
        1.2,
        [[(50.0, 0.0)], [(9.0, 70.0)]],
        priority=[0.0, 1.0],
    )
    np.testing.assert_allclose(
        expected(crowd),
        [(0.0, 0.0), (9.0, 0.0), (1.0, 0.0), (9.0, 0.0), (9.0, 1.2), (9.0, 2.4)],
    )
    crowd.priority[:] = 0.0
    assert len(expected(crowd)) == 4


def test_a_slow_car_does_not_start_into_who_is_beside_its_front() -> None:
    cars = BackgroundVehicles(
        tuple("abc"),
        ("car",) * 3,
        np.array([0.0, 20.0, 40.0]),
        np.zeros(3),
        np.full(3, np.pi / 2),
        np.array([0.0, 0.0, 2.0]),
        np.full(3, 4.0),
        np.full(3, 2.0),
    )
    people = np.array([(1.25, -0.5), (20.0, 0.5), (21.35, -0.5), (20.9, -1.1), (41.0, -0.5)])
    assert touched_in_front(cars, people).tolist() == [0]
    assert touched_in_front(cars, np.empty((0, 2))).tolist() == []
