"""Recorded people come in where, when and as fast as they were recorded."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.config import RunConfig
from giveway.crowd.generation.recorded import RecordedPeople, RecordedPerson
from giveway.crowd.roster import Roster, Walking
from pedestrian_model import OPEN_GROUND, SIM, CrowdModel, Vehicles

STEP = 0.1  # [s]


def person(name: str, begin: float, end: float, speed: float = 1.0) -> RecordedPerson:
    """Walk along x from 0, recorded every 0.04 s."""
    time = np.arange(begin, end + 0.01, 0.04)
    position = np.column_stack([speed * (time - begin), np.zeros(len(time))])
    velocity = np.tile([speed, 0.0], (len(time), 1))
    return RecordedPerson(name, time, position, velocity, 1.3, position[-1])


def entries(source: RecordedPeople, until: float) -> list[tuple[int, str]]:
    steps = range(round(until / STEP) + 1)
    return [(step, name) for step in steps for names in source.enter(step) for name in names]


@pytest.mark.parametrize("follow", [True, False])
def test_they_enter_when_and_where_recorded(follow: bool) -> None:
    roster = Roster()
    people = [person("late", 1.04, 9.0), person("early", -2.0, 8.0), person("gone", -5.0, -1.0)]
    source = RecordedPeople(people, roster, STEP, follow=follow)
    assert source.keeps_coming
    assert entries(source, 3.0) == [(0, "early"), (11, "late")]
    assert not source.keeps_coming
    assert roster.crowd.position == pytest.approx(np.array([[2.0, 0.0], [0.06, 0.0]]))
    assert roster.crowd.velocity == pytest.approx(np.array([[1.0, 0.0], [1.0, 0.0]]))
    assert roster.crowd.desired_speed.tolist() == [1.3, 1.3]
    assert roster.added == {"early", "late"}


def test_nobody_comes_twice_and_afresh_is_the_same_again() -> None:
    roster, copy = Roster(), Roster()
    source = RecordedPeople([person("a", 0.0, 5.0)], roster, STEP, follow=True)
    assert source.enter(0) == [["a"]]
    assert source.enter(0) == [[]]
    again = source.afresh(copy)
    assert again.enter(0) == [["a"]]
    assert again.identity == source.identity
    assert copy.crowd.position.tobytes() == roster.crowd.position.tobytes()
    other = RecordedPeople([person("a", 0.0, 5.0, 1.1)], Roster(), STEP, follow=True)
    assert other.identity != source.identity


def test_a_written_walk_has_the_control_steps_of_the_run() -> None:
    walk = person("a", 0.0, 2.0).walk(0.5, STEP)
    assert len(walk.position) == 16
    assert walk.position[:, 0] == pytest.approx(0.5 + 0.1 * np.arange(16))


def test_a_person_who_stands_leaves_when_recorded_to() -> None:
    roster = Roster()
    people = [person("stands", 0.0, 2.0, 0.1), person("walks", 0.0, 2.0, 1.0)]
    RecordedPeople(people, roster, STEP, follow=False).enter(0)
    walking = Walking(RunConfig(), CrowdModel(SIM, STEP), roster)
    left = {}
    for step in range(60):
        for name in walking.advance(step, Vehicles.empty(), OPEN_GROUND):
            left[name] = step + 1
    assert left["stands"] == 20
    assert left["walks"] < 20  # 1.3 m/s to where the others were at 1 m/s


def test_who_is_simulated_reacts_from_the_step_after_the_entry() -> None:
    roster = Roster()
    source = RecordedPeople([person("a", 0.0, 2.0)], roster, STEP, follow=False)
    source.enter(0)
    assert roster.written.changes == [("a", False)]
    source.enter(1)
    assert roster.written.changes == [("a", False), ("a", True)]
