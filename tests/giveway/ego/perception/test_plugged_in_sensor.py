"""A sensor of another package is shown copies, and its answer is checked."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.ego.perception import OwnState, Percept, Truth
from giveway.ego.perception.plugged_in_sensor import PluggedInSensor
from giveway.errors import SensorError
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import Pose
from pedestrian_model import Crowd

OWN = OwnState(Pose(0.0, 0.0, 0.0), 0.0, 0, VehicleShape(4.5, 1.8))
IDS = np.array([4, 2, 9])


def crowd() -> Crowd:
    place = np.array([[1.0, 0.0], [2.0, 0.0], [3.0, 0.0]])
    return Crowd.create(place, np.zeros((3, 2)), 1.3, list(place[:, None] + (0.0, 9.0)))


class Asked:
    def __init__(self, answer) -> None:
        self.observe = answer


def observed(answer) -> Percept:
    sensor = PluggedInSensor("it", lambda: Asked(answer))
    return sensor.observe(Truth.of_people(crowd()), IDS, OWN)


def test_what_it_overwrites_is_a_copy():
    truth, ids = Truth(crowd(), np.ones((1, 7)), np.ones((2, 5)), 3.0), IDS.copy()

    def overwrites(shown, person_ids, ego):
        everybody = person_ids.copy()
        for array in (shown.people.velocity, shown.vehicles, shown.outlines, person_ids):
            array[:] = 7
        ego.speed = 9.0
        return Percept(shown.people, everybody)

    sensor = PluggedInSensor("it", lambda: Asked(overwrites))
    percept = sensor.observe(truth, ids, OWN)
    assert (percept.people.velocity == 7.0).all()
    assert (truth.people.velocity == 0.0).all()
    assert (truth.vehicles == 1.0).all()
    assert (truth.outlines == 1.0).all()
    assert (ids == IDS).all()
    assert OWN.speed == 0.0


def test_a_person_who_is_gone_may_still_be_perceived():
    everybody = crowd()
    sensor = PluggedInSensor("it", lambda: Asked(lambda *_: Percept(everybody, IDS)))
    sensor.observe(Truth.of_people(everybody), IDS, OWN)
    percept = sensor.observe(Truth.of_people(Crowd.empty()), np.arange(0), OWN)
    assert (percept.person_ids == IDS).all()


@pytest.mark.parametrize(
    ("answer", "error"),
    [
        (lambda *_: None, "returned None: expected a Percept"),
        (lambda shown, *_: Percept(shown.people, [4, 2, 9]), r"returned person_ids \[4, 2, 9\]"),
        (lambda shown, ids, _: Percept(shown.people, ids[:2]), r"expected \(3,\) int64"),
        (lambda shown, *_: Percept(shown.people, np.array([4, 2, 3])), "person_ids with 3"),
        (lambda shown, *_: Percept(shown.people, np.array([4, 2, -1])), "person_ids with -1"),
        (lambda shown, *_: Percept(shown.people, np.array([4, 2, 2])), "each person once"),
        (lambda shown, ids, _: Percept(shown.people, ids, np.full(3, -1.0)), "returned age"),
        (
            lambda shown, ids, _: Percept(shown.people, ids, None, np.full(2, 1.0)),
            "returned position_bound",
        ),
    ],
)
def test_an_answer_that_cannot_be_used_is_refused(answer, error):
    with pytest.raises(SensorError, match=error):
        observed(answer)


def test_what_it_raises_is_told_with_its_place():
    with pytest.raises(SensorError, match=r"it raised ZeroDivisionError: .*\(test_plugged_in"):
        observed(lambda *_: 1 / 0)
    with pytest.raises(SensorError, match=r"it raised ZeroDivisionError: .* when it was made"):
        PluggedInSensor("it", lambda: 1 / 0)
