"""The battery finds planted defects, each under its rule, and lets a sound controller pass."""

from __future__ import annotations

import time
from math import inf
from typing import ClassVar

import numpy as np
import pytest

from controller import Acceleration, Observation, Setup, Speed
from giveway.plug_ins.conformance import check_controller

SETUP = Setup(0.05, 1000.0, 100.0, 4.0, 2.0, 5000.0, 2.0)


class Sound:
    """Slows down for whoever is in front, and beside people; eases into a new answer."""

    def __init__(self, setup: Setup) -> None:
        self.setup = setup
        self.reset()

    def reset(self) -> None:
        self.last = 0.0

    def control(self, seen: Observation) -> Acceleration:
        wanted = min(self.setup.reference_speed, seen.speed_limit, max(0.0, seen.gap - 2.0) / 2.0)
        if seen.people is not None and seen.path is not None and len(seen.people.position):
            front = seen.path.poses(np.zeros(1))[0, :2]
            away = np.hypot(*(seen.people.position - front).T)
            wanted *= min(1.0, away.min() / 5.0)
        answer = max(-4.0, min(wanted - seen.speed, 1.5))
        self.last = 0.5 * (self.last + answer)
        return Acceleration(self.last)


class Random(Sound):
    def control(self, seen):
        return Acceleration(np.random.default_rng().normal())


class Shared(Sound):
    calls: ClassVar = [0]

    def control(self, seen):
        self.calls[0] += 1
        return Acceleration(0.001 * (self.calls[0] % 7))


class SharedAmong(Sound):
    """Its answers depend on the latest position that any of its kind has seen."""

    latest: ClassVar = [0.0]

    def control(self, seen):
        if seen.time == 0.0:
            self.latest[0] = 0.0
        answer = Acceleration(self.latest[0])
        self.latest[0] = 0.01 * float(seen.gap if seen.gap < inf else 0.0)
        return answer


class Forgetful(Sound):
    """Its reset does nothing."""

    def reset(self):
        self.last = getattr(self, "last", 0.0)


class First(Sound):
    def control(self, seen):
        known = seen.people is not None and len(seen.people.position)
        return Acceleration(0.1 * seen.people.velocity[0, 0] if known else 0.0)


class Eastwards(Sound):
    def control(self, seen):
        known = seen.people is not None and len(seen.people.position)
        return Acceleration(0.01 * seen.people.velocity[:, 0].sum() if known else 0.0)


class Keeper(Sound):
    """Looks at the people of the step before without having copied them."""

    kept = None

    def control(self, seen):
        before, self.kept = self.kept, None if seen.people is None else seen.people.position
        known = before is not None and len(before)
        return Acceleration(
            1e-3 * np.hypot(*(before[0] - before[-1])) + 1e-3 * abs(before[0, 0]) if known else 0.0
        )


class Writer(Sound):
    def control(self, seen):
        seen.obstacle_positions[:] = 0.0
        return Acceleration(0.0)


class Strong(Sound):
    def control(self, seen):
        return Speed(0.0)


class Slow(Sound):
    def control(self, seen):
        began = time.thread_time()
        while time.thread_time() - began < 8e-4:
            pass
        return Acceleration(0.0)


class Lonely(Sound):
    def control(self, seen):
        return Acceleration(-1.0 / seen.gap)


class Crowded(Sound):
    def control(self, seen):
        return Acceleration(-0.01 * seen.people.position.min())


class Unmade:
    def __init__(self, setup):
        raise RuntimeError("no licence")


DEFECTS = {
    Unmade: "can be made",
    Writer: "answers numbers",
    Crowded: "answers in corner cases",
    Lonely: "answers in corner cases",
    Random: "is the same when it is made again",
    Shared: "is the same when it is made again",
    SharedAmong: "is independent of others of its kind",
    Forgetful: "starts afresh after reset",
    First: "does not depend on the order of people",
    Eastwards: "does not depend on where and how the road lies",
    Keeper: "keeps no array that is not its own",
    Strong: "keeps within the actuator's limit",
    Slow: "is quick",
}


def test_a_sound_controller_keeps_all_rules():
    findings = check_controller(Sound, SETUP)
    assert [finding for finding in findings if finding.problem] == []
    assert {finding.rule for finding in findings} >= set(DEFECTS.values())


@pytest.mark.parametrize("defect", DEFECTS, ids=lambda kind: kind.__name__)
def test_a_planted_defect_is_found_and_told_in_words(defect, monkeypatch):
    monkeypatch.setattr(
        "giveway.plug_ins.conformance.battery.Battery.longest", 0.5e-3
    )  # a fast suite
    broken = {f.rule: f.problem for f in check_controller(defect, SETUP) if f.problem}
    assert DEFECTS[defect] in broken, broken
    assert all(problem.isprintable() for problem in broken.values())
