"""Who is on a sidewalk beside an ego's way, and how far from its kerb."""

import numpy as np
import pytest
import shapely

from giveway.ego.perception.kerbs import NO_KERBS, Kerbs, kerb_lines
from giveway.ego.perception.sudden_starts import SuddenStarts
from giveway.geometry.path import EgoPath
from giveway.sumo.network.pedestrian_crossings import Crossing
from giveway.sumo.signal_plans import SignalChange, untold
from pedestrian_model import Crowd

EAST = EgoPath.through([(0.0, 0.0), (100.0, 0.0)])
WIDTH = 2.0
# 3 m wide, on either side of a road of two lanes of 3.5 m; the ego is on the southern one.
SIDEWALKS = shapely.union_all(
    [shapely.box(-5, -4.75, 105, -1.75), shapely.box(-5, 5.25, 105, 8.25)]
)
ZEBRA = Crossing("c", np.array([[60.0, -1.75], [60.0, 5.25]]), 4.0, True, "", -1)


def kerbs(path=EAST, sidewalks=SIDEWALKS, crossings=(ZEBRA,), change_of=untold):
    return Kerbs(path, WIDTH, lambda place: sidewalks.intersection(place), crossings, change_of)


def found_of(people, beside=None, front=15.0, velocity=None):
    still = np.zeros_like(people) if velocity is None else velocity
    return (beside or kerbs()).of(people, still, front)


def test_who_is_on_a_sidewalk_has_a_kerb():
    people = np.array([[20.0, -2.25], [21.3, -4.5], [30.0, 5.5], [40.0, -6.5]])
    expected = [[0.0, 1.0, 0.5], [0.0, 1.0, 2.75], [0.0, -1.0, 0.25], [0.0, 1.0, 4.75]]
    assert found_of(people) == pytest.approx(np.array(expected))


@pytest.mark.parametrize(
    ("where", "why"),
    [
        ((20.0, -1.7), "on the road, by a step"),
        ((20.0, 0.0), "before the ego"),
        ((20.0, -6.8), "far behind the sidewalk"),
        ((60.0, -2.0), "about to use the zebra"),
        ((63.4, -2.0), "beside the zebra"),
        ((60.0, 1.0), "on the zebra"),
        ((90.0, -2.0), "too far ahead to matter"),
    ],
)
def test_who_is_elsewhere_has_none(where, why):
    assert not found_of(np.array([where])).any(), why


def test_behind_the_mouth_of_a_zebra_there_is_a_kerb_again():
    found = found_of(np.array([[64.0, -2.0], [60.0, -3.5]]))
    assert found[:, 2] == pytest.approx([0.25, 1.75])


@pytest.mark.parametrize(("pace", "has_kerb"), [(0.2, True), (0.5, False)])
def test_who_stands_where_cars_have_priority_is_on_the_sidewalk(pace, has_kerb):
    ways = kerbs(crossings=[ZEBRA._replace(zebra=False)])
    one, walks = np.array([[60.0, -2.0]]), np.array([[pace, 0.0]])
    found = ways.of(one, walks, 15.0)
    assert (found[0, 2] == pytest.approx(0.25)) if has_kerb else not found.any()
    waiting = Crowd.create(one, walks, [1.3], [[(60.0, -1.75), (60.0, 5.25)]])
    kept = ways.kept(waiting, np.array([[0.0, 1.0, 0.25]]), None)
    assert bool(kept.any()) == has_kerb


SIGNALS = Crossing("s", ZEBRA.ends, 4.0, False, "tls", 0)


@pytest.mark.parametrize(
    ("state", "change", "has_kerb"),
    [
        ("", None, False),  # nobody knows the light
        ("G", SignalChange(9.0, "r"), False),
        ("r", None, True),
        ("r", SignalChange(9.0, "G"), True),
        ("r", SignalChange(2.0, "G"), False),  # in two seconds they set out
        ("r", SignalChange(2.0, "r"), True),  # the light changes for others
    ],
)
def test_before_a_red_light_people_are_on_the_sidewalk(state, change, has_kerb):
    beside = kerbs(crossings=(SIGNALS,), change_of={"tls": change}.get)
    assert beside.systems == {"tls"}
    beside.update({"tls": state})
    assert found_of(np.array([[60.0, -2.0]]), beside).any() == has_kerb
    assert found_of(np.array([[40.0, -2.0]]), beside).any()


@pytest.mark.parametrize(
    ("velocity", "ways", "keeps"),
    [
        ((1.2, 0.0), [(80.0, -3.0)], False),  # before the zebra in a second and a half
        ((0.8, 0.0), [(55.2, -3.0)], True),
        ((-1.2, 0.0), [(30.0, -3.0)], True),
        ((0.0, 0.0), [(30.0, -3.0)], True),
        ((-1.2, 0.0), [(80.0, -3.0)], False),  # pushed back, but on the way there
        ((1.2, 0.0), [(55.3, -3.0), (55.3, -4.5)], False),  # the velocity leads there, not the way
        ((0.0, -1.2), [(55.0, -3.1), (58.0, -3.0)], False),  # round a corner
    ],
)
def test_who_soon_is_at_a_crossing_is_planned_for_as_there(velocity, ways, keeps):
    beside = kerbs()
    crowd = Crowd.create(
        [[55.0, -3.0], [20.0, -3.0]], [velocity, (0.0, 0.0)], 1.2, [ways, [(10.0, -3.0)]]
    )
    now = beside.of(crowd.position, crowd.velocity, 15.0)
    kept = beside.kept(crowd, now, None)
    assert now[:, 2] == pytest.approx([1.25, 1.25])
    assert kept[:, 2] == pytest.approx([1.25 * keeps, 1.25])
    only = np.array([True, False])
    assert np.array_equal(beside.kept(crowd.select(only), now, only), kept[:1])


def test_where_the_light_stays_red_nobody_soon_is_at_a_crossing():
    beside = kerbs(crossings=(SIGNALS,), change_of={"tls": SignalChange(9.0, "r")}.get)
    beside.update({"tls": "r"})
    crowd = Crowd.create([[55.0, -3.0]], [(1.2, 0.0)], 1.2, [[(80.0, -3.0)]])
    now = beside.of(crowd.position, crowd.velocity, 15.0)
    assert np.array_equal(beside.kept(crowd, now, None), now)


@pytest.mark.parametrize(("opens", "keeps"), [(4.0, False), (9.0, True)])
def test_a_person_whose_light_turns_green_soon_counts_as_on_road(opens, keeps):
    beside = kerbs(crossings=(SIGNALS,), change_of={"tls": SignalChange(opens, "G")}.get)
    beside.update({"tls": "r"})
    crowd = Crowd.create([[60.0, -2.25]], [(0.0, 0.0)], 1.2, [[(60.0, 5.0)]])
    now = beside.of(crowd.position, crowd.velocity, 15.0)
    assert now[0, 2] == pytest.approx(0.5)
    assert beside.kept(crowd, now, None)[0, 2] == pytest.approx(0.5 * keeps)


def test_on_the_strip_that_the_ego_sweeps_there_is_no_sidewalk():
    """A network in which a sidewalk reaches into the lane."""
    over = shapely.union_all([SIDEWALKS, shapely.box(20, -4.75, 30, -0.5)])
    found = found_of(np.array([[25.0, -1.2], [25.0, -1.5]]), kerbs(sidewalks=over))
    assert found[0, 2] == 0.0
    assert found[1, 2] == pytest.approx(0.25)


def test_in_a_bend_the_kerb_is_where_it_is_nearest():
    angles = np.linspace(0.0, np.pi / 2, 40)
    bend = EgoPath.through([(12.0 * np.sin(a), 12.0 * (1.0 - np.cos(a))) for a in angles])
    ring = (
        shapely.Point(0.0, 12.0)
        .buffer(16.0, 64)
        .difference(shapely.Point(0.0, 12.0).buffer(13.75, 64))
    )
    there = np.array([[14.25 * np.sin(0.7), 12.0 - 14.25 * np.cos(0.7)]])
    found = found_of(there, kerbs(bend, ring, ()), front=2.0)
    assert found[0] == pytest.approx([-np.sin(0.7), np.cos(0.7), 0.5], abs=0.02)


def test_where_the_path_comes_by_again_there_are_kerbs_again():
    """Round the block, and along the same road once more."""
    block = [(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)]
    twice = EgoPath.through([*block, *block, block[0]])
    people = np.array([[50.0, -2.25]])
    assert found_of(people, kerbs(twice), front=30.0)[0] == pytest.approx([0.0, 1.0, 0.5])
    assert found_of(people, kerbs(twice), front=430.0)[0] == pytest.approx([0.0, 1.0, 0.5])
    assert not found_of(people, kerbs(twice), front=230.0).any()


# The sidewalk becomes narrower at x = 40 m: its kerb is 1.5 m farther from the lane from there on.
NARROWER = shapely.union_all(
    [shapely.box(-5, -4.75, 40, -1.75), shapely.box(39, -4.75, 105, -3.25)]
)


@pytest.mark.parametrize(
    ("velocity", "expected"),
    [
        ((1.3, 0.0), [0.0, 1.0, 0.25]),  # along it: the line of the kerb ahead
        ((-1.3, 0.0), [np.sqrt(0.8), np.sqrt(0.2), np.sqrt(0.3125)]),  # away from where it begins
        ((0.0, 1.3), [np.sqrt(0.8), np.sqrt(0.2), np.sqrt(0.3125)]),  # they are sooner at its line
    ],
)
def test_a_kerb_ahead_counts_where_it_takes_longer_to_reach(velocity, expected):
    people = np.array([[39.5, -3.5]])
    found = found_of(people, kerbs(sidewalks=NARROWER, crossings=()), 30.0, np.array([velocity]))
    assert found[0] == pytest.approx(expected)


def test_a_line_that_other_kerbs_cross_does_not_count():
    """The ego turns right, round the block that the person is on."""
    right = EgoPath.through([(0.0, 0.0), (50.0, 0.0), (50.0, -50.0)])
    block = shapely.union_all([shapely.box(-5, -60, 40, -1.75), shapely.box(39, -60, 48, -3.25)])
    people, velocity = np.array([[39.5, -3.5]]), np.array([(1.3, 0.0)])
    found = found_of(people, kerbs(right, block, ()), 30.0, velocity)
    assert found[0] == pytest.approx([np.sqrt(0.8), np.sqrt(0.2), np.sqrt(0.3125)])


def test_where_there_is_no_sidewalk_nobody_is_on_one():
    none = kerbs(sidewalks=shapely.MultiPolygon())
    assert not none
    assert kerbs()


def test_a_kerb_as_a_line_is_where_it_was():
    people = np.array([[20.0, -2.25], [20.0, 0.0]])
    lines = kerb_lines(people, found_of(people))
    assert lines == pytest.approx(np.array([[0.0, 1.0, -1.75], [0.0, 0.0, 0.0]]))
    assert kerb_lines(people, NO_KERBS) is NO_KERBS


def test_who_sets_out_too_suddenly_is_named_once_it_does():
    watch = SuddenStarts(0.6, 0.1)
    behind = np.array([[0.0, 1.0, 0.5], [0.0, 1.0, 0.5], [0.0, 0.0, 0.0]])
    still, who = np.zeros((3, 2)), np.array([4, 7, 9])
    assert not len(watch.beyond(who, still, behind))
    gently = np.array([[1.0, 0.05], [0.0, 0.07], [0.0, 3.0]])  # 7 by 0.7 m/s^2; 9 is on the road
    assert watch.beyond(who, gently, behind).tolist() == [7]
    left = np.array([9, 7])  # 4 has gone, 9 is on the sidewalk now
    assert not len(watch.beyond(left, np.array([[0.0, 9.0], [0.0, 0.07]]), behind[:2]))
    assert watch.beyond(left, np.array([[0.0, 9.1], [0.0, 0.0]]), behind[:2]).tolist() == [9]
