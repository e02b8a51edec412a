"""Positions that are seen with a bounded error: bounds that hold, estimates that are near."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from giveway.crowd.motion.noise import BOUND, planar_noise
from giveway.ego.perception.protocol import Percept
from giveway.ego.perception.tracking import Tracker
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


def tracked(by: Tracker, crowd: Crowd, ids=WHO) -> tuple[Crowd, np.ndarray]:
    """The estimates and their bounds, kept beyond the next call."""
    people, _, _, bound, _ = by.refine(Percept(crowd, ids))
    return people.copy(), bound.copy()


def tracker() -> Tracker:
    return Tracker(BOUND * NOISE, HARDEST, DT)


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=20)
def test_nobody_is_farther_off_than_it_says(seed):
    world, eyes = World(seed), tracker()
    for _ in range(60):
        world.step()
        crowd, errors = tracked(eyes, world.seen())
        off = np.hypot(*(crowd.position - world.position).T)
        assert (off <= errors + 1e-12).all()


def test_who_is_seen_for_a_while_is_known_ten_times_better():
    world, eyes = World(1), tracker()
    off, errors = [], []
    for _ in range(200):
        world.step()
        crowd, bound = tracked(eyes, world.seen())
        errors.append(bound.mean())
        off.append(np.hypot(*(crowd.position - world.position).T).mean())
    assert errors[0] == pytest.approx(BOUND * NOISE * np.sqrt(2.0))
    assert np.mean(off[100:]) < off[0] / 7.0
    assert np.mean(errors[100:]) < errors[0] / 2.5


def test_people_are_told_apart_by_their_ids_not_by_their_rows():
    worlds = World(2), World(2)
    kept, shuffled = tracker(), tracker()
    for k in range(30):
        rows = np.roll(WHO, k)
        first, errors = tracked(kept, worlds[0].seen())
        second, others = tracked(shuffled, worlds[1].seen(rows), rows)
        assert np.array_equal(first.position[rows], second.position)
        assert np.array_equal(errors[rows], others)
        for world in worlds:
            world.step()


def test_a_person_who_was_away_or_jumped_is_a_new_track():
    world, eyes = World(3), tracker()
    new = BOUND * NOISE * np.sqrt(2.0)
    for k in range(20):
        world.step()
        rows = WHO[1:] if k == 18 else WHO
        if k == 19:
            world.position[5] += 1.0  # [m]
        _, errors = tracked(eyes, world.seen(rows), rows)
    assert errors[0] == pytest.approx(new)
    assert errors[5] == pytest.approx(new)
    assert (np.delete(errors, [0, 5]) < new).all()


def test_nobody_is_tracked_as_nobody():
    people, errors = tracked(tracker(), Crowd.empty(), np.arange(0))
    assert not len(people)
    assert not len(errors)


def test_a_bound_that_the_sensor_claims_replaces_the_own_one():
    world, eyes = World(4), tracker()
    claimed = np.linspace(0.3, 0.6, len(WHO))
    percept = eyes.refine(Percept(world.seen(), WHO, None, claimed))
    assert percept.position_bound == pytest.approx(claimed * np.sqrt(2.0))


def test_without_noise_and_bound_nothing_is_tracked():
    percept = Percept(World(5).seen(), WHO)
    assert Tracker(0.0, HARDEST, DT).refine(percept) is percept


def test_the_percept_that_it_is_given_is_not_written():
    world, eyes = World(6), tracker()
    for _ in range(5):
        world.step()
        crowd = world.seen()
        before = crowd.position.copy()
        eyes.refine(Percept(crowd, WHO))
        assert np.array_equal(crowd.position, before)
