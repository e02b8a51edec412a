"""Replays: simulated people enter, walk and leave as the recorded ones, among the same vehicles."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from giveway.config import RunConfig
from giveway.validation.behaviour.replaying import replayed, settled

STRAIGHT = RunConfig.model_validate({"crowd": {"model": "constant-velocity"}})
VCI = RunConfig.model_validate({"crowd": {"model": "vci"}})
TIME = np.arange(100) / 10.0


def walk(y: float, speed: float, start: float = 0.0) -> np.ndarray:
    return np.column_stack([start + speed * TIME, np.full(100, y)])


def test_the_first_half_second_is_left_out(recording) -> None:
    kept = settled(recording(walk(2.0, 1.3), walk(3.0, 1.3)))
    assert kept.people.frame.tolist() == 2 * list(range(5, 100))


def test_who_is_seen_for_less_than_a_second_is_left_out(recording) -> None:
    made = recording(walk(2.0, 1.3), walk(3.0, 1.3))
    people = made.people
    rows = (people.track == 0) | (people.frame > 91)
    fields = ("track", "frame", "position", "velocity", "heading", "speed")
    short = replace(people, **{name: getattr(people, name)[rows] for name in fields})
    assert settled(replace(made, people=short)).people.ids == ("0",)


def test_people_enter_and_leave_as_recorded(recording) -> None:
    kept = settled(recording(walk(20.0, 1.3), walk(30.0, -1.3)))
    found = replayed(kept, STRAIGHT)
    assert found.people.ids == kept.people.ids
    assert found.people.frame.tolist() == kept.people.frame.tolist()
    first = found.people.bounds[:-1]
    assert found.people.position[first] == pytest.approx(kept.people.position[first])
    assert found.vehicles is kept.vehicles


def test_without_others_people_walk_straight_to_their_end(recording) -> None:
    found = replayed(settled(recording(walk(20.0, 1.34))), STRAIGHT).people
    assert found.position[:, 1] == pytest.approx(20.0)
    assert (np.diff(found.position[:, 0]) > 0.0).all()


def test_people_of_the_model_make_way_for_the_vehicle(recording) -> None:
    here = settled(recording(walk(1.0, 1.3, -5.0), walk(40.0, 1.3)))
    beside = np.abs(replayed(here, VCI).people.position[:95, 1] - 1.0).max()
    assert beside > 0.2
    assert np.abs(replayed(here, STRAIGHT).people.position[:95, 1] - 1.0).max() < 1e-6


def test_the_same_recording_gives_the_same_bytes(recording) -> None:
    here = settled(recording(walk(1.0, 1.3, -5.0), walk(2.0, 1.3)))
    one, two = (replayed(here, VCI).people.position.tobytes() for _ in range(2))
    assert one == two
