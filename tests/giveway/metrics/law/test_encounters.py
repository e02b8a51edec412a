"""Who is met at a crossing, and who is not let pass; each definition from both of its sides."""

from dataclasses import replace

import numpy as np
import pytest
from support.crossing_world import (
    ENTRY,
    NORTH,
    SIGNALLED,
    SOUTH,
    UNMARKED,
    Person,
    R,
    drive,
    ego,
    to_a_stand,
    walker,
)

from giveway.metrics.law import Undisturbed, ledger

THROUGH = ego((15.0, 0.0))  # at 4 m/s over the crossing, on it from 5 s on
WAITS = to_a_stand(19.0, (8.0, 0.0), (5.0, 1.5))  # stands from 5.75 s to 13.75 s
CLEAR = -0.75 + R  # [m] y of a body that comes from the south and has left the ego's way


def kinds(found):
    return [event.kind for event in found.violations]


def judged(*arguments, **keywords):
    return ledger(drive(*arguments, **keywords))


@pytest.mark.parametrize(
    "person",
    [
        walker(-4.3, since=3.6),  # from the nearer kerb, just in front of it
        walker(-2.0, speed=0.0, since=3.0),  # stands in its way
        walker(4.3, speed=-1.4, since=1.9),  # from the other kerb
        walker(-4.3, since=3.6, x=20.1),  # at the crossing's edge
    ],
)
def test_an_ego_that_drives_through_fails_to_yield_a_waiting_not(person):
    wrong = judged(THROUGH, person)
    assert kinds(wrong) == ["failure to yield"]
    assert (wrong.summary.encounters, wrong.summary.failures_to_yield) == (1, 1)
    assert wrong.summary.yielding_rate == 0.0
    (event,) = wrong.violations
    assert event.time == pytest.approx(5.0, abs=0.02)
    assert (event.other, event.place, event.unit) == ("ped0", ":j_c0_0", "s")


@pytest.mark.parametrize(
    ("person", "wait"),
    [
        (walker(-4.3, since=3.6), 1.5),
        (walker(4.3, speed=-1.4, since=1.9), 1.5),
        (walker(-4.3, since=6.0), 4.0),
    ],
)
def test_who_waits_until_they_have_left_its_way_yields(person, wait):
    right = judged(to_a_stand(19.0, (wait, 0.0), (5.0, 1.5)), person)
    assert right.violations == ()
    assert (right.summary.encounters, right.summary.yielding_rate) == (1, 1.0)


@pytest.mark.parametrize(
    ("margin", "fails"), [(0.1, False), (0.02, False), (-0.02, True), (-0.1, True)]
)
def test_a_tenth_of_a_second_decides(margin, fails):
    """The person has left the ego's way this long [s] before the ego enters, at 5 s."""
    person = walker(CLEAR - 1.4 * (5.0 - margin), since=0.0)
    found = judged(THROUGH, person)
    assert found.summary.encounters == 1
    assert found.summary.failures_to_yield == fails
    if fails:
        (event,) = found.violations
        assert event.value == pytest.approx(-margin, abs=0.02)


@pytest.mark.parametrize(("room", "encounters"), [(2.70, 1), (2.64, 0)])
def test_who_comes_when_it_cannot_stop_any_more_is_not_met(room, encounters):
    """From 4 m/s 3 m/s^2 stops it within 2.67 m; then somebody is there who was not before."""
    front = ENTRY - room - 16.0
    person = walker(-3.4, speed=0.0, since=4.0)
    found = judged(ego((15.0, 0.0), front=front), person, front=front)
    assert found.summary.encounters == encounters
    assert found.summary.failures_to_yield == encounters


@pytest.mark.parametrize(("seconds", "encounters"), [(3.9, 1), (4.1, 0)])
def test_who_needs_longer_than_four_seconds_is_not_met(seconds, encounters):
    away = 0.3 + (NORTH + 0.75 - R)  # from 0.3 m before the northern kerb to the ego's way
    person = walker(NORTH + 0.3, speed=0.0, way=((22.0, -20.0),), desired=away / seconds)
    assert judged(THROUGH, person).summary.encounters == encounters


@pytest.mark.parametrize(("beyond", "encounters"), [(0.95, 1), (1.05, 0)])
def test_people_over_a_metre_from_the_kerb_are_not_met(beyond, encounters):
    assert judged(THROUGH, walker(SOUTH - beyond, speed=0.0)).summary.encounters == encounters


@pytest.mark.parametrize(("x", "encounters"), [(19.5, 1), (19.1, 0)])
def test_beside_the_crossing_the_distance_to_its_edge_counts(x, encounters):
    person = walker(-4.2, speed=0.0, x=x, way=((21.0, -3.4), (21.0, 20.0)))
    assert judged(THROUGH, person).summary.encounters == encounters


@pytest.mark.parametrize(("y", "encounters"), [(CLEAR - 0.1, 1), (CLEAR + 0.1, 0)])
def test_who_has_left_the_way_is_not_met(y, encounters):
    assert judged(THROUGH, walker(y, speed=0.0, since=3.0)).summary.encounters == encounters


@pytest.mark.parametrize(("beyond", "encounters"), [(1.2, 1), (0.8, 0)])
def test_who_is_first_seen_on_the_crossing_has_entered_by_right(beyond, encounters):
    person = walker(SOUTH + beyond, speed=0.0, since=3.0)
    found = judged(THROUGH, person, crossings=[SIGNALLED], lights=[(0.0, "r")])
    assert found.summary.encounters == encounters
    found = judged(THROUGH, person, crossings=[UNMARKED])
    assert found.summary.encounters == 0


@pytest.mark.parametrize(
    "way",
    [
        ((40.0, -4.0),),  # along the kerb
        ((22.0, -20.0),),  # away from it
        ((22.0, -3.3), (22.0, -20.0)),  # a step onto it and back
        ((22.0, -3.2),),  # a step onto it
    ],
)
def test_who_does_not_head_for_the_crossing_is_not_met(way):
    assert judged(THROUGH, walker(-4.0, speed=0.0, way=way)).summary.encounters == 0


def test_a_way_round_a_corner_onto_the_crossing_counts():
    way = ((22.0, -3.6), (22.0, 3.6), (60.0, 5.0))
    assert judged(THROUGH, walker(-4.2, speed=0.0, x=20.5, way=way)).summary.encounters == 1


def test_who_will_be_gone_before_it_could_be_there_is_not_met():
    """From 0.5 m beyond its kerb to beyond its way takes 1.8 s; 5 s more are 27.2 m at 4 m/s."""
    person = walker(-3.0, since=0.0)
    for front, encounters in ((-7.1, 1), (-7.3, 0)):
        far = ego((15.0, 0.0), front=front)
        assert judged(far, person, front=front).summary.encounters == encounters


@pytest.mark.parametrize(
    ("lights", "since", "encounters"),
    [
        ([(0.0, "G")], 3.6, 1),
        ([(0.0, "g")], 3.6, 1),
        ([(0.0, "r")], 3.6, 0),
        ([(0.0, "G"), (3.0, "r")], 3.6, 0),  # too late
        ([(0.0, "G"), (4.7, "r")], 3.6, 1),  # entered at 4.17 s, and may finish
        ([(0.0, "r"), (4.7, "G")], 3.6, 0),  # entered against red; then the ego cannot stop
        ([(0.0, "O")], 3.6, 1),  # out of order: as at a zebra
    ],
)
def test_their_light_decides_on_priority(lights, since, encounters):
    found = judged(THROUGH, walker(-4.3, since=since), crossings=[SIGNALLED], lights=lights)
    assert found.summary.encounters == encounters
    assert found.summary.failures_to_yield == encounters


def test_entering_as_the_light_turns_red_loses_priority():
    person = Person([(22.0, -4.3)] * 300, way=((22.0, 20.0),))  # stays at the kerb
    lights = [(0.0, "G"), (4.0, "r")]
    found = judged(THROUGH, person, crossings=[SIGNALLED], lights=lights)
    assert (found.summary.encounters, found.summary.yielding_rate) == (1, 1.0)
    assert found.violations == ()


def test_without_a_zebra_or_light_nobody_has_priority():
    assert judged(THROUGH, walker(-4.3, since=3.6), crossings=[UNMARKED]).summary.encounters == 0


def test_each_person_counts_once():
    people = [walker(-4.3, since=3.6), walker(-4.3, since=3.6, x=23.0), walker(-9.0, since=12.0)]
    found = judged(THROUGH, *people)
    assert (found.summary.encounters, found.summary.failures_to_yield) == (2, 2)
    assert [event.other for event in found.violations] == ["ped0", "ped1"]


@pytest.mark.parametrize(("back", "rows"), [(0.5, 1), (0.2, 0)])
def test_who_is_pushed_back_is_found(back, rows):
    """Somebody walks to the middle of the northern lane, goes back and stays there."""
    t = np.arange(270) * 0.05
    y = np.interp(t, [0.0, 4.0, 5.0, 9.0], [4.4, 1.0, 1.0 + back, 1.0 + back])
    person = Person(np.column_stack([np.full(270, 22.0), y]), way=((22.0, -20.0),))
    found = judged(WAITS, person)
    assert found.summary.pushed_back == pytest.approx(back)
    assert kinds(found) == ["pushed back"] * rows
    if rows:
        (event,) = found.violations
        assert event.time == pytest.approx(4.0)
        assert (event.other, event.y, event.value) == ("ped0", pytest.approx(1.0), 0.5)


def test_only_a_near_ego_pushes_back_people_with_priority():
    t = np.arange(200) * 0.05
    y = np.interp(t, [0.0, 3.0, 4.0, 9.0], [4.4, 1.0, 1.5, 1.5])
    person = Person(np.column_stack([np.full(200, 22.0), y]), way=((22.0, -20.0),))
    red = judged(WAITS, person, crossings=[SIGNALLED], lights=[(0.0, "r")])
    assert red.summary.pushed_back == 0.0
    far = judged(ego((15.0, 0.0), speed=0.0, front=-1.0), person, front=-1.0)
    assert far.summary.pushed_back == 0.0


@pytest.mark.parametrize(
    ("front", "speed", "rows"),
    [(14.0, 0.0, 0), (15.0, 1.0, 1), (13.0, 1.0, 0), (2.0, 4.0, 1), (-4.0, 4.0, 0), (19.0, 0.0, 1)],
)
def test_an_ego_that_is_away_from_them_pushes_nobody_back(front, speed, rows):
    """Others do, as the ego stands 7 m away, or as its speed brings it no nearer than 2 m soon."""
    t = np.arange(120) * 0.05
    y = np.interp(t, [0.0, 3.0, 4.0, 9.0], [4.4, -0.2, 0.5, 0.5])
    person = Person(np.column_stack([np.full(120, 21.0), y]), way=((21.0, -20.0),))
    found = judged(ego((6.0, 0.0), speed=speed, front=front), person, front=front)
    assert kinds(found).count("pushed back") == rows


@pytest.mark.parametrize(
    ("back", "later", "pushed"),
    [(0.0, 0.0, 0.5), (0.4, 0.5, 0.1), (0.5, 0.0, 0.0), (0.5, 9.0, 0.5)],
)
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_what_happens_in_the_twin_as_well_is_not_the_egos_doing(back, later, pushed, side):
    t = np.arange(270) * 0.05
    y = side * np.interp(t, [0.0, 4.0, 5.0, 9.0], [4.4, 1.0, 1.5, 1.5])
    person = Person(np.column_stack([np.full(270, 22.0), y]), way=((22.0, -20.0 * side),))
    there = side * np.interp(t - later, [0.0, 4.0, 5.0, 9.0], [4.4, 1.0, 1.0 + back, 1.0 + back])
    twin = Undisturbed(np.arange(270), np.zeros(270, dtype=np.int64), np.full(270, 22.0), there)
    found = ledger(replace(drive(WAITS, person), undisturbed=twin))
    assert found.summary.pushed_back == pytest.approx(pushed)
    assert kinds(found).count("pushed back") == (pushed > 0.3)


def test_how_long_people_stand_at_a_zebra():
    t = np.arange(280) * 0.05
    stands = np.interp(t, [0.0, 1.0, 4.0, 14.0], [-4.9, -3.7, -3.7, 10.0])
    person = Person(np.column_stack([np.full(280, 22.0), stands]))
    found = judged(WAITS, person, walker(-4.3, since=9.0))
    assert found.summary.encounters == 2
    assert found.summary.longest_zebra_wait == pytest.approx(3.0, abs=0.11)
    assert found.summary.mean_zebra_wait == pytest.approx(1.5, abs=0.06)
    assert np.isnan(judged(WAITS).summary.mean_zebra_wait)
    at_lights = judged(WAITS, person, crossings=[SIGNALLED], lights=[(0.0, "G")])
    assert at_lights.summary.encounters == 1
    assert np.isnan(at_lights.summary.longest_zebra_wait)


@pytest.mark.parametrize(("front", "encounters"), [(2.0, 1), (-4.0, 0)])
def test_an_ego_that_stands_would_have_to_speed_up_first(front, encounters):
    """In 6.8 s it comes 23.2 m far with 2 m/s^2 to 4 m/s, and not 27.2 m."""
    person = walker(-3.0, since=0.0)
    track = ego((0.1, 0.0), (4.0, 1.0), (8.0, 0.0), front=front, speed=0.0)
    assert judged(track, person, front=front).summary.encounters == encounters
