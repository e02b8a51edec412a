"""The battery finds planted defects, each under its rule, and lets a sound model pass."""

from __future__ import annotations

import time
from typing import ClassVar

import numpy as np
import pytest

from giveway.plug_ins.conformance import check_model
from pedestrian_model import Accelerations, ModelSetup, Velocities, Walkers

SETUP = ModelSetup(0.05, 0.27, 5.0, 2.5, 1)


class Sound:
    """To the goal; away from each other; everybody eases into a new answer, by id."""

    def __init__(self, setup: ModelSetup) -> None:
        self.reset()

    def reset(self) -> None:
        self.last: dict[int, np.ndarray] = {}

    def step(self, walkers: Walkers) -> Accelerations:
        wanted = 2.0 * (walkers.preferred - walkers.velocity)
        apart = walkers.position[:, None] - walkers.position[None]
        distance = np.hypot(apart[..., 0], apart[..., 1])[..., None]
        wanted = wanted + (np.exp(-distance / 0.3) * apart / np.maximum(distance, 1e-6)).sum(axis=1)
        for k, one in enumerate(walkers.ids):
            wanted[k] = 0.5 * (wanted[k] + self.last.get(int(one), 0.0))
            self.last[int(one)] = wanted[k]
        return Accelerations(wanted)


class Random(Sound):
    def step(self, walkers):
        answer = super().step(walkers).values
        return Accelerations(answer + np.random.default_rng().normal(size=answer.shape))


class SharedAmong(Sound):
    """Its answers depend on how many any of its kind has seen since somebody began to walk."""

    latest: ClassVar = [0.0]

    def step(self, walkers):
        answer = super().step(walkers).values + self.latest[0]
        self.latest[0] = 0.1 * float(walkers.goals.position[0, 0] % 1.0)
        return Accelerations(answer)

    def reset(self):
        super().reset()
        self.latest[0] = 0.0


class Forgetful(Sound):
    """Its reset does nothing."""

    def reset(self):
        self.last = getattr(self, "last", {})


class FirstIsFirst(Sound):
    def step(self, walkers):
        answer = super().step(walkers).values
        answer[0] += 0.5
        return Accelerations(answer)


class Eastwards(Sound):
    def step(self, walkers):
        return Accelerations(super().step(walkers).values + [0.2, 0.0])


class Keeper(Sound):
    """Remembers the position itself where it should a copy."""

    def __init__(self, setup):
        super().__init__(setup)
        self.before = None

    def step(self, walkers):
        answer = super().step(walkers).values
        moved = 0.0 if self.before is None else walkers.position - self.before
        self.before = walkers.position
        return Accelerations(answer + moved)


class Explosive(Sound):
    def step(self, walkers):
        return Accelerations(1e3 * super().step(walkers).values)


class Runner(Sound):
    def step(self, walkers):
        return Velocities(3.0 * walkers.preferred)


class Slow(Sound):
    timed = False  # whether "is quick" is being checked; the other checks need not wait

    def step(self, walkers):
        answer = super().step(walkers)
        began = time.thread_time()
        while self.timed and time.thread_time() - began < 8e-4:
            pass
        return answer


class Lazy(Sound):
    """Nobody ever gets anywhere."""

    def step(self, walkers):
        return Accelerations(-walkers.velocity)


class CannotBeAlone(Sound):
    def step(self, walkers):
        assert len(walkers.ids) > 1
        return super().step(walkers)


class Divides(Sound):
    """By the distance of two people, which may be none."""

    def step(self, walkers):
        answer = super().step(walkers).values
        apart = walkers.position[:, None] - walkers.position[None]
        distance = np.hypot(*apart.T) + np.eye(len(apart))
        with np.errstate(divide="ignore", invalid="ignore"):
            return Accelerations(answer + 0.01 * (1.0 / distance).sum(axis=0)[:, None] * answer)


class Flat(Sound):
    def step(self, walkers):
        return np.zeros(2 * len(walkers.ids))


class Unmakeable:
    def __init__(self, setup):
        raise KeyError("nothing")


def broken(kind: type) -> set[str]:
    def begins(rule: str) -> None:
        Slow.timed = rule == "is quick"

    return {finding.rule for finding in check_model(kind, SETUP, begins=begins) if finding.problem}


def test_a_sound_model_passes():
    assert broken(Sound) == set()


@pytest.mark.parametrize(
    ("kind", "rule"),
    [
        (Random, "is the same when it is made again"),
        (SharedAmong, "is independent of others of its kind"),
        (Forgetful, "starts afresh after reset"),
        (FirstIsFirst, "does not depend on the order of people"),
        (Eastwards, "does not depend on where and how the ground lies"),
        (Keeper, "keeps no array that is not its own"),
        (Explosive, "asks for what bodies can do"),
        (Runner, "asks for what bodies can do"),
        (Slow, "is quick"),
        (Lazy, "brings people to where they want to"),
        (CannotBeAlone, "answers in corner cases"),
        (Divides, "answers in corner cases"),
        (Flat, "answers numbers"),
        (Unmakeable, "can be made"),
    ],
)
def test_a_planted_defect_is_found_under_its_rule(kind, rule, monkeypatch):
    monkeypatch.setattr(
        "giveway.plug_ins.conformance.battery.Battery.longest", 0.5e-3
    )  # a fast suite
    assert rule in broken(kind)


def test_what_is_found_is_said_in_words():
    problems = {finding.rule: finding.problem for finding in check_model(Runner, SETUP)}
    assert problems["asks for what bodies can do"].endswith("of 2.5 m/s")
    (found,) = check_model(Unmakeable, SETUP)
    assert "raised KeyError: 'nothing' (test_models.py:" in found.problem
    assert "when it was made" in found.problem
