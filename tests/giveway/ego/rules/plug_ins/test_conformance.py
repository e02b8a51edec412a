"""The kit for rules of other packages finds what is wrong with them."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import pytest

from giveway.ego.rules.plug_ins.conformance import check_rule, made_up_route
from giveway.ego.rules.protocol import Demand, Situation

ROUTE = made_up_route()


class Sound:
    """A rule that stops before the second edge."""

    def __init__(self, route: Any) -> None:
        ((self.begin, _),) = route.stretches("second")

    def demand(self, situation: Situation) -> Demand | None:
        ahead = situation.station < self.begin
        return Demand(self.begin - 1.0, "level crossing") if ahead else None


class Counts(Sound):
    count = 0

    def demand(self, situation: Situation) -> Demand | None:
        Counts.count += 1
        return Demand(speed=5.0 + 1e-3 * Counts.count)


class FirstPerson(Sound):
    def demand(self, situation: Situation) -> Demand | None:
        people = situation.crowd.position
        return Demand(speed=abs(float(people[0, 1]))) if len(people) else None


class Meddles(Sound):
    def demand(self, situation: Situation) -> Demand | None:
        situation.speed = 0.0
        return None


class Behind(Sound):
    def demand(self, situation: Situation) -> Demand | None:
        return Demand(situation.station - 5.0, "too late")


class CornerCase(Sound):
    def demand(self, situation: Situation) -> Demand | None:
        return Demand(speed=1.0 / len(situation.crowd))


class Slow(Sound):
    timed = False  # whether "is quick" is being checked; the other checks need not wait

    def demand(self, situation: Situation) -> Demand | None:
        until = time.thread_time() + 0.001 * self.timed
        while time.thread_time() < until:
            pass
        return None


def broken(make: Callable[[Any], object]) -> set[str]:
    def begins(rule: str) -> None:
        Slow.timed = rule == "is quick"

    return {finding.rule for finding in check_rule(make, ROUTE, begins) if finding.problem}


def test_a_sound_rule_breaks_nothing() -> None:
    assert broken(Sound) == set()


@pytest.mark.parametrize(
    ("make", "check"),
    [
        (Counts, "is the same when it is made again"),
        (Counts, "is independent of others of its kind"),
        (FirstPerson, "does not depend on the order of people"),
        (Meddles, "changes nothing of the situation"),
        (Behind, "demands no stop behind the ego"),
        (CornerCase, "answers in corner cases"),
        (Slow, "is quick"),
        (lambda route: None, "can be made, and has a say on the made-up road"),
        (lambda route: 3, "can be made, and has a say on the made-up road"),
    ],
)
def test_each_fault_is_found(make: Callable[[Any], object], check: str) -> None:
    assert check in broken(make)
