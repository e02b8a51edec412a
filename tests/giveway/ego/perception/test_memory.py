"""The memory of a sensor: people who were seen are expected to walk on, for a while."""

import numpy as np
import pytest

from giveway.ego.perception.memory import Memory
from pedestrian_model import Crowd

PLACES, WALK = np.array([[5.0, 1.0], [9.0, 0.0]]), np.array([[1.0, 0.0], [0.0, -1.0]])
PEOPLE = Crowd.create(PLACES, WALK, 1.3, [[place] for place in PLACES + 9.0])
IDS = np.array([7, 2])


def test_who_was_seen_is_expected_farther_on_within_a_bound_that_grows() -> None:
    memory = Memory(span=1.0, turns=0.1, acceleration=2.0)
    seen = np.array([True, False])
    memory.learn(IDS, PLACES, WALK, seen, np.full(2, 0.05), then=3.0)
    percept = memory.percept(PEOPLE, IDS, now=3.5, delay=0.0)
    assert percept.person_ids.tolist() == [7]
    assert percept.people.position.tolist() == [[5.5, 1.0]]
    assert percept.age == pytest.approx([0.5])
    assert percept.position_bound == pytest.approx([0.05 + 0.5 * 0.1 + 0.5 * 2.0 * 0.25])
    assert percept.velocity_bound == pytest.approx([0.1 + 2.0 * 0.5])


@pytest.mark.parametrize(("now", "known"), [(4.0, 2), (4.05, 0)])
def test_who_is_lost_is_forgotten_after_the_span(now: float, known: int) -> None:
    memory = Memory(span=1.0, turns=0.0, acceleration=3.0)
    memory.learn(IDS, PLACES, WALK, np.ones(2, dtype=np.bool_), np.zeros(2), then=3.0)
    assert len(memory.percept(PEOPLE, IDS, now, delay=0.0).person_ids) == known


def test_a_miss_lasts_for_its_time_and_begins_by_chance() -> None:
    memory = Memory(span=1.0, turns=0.0, acceleration=3.0)
    draws = np.linspace(0.0, 1.0, len(memory.rows(IDS)))
    assert memory.noticed(IDS, draws, begins=0.2, now=0.0, span=0.5).tolist() == [True, False]
    never = np.ones(len(draws))
    assert memory.noticed(IDS, never, begins=0.2, now=0.4, span=0.5).tolist() == [True, False]
    assert memory.noticed(IDS, never, begins=0.2, now=0.5, span=0.5).all()
