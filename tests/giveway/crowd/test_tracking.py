"""Positions that are seen with a bounded error: bounds that hold, estimates that are near."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from giveway.crowd.motion.noise import BOUND, planar_noise
from giveway.crowd.tracking import Tracker
from pedestrian_model import Crowd

DT, NOISE, HARDEST = 0.05, 0.1, 3.0
WHO = np.arange(30)


class World:
    """People who accelerate at random, up to ``hardest`` [m/s^2] in x and in y together."""

    def __init__(self, seed: int, hardest: float = HARDEST) -> None:
        self.random = np.random.default_rng(seed)
        self.position = self.random.uniform(-20.0, 20.0, (len(WHO), 2))
        self.velocity = self.random.normal(size=(len(WHO), 2))
        self.hardest = hardest

    def step(self) -> None:
        angle = self.random.uniform(-np.pi, np.pi, len(WHO))
        push = self.hardest * self.random.choice([0.0, 0.5, 1.0], (len(WHO), 1))
        a = push * np.column_stack([np.cos(angle), np.sin(angle)])
        until = DT * self.random.uniform(0.0, 1.0)  # they brake again within the step, or not
        self.position = self.position + DT * self.velocity + (until * DT - until**2 / 2) * a
        self.velocity = self.velocity + until * a

    def seen(self, rows=WHO) -> Crowd:
        noise = NOISE * planar_noise(self.random, len(WHO))[rows]
        place, velocity = self.position[rows], self.velocity[rows]
        return Crowd.create(place + noise, velocity, 1.4, list(place[:, None] + (0.0, 30.0)))


def tracker() -> Tracker:
    return Tracker(BOUND * NOISE, HARDEST, DT)


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=20)
def test_nobody_is_farther_off_than_it_says(seed):
    world, tracked = World(seed), tracker()
    for _ in range(60):
        world.step()
        crowd = world.seen()
        errors = tracked.update(crowd, WHO)
        off = np.hypot(*(crowd.position - world.position).T)
        assert (off <= errors + 1e-12).all()


def test_who_is_seen_for_a_while_is_known_ten_times_better():
    world, tracked = World(1), tracker()
    off, errors = [], []
    for _ in range(200):
        world.step()
        crowd = world.seen()
        errors.append(tracked.update(crowd, WHO).mean())
        off.append(np.hypot(*(crowd.position - world.position).T).mean())
    assert errors[0] == pytest.approx(BOUND * NOISE * np.sqrt(2.0))
    assert np.mean(off[100:]) < off[0] / 7.0
    assert np.mean(errors[100:]) < errors[0] / 2.5


def test_people_are_told_apart_by_their_numbers_not_by_their_rows():
    worlds = World(2), World(2)
    kept, shuffled = tracker(), tracker()
    for k in range(30):
        rows = np.roll(WHO, k)
        first = worlds[0].seen()
        errors = kept.update(first, WHO)
        second = worlds[1].seen(rows)
        others = shuffled.update(second, rows)
        assert np.array_equal(first.position[rows], second.position)
        assert np.array_equal(errors[rows], others)
        for world in worlds:
            world.step()


def test_who_was_away_is_new_again_and_so_is_who_moved_as_nobody_does():
    world, tracked = World(3), tracker()
    new = BOUND * NOISE * np.sqrt(2.0)
    for k in range(20):
        world.step()
        rows = WHO[1:] if k == 18 else WHO
        if k == 19:
            world.position[5] += 1.0  # [m]
        crowd = world.seen(rows)
        errors = tracked.update(crowd, rows)
    assert errors[0] == pytest.approx(new)
    assert errors[5] == pytest.approx(new)
    assert (np.delete(errors, [0, 5]) < new).all()


def test_nobody_is_tracked_as_nobody():
    tracked = tracker()
    assert not len(tracked.update(Crowd.empty(), np.arange(0)))
