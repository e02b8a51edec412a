"""SUMO's vehicles that touch people: which pairs count, once each."""

import numpy as np

from giveway.cosimulation.traffic.touches import Touches
from giveway.sumo.background import BackgroundVehicles

# Two cars of 4 m by 2 m to the east, fronts at x = 10 m and 30 m; the second one hardly moves
CARS = BackgroundVehicles(
    ("fast", "slow"),
    ("car", "car"),
    np.array([10.0, 30.0]),
    np.zeros(2),
    np.zeros(2),
    np.array([5.0, 0.9]),
    np.full(2, 4.0),
    np.full(2, 2.0),
)
PLACES = {
    "inside": (8.0, 0.5),
    "deep": (10.2, 0.0),  # 7 cm deep, with a body of 0.27 m
    "grazed": (10.23, 0.0),  # 4 cm deep
    "behind": (5.7, 0.0),
    "in the slow one": (28.0, 0.0),
}


def test_who_is_touched_deeper_than_5_cm_by_a_moving_car_counts_once() -> None:
    touches = Touches()
    for time in (0.9, 1.0, 1.1):
        touches.update(time, CARS, list(PLACES), np.array(list(PLACES.values())))
    assert len(touches) == 2
    assert "'fast' touched 'inside' at 1 s" in touches.remark  # not as SUMO has just put them there
    assert "touched people 2 times" in touches.remark


def test_without_contacts_nothing_is_said() -> None:
    touches = Touches()
    touches.update(0.0, CARS, ["behind"], np.array([PLACES["behind"]]))
    touches.update(0.0, CARS, [], np.empty((0, 2)))
    assert (len(touches), touches.remark) == (0, "")
