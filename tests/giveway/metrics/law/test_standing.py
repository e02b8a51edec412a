"""Crossings and junctions that the ego blocks; it is on the crossing from 20 m to 29 m."""

import numpy as np
import pytest
from support.crossing_world import NORTH, SIGNALLED, SOUTH, ZEBRA, Person, drive, to_a_stand

from giveway.metrics.law import ledger
from giveway.run_data.way import JunctionOnWay

ALWAYS = np.arange(0.0, 30.0, 0.05)


def leader(x):
    """A vehicle ahead that stands with its rear at ``x`` [m]."""
    return ("leader", ALWAYS, np.full(len(ALWAYS), x + 4.0), -1.75, 0.0)


def stand(front, seconds):
    return to_a_stand(front, (seconds, 0.0), (6.0, 1.5))


def judged(front, seconds, *people, **keywords):
    vehicles = [leader(front + 2.0)]
    found = ledger(drive(stand(front, seconds), *people, vehicles=vehicles, **keywords))
    return [event for event in found.violations if event.kind.startswith("blocked")], found.summary


@pytest.mark.parametrize(
    ("front", "seconds", "blocked"),
    [
        (19.9, 4.0, 0),
        (20.2, 4.0, 1),
        (24.5, 4.0, 1),
        (28.8, 4.0, 1),  # the rear is on it
        (29.2, 4.0, 0),
        (22.0, 1.5, 0),  # below the stop speed for 1.75 s
        (22.0, 2.0, 1),
    ],
)
def test_two_seconds_with_part_of_the_body_on_a_crossing(front, seconds, blocked):
    found, summary = judged(front, seconds)
    assert [event.place for event in found] == [":j_c0_0"] * blocked
    assert (summary.blocked_crossings, summary.blocked_junctions) == (blocked, 0)
    if blocked:
        assert found[0].value == pytest.approx(seconds + 0.2, abs=0.1)
        assert (found[0].x, found[0].y) == (pytest.approx(front, abs=0.2), -1.75)


@pytest.mark.parametrize(
    ("ahead", "aside", "blocked"),
    [(2.5, 0.0, 0), (3.6, 0.0, 1), (2.5, 1.2, 0), (2.5, 1.4, 1), (-3.0, 1.2, 1)],
)
def test_somebody_right_in_front_makes_it_stand_there(ahead, aside, blocked):
    person = Person([(22.0 + ahead, -1.75 + aside)] * 600, way=((80.0, 0.0),))
    assert len(judged(22.0, 4.0, person)[0]) == blocked


def test_one_stand_is_one_event_even_if_somebody_passes_in_front():
    places = [(24.0, -1.75 if 140 <= k < 150 else 30.0) for k in range(600)]
    found, _ = judged(22.0, 6.0, Person(places, way=((80.0, 0.0),)))
    assert len(found) == 1
    assert found[0].value == pytest.approx(5.15)  # since they passed


JUNCTION = JunctionOnWay(20.0, 40.0, (33.0,))


@pytest.mark.parametrize(
    ("front", "seconds", "blocked"),
    [
        (19.9, 4.0, 0),
        (21.0, 4.0, 1),
        (21.0, 1.5, 0),
        (32.0, 4.0, 0),  # at the place where it may wait
        (33.4, 4.0, 0),
        (29.5, 4.0, 1),
        (34.0, 4.0, 1),
        (44.5, 4.0, 1),  # the rear is still in it
        (45.5, 4.0, 0),
    ],
)
def test_a_junction_is_kept_free_but_for_its_waiting_places(front, seconds, blocked):
    found, summary = judged(front, seconds, crossings=(), junctions=(JUNCTION,))
    assert [event.place for event in found] == ["0"] * blocked
    assert (summary.blocked_crossings, summary.blocked_junctions) == (0, blocked)


def test_a_closed_crossing_is_blocked_only_for_people_on_it():
    signals = {"crossings": (SIGNALLED,), "lights": ((0.0, "r"),)}
    assert judged(22.0, 4.0, **signals)[0] == []
    late = Person([(22.0, 1.0)] * 600, way=((22.0, 20.0),))
    assert len(judged(22.0, 4.0, late, **signals)[0]) == 1
    assert len(judged(22.0, 4.0, crossings=(SIGNALLED,), lights=((0.0, "G"),))[0]) == 1


def test_who_lets_people_pass_at_the_next_crossing_blocks_none():
    following = ZEBRA._replace(lane=":j_c1_0", ends=((26.0, NORTH), (26.0, SOUTH)), width=2.0)
    both = {"crossings": (ZEBRA, following)}
    assert len(judged(24.0, 4.0, **both)[0]) == 1
    # somebody walks up and down the next one's kerb and never gets out of the ego's way
    waits = Person([(26.0, -2.9)] * 600, way=((26.0, 20.0),))
    assert judged(24.0, 4.0, waits, **both)[0] == []


def test_who_crosses_at_red_ahead_is_let_pass_as_well():
    following = SIGNALLED._replace(lane=":j_c1_0", ends=((26.0, NORTH), (26.0, SOUTH)), width=2.0)
    both = {"crossings": (ZEBRA, following), "lights": ((0.0, "r"),)}
    assert len(judged(24.0, 4.0, **both)[0]) == 1
    late = Person([(26.0, 1.0)] * 600, way=((26.0, 20.0),))
    assert judged(24.0, 4.0, late, **both)[0] == []


def test_at_a_waiting_place_in_a_junction_it_blocks_nothing():
    turning = {"junctions": (JUNCTION._replace(waiting=(23.5,)),)}
    assert judged(22.0, 4.0, **turning)[0] == []
    found, _ = judged(26.0, 4.0, **turning)
    assert [event.kind for event in found] == ["blocked crossing", "blocked junction"]
