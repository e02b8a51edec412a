"""The memory of what people did, by person id."""

from __future__ import annotations

import numpy as np
import pytest

from pedestrian_model import Crowd
from pedestrian_model.drift.features import ALONG, LAGS
from pedestrian_model.drift.memory import Memory

DT = 0.05
SINCE = ALONG.index("velocity now - 1 s ago")


def crowd_of(speeds):
    """People a kilometre apart, who walk along x."""
    n = len(speeds)
    position = np.column_stack([np.zeros(n), 1000.0 * np.arange(n)])
    velocity = np.column_stack([speeds, np.zeros(n)])
    return Crowd.create(position, velocity, 1.3, [np.array([[50.0, 0.0]])] * n)


def change_of(memory, person_id):
    """The change of the speed within one second that the memory tells of a person."""
    return memory.numbers(np.array([person_id]))[1][0, SINCE]


def test_a_person_who_was_out_of_sight_begins_anew():
    memory = Memory(DT)
    for k in range(40):
        seen = [0, 1] if k != 30 else [0]
        memory.remember(crowd_of([1.0 + 0.01 * k] * len(seen)), np.array(seen))
    assert change_of(memory, 0) == pytest.approx(0.20)
    assert change_of(memory, 1) == pytest.approx(0.08)  # seen again since nine instants


def test_the_past_outlasts_people_who_come_later():
    memory = Memory(DT)
    for k in range(40):
        seen = np.array([0, 500]) if k > 30 else np.array([0])
        memory.remember(crowd_of([1.0 + 0.01 * k] * len(seen)), seen)
    assert change_of(memory, 0) == pytest.approx(0.20)


def test_what_is_older_than_three_seconds_does_not_count():
    old, new = Memory(DT), Memory(DT)
    speeds = np.random.default_rng(1).uniform(0.5, 1.5, 200)
    for k, speed in enumerate(speeds):
        old.remember(crowd_of([speed]), np.array([0]))
        if k >= len(speeds) - round(max(LAGS) / DT) - 1:
            new.remember(crowd_of([speed]), np.array([0]))
    assert old.numbers(np.array([0]))[1].tolist() == new.numbers(np.array([0]))[1].tolist()
