"""Stops that the road explains, and one that it does not; the ego stands at 30 m from 8.5 s on."""

import numpy as np
import pytest
from support.crossing_world import Person, drive, ego, to_a_stand, walker

from giveway.metrics.law import ledger
from giveway.run_data.way import CrossingOnWay, Halt, JunctionOnWay, StopLine

ALWAYS = np.arange(0.0, 40.0, 0.05)
STANDS = to_a_stand(30.0, (4.0, 0.0), (6.0, 1.5))  # until 12.5 s
FAR_CROSSING = CrossingOnWay(":far_c0_0", ((33.0, 3.5), (33.0, -3.5)), 4.0, True, "", -1)


def judged(*people, track=STANDS, crossings=(), **keywords):
    return ledger(drive(track, *people, crossings=crossings, **keywords))


def car(x, y=-1.75, heading=0.0, times=ALWAYS):
    return ("car", times, x, np.full(len(times), y), heading)


def crosser(at, x=36.0):
    """A car that crosses the ego's lane northward, in its middle at ``at`` [s]."""
    return ("foe", ALWAYS, np.full(len(ALWAYS), x), -1.75 + 2.0 + 8.0 * (ALWAYS - at), np.pi / 2)


def hesitant(at, waits):
    """A car that would cross as above, but waits 6 m before for so long [s]."""
    stands = at - 1.0
    y = np.interp(ALWAYS, [0.0, stands, stands + waits, 60.0], [-8.0 * stands, 0.0, 0.0, 250.0])
    return ("foe", ALWAYS, np.full(len(ALWAYS), 36.0), -9.0 + y, np.pi / 2)


def follower():
    """A car that comes to stand 3 m behind the ego and follows it."""
    return ("foe", ALWAYS, np.interp(ALWAYS, [0, 8, 13, 40], [0, 22, 22, 150]), -1.75, 0.0)


def test_a_stop_for_nothing_is_found_once():
    found = judged()
    assert [event.kind for event in found.violations] == ["stop without cause"]
    assert found.summary.stops_without_cause == 1
    (event,) = found.violations
    assert event.time == pytest.approx(8.45, abs=0.06)
    assert event.value == pytest.approx(4.2, abs=0.1)


def test_a_moment_without_a_cause_counts():
    track = to_a_stand(30.0, (0.2, 0.0), (6.0, 1.5))
    assert judged(track=track).summary.stops_without_cause == 1


@pytest.mark.parametrize(
    ("line", "sign", "stops"), [(31.0, True, 0), (31.0, False, 1), (29.0, True, 1), (35.0, True, 1)]
)
def test_one_stands_before_a_stop_sign(line, sign, stops):
    track = to_a_stand(30.0, (1.5, 0.0), (6.0, 1.5))
    place = JunctionOnWay(line, 40.0, (), stop_sign=sign)
    assert judged(track=track, junctions=(place,)).summary.stops_without_cause == stops


def test_a_drive_without_a_stop_has_none():
    assert judged(track=ego((15.0, 0.0))).violations == ()


@pytest.mark.parametrize(
    ("there", "stops"),
    [
        ({"vehicles": [car(35.0 + 4.0)]}, 0),  # a leader, 5 m ahead
        ({"vehicles": [car(41.0 + 4.0)]}, 1),  # too far ahead
        ({"vehicles": [car(35.0 + 4.0, y=1.75)]}, 1),  # on the other lane
        ({"vehicles": [car(28.0)]}, 1),  # behind its front
        ({"vehicles": [crosser(14.0)]}, 0),  # comes by within 6 s from each instant
        ({"vehicles": [crosser(30.0)]}, 1),
        ({"vehicles": [crosser(5.0)]}, 1),  # was gone
        ({"vehicles": [hesitant(12.0, 20.0)]}, 0),  # would have come, and has to wait for others
        ({"vehicles": [hesitant(6.0, 20.0)]}, 1),  # waits already
        ({"vehicles": [follower()]}, 1),  # comes by as soon as the ego has gone on
        ({"vehicles": [crosser(14.0, x=45.0)]}, 1),  # elsewhere
        # at the far end of the junction in which, or before which, it waits
        (
            {
                "vehicles": [crosser(14.0, x=45.0)],
                "junctions": (JunctionOnWay(28.0, 50.0, (30.0,)),),
            },
            0,
        ),
        ({"vehicles": [crosser(14.0, x=45.0)], "junctions": (JunctionOnWay(32.0, 50.0, ()),)}, 0),
        ({"vehicles": [crosser(14.0, x=45.0)], "junctions": (JunctionOnWay(41.0, 50.0, ()),)}, 1),
        ({"vehicles": [car(43.0 + 4.0)], "crossings": (FAR_CROSSING,)}, 0),  # a blocked exit
        ({"vehicles": [car(44.0 + 4.0)], "crossings": (FAR_CROSSING,)}, 1),  # room enough
        ({"vehicles": [car(44.0 + 4.0)], "junctions": (JunctionOnWay(32.0, 40.0, ()),)}, 0),
        ({"junctions": (JunctionOnWay(31.0, 40.0, (), stop_sign=True),)}, 1),  # for too long
        ({"lines": (StopLine(31.0, "tls", 0),), "lights": [(0.0, "r")]}, 0),
        ({"lines": (StopLine(31.0, "tls", 0),), "lights": [(0.0, "r"), (11.0, "G")]}, 0),
        ({"lines": (StopLine(31.0, "tls", 0),), "lights": [(0.0, "r"), (9.0, "G")]}, 1),
        ({"lines": (StopLine(31.0, "tls", 0),), "lights": [(0.0, "G")]}, 1),
        ({"lines": (StopLine(42.0, "tls", 0),), "lights": [(0.0, "r")]}, 1),
        ({"halts": (Halt(20.0, 30.0),)}, 0),
        ({"halts": (Halt(40.0, 50.0),)}, 1),
    ],
)
def test_what_the_road_shows(there, stops):
    assert judged(**there).summary.stops_without_cause == stops


@pytest.mark.parametrize(
    ("person", "stops"),
    [
        (Person([(36.0, -1.75)] * 600), 0),  # on the carriageway ahead
        (Person([(36.0, -0.1)] * 600), 0),  # beside its way, near enough
        (Person([(36.0, 0.2)] * 600), 1),
        (Person([(41.0, -1.75)] * 600), 1),  # too far ahead
        (Person([(28.0, -1.75)] * 600), 1),  # below it, as far as it knows: not ahead
        (walker(-12.0, since=4.0, x=36.0), 0),  # walks onto its way within 4 s, then is on it
        (walker(-30.0, since=4.0, x=36.0), 1),  # comes much later
    ],
)
def test_people_on_the_carriageway_ahead(person, stops):
    assert judged(person).summary.stops_without_cause == stops


def test_people_at_the_far_end_of_the_junction_before_which_it_waits():
    person = walker(-12.0, since=4.0, x=45.0)
    place = JunctionOnWay(32.0, 50.0, ())
    assert judged(person).summary.stops_without_cause == 1
    assert judged(person, junctions=(place,)).summary.stops_without_cause == 0
    later = walker(-30.0, since=4.0, x=45.0)
    assert judged(later, junctions=(place,)).summary.stops_without_cause == 1


def test_an_encounter_is_a_cause_before_its_crossing_only():
    person = Person([(33.0, 3.8)] * 600, way=((33.0, -20.0),), desired=1.4)
    assert judged(person, crossings=(FAR_CROSSING,)).summary.stops_without_cause == 0
    away = FAR_CROSSING._replace(ends=((50.0, 3.5), (50.0, -3.5)))
    person = Person([(50.0, 3.8)] * 600, way=((50.0, -20.0),), desired=1.4)
    found = judged(person, crossings=(away,))
    assert (found.summary.encounters, found.summary.stops_without_cause) == (1, 1)


def test_an_ego_that_departs_standing_has_three_seconds():
    assert judged(track=ego((2.5, 0.0), (6.0, 1.5), speed=0.0)).summary.stops_without_cause == 0
    assert judged(track=ego((3.5, 0.0), (6.0, 1.5), speed=0.0)).summary.stops_without_cause == 1


def test_each_stop_counts_once():
    twice = to_a_stand(30.0, (2.0, 0.0), (2.0, 1.5), (2.0, -1.5), (2.0, 0.0), (3.0, 1.5))
    assert judged(track=twice).summary.stops_without_cause == 2


def test_on_a_way_that_passes_twice_a_leader_is_near_the_ego():
    twice = (
        (20.0, -1.75),
        (90.0, -1.75),
        (90.0, 40.0),
        (-20.0, 40.0),
        (-20.0, -1.75),
        (90.0, -1.75),
    )
    second_time = {"points": twice, "front": 283.5}
    assert judged(vehicles=[car(35.0 + 4.0)], **second_time).violations == ()
    assert len(judged(vehicles=[car(41.0 + 4.0)], **second_time).violations) == 1
