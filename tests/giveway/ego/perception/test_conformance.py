"""The rules that ``giveway check sensor`` knows, each broken by a sensor that breaks it."""

from __future__ import annotations

import time

import numpy as np
import pytest

from giveway.ego.perception import Percept, SensorSetup
from giveway.ego.perception.conformance import check_sensor

SETUP = SensorSetup(0.05, 1, "ego")


class Sound:
    def __init__(self, setup: SensorSetup) -> None:
        self.random = setup.random()

    def observe(self, truth, person_ids, ego):
        x, y, _ = ego.pose
        near = np.hypot(*(truth.people.position - (x, y)).T) < 20.0
        return Percept(truth.people.select(near), person_ids[near])


class Stranger(Sound):
    def observe(self, truth, person_ids, ego):
        return Percept(truth.people, person_ids + 1000)


class BoundTooTight(Sound):
    def observe(self, truth, person_ids, ego):
        truth.people.position[:] += 0.2
        bound = np.full(len(person_ids), 0.25)  # [m]; the diagonal is 0.28
        return Percept(truth.people, person_ids, None, bound)


class Moody(Sound):
    made = 0

    def __init__(self, setup):
        Moody.made += 1
        self.number = Moody.made

    def observe(self, truth, person_ids, ego):
        seen = person_ids % 3 != self.number % 3
        return Percept(truth.people.select(seen), person_ids[seen])


class ByRow(Sound):
    def observe(self, truth, person_ids, ego):
        seen = np.arange(len(person_ids)) % 2 == 0
        return Percept(truth.people.select(seen), person_ids[seen])


class EastOnly(Sound):
    def observe(self, truth, person_ids, ego):
        seen = truth.people.position[:, 0] > 20.0
        return Percept(truth.people.select(seen), person_ids[seen])


class Keeper(Sound):
    first = None

    def observe(self, truth, person_ids, ego):
        if self.first is None:
            self.first = truth.people
        same = len(self.first) == len(truth.people)
        return Percept(self.first if same else truth.people, person_ids)


class Slow(Sound):
    timed = False  # whether "is quick" is being checked; the other checks need not wait

    def observe(self, truth, person_ids, ego):
        until = time.thread_time() + 0.006 * self.timed
        while time.thread_time() < until:
            pass
        return Percept(truth.people, person_ids)


def broken(kind) -> list[str]:
    def begins(rule: str) -> None:
        Slow.timed = rule == "is quick"

    return [finding.rule for finding in check_sensor(kind, SETUP, begins) if finding.problem]


def test_a_sound_sensor_breaks_no_rule():
    assert broken(Sound) == []


@pytest.mark.parametrize(
    ("kind", "rule"),
    [
        (Stranger, "answers with a percept"),
        (BoundTooTight, "keeps to the bounds that it claims"),
        (Moody, "perceives the same when it is made again"),
        (ByRow, "does not depend on the order of people"),
        (EastOnly, "does not depend on where and how the ground lies"),
        (Keeper, "keeps no array that is not its own"),
        (Slow, "is quick"),
    ],
)
def test_each_rule_is_broken_by_a_sensor_that_breaks_it(kind, rule):
    assert rule in broken(kind)


def test_a_class_that_cannot_be_made_is_told_so():
    (finding,) = check_sensor(lambda _: object(), SETUP)
    assert finding.rule == "can be made"
    assert "expected an object with a method observe" in finding.problem
