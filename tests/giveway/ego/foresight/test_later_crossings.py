"""Who comes onto the ego's way beyond the horizon, by hand."""

import numpy as np
import pytest

from giveway.ego.foresight.later_crossings import fill_later_crossings
from giveway.geometry.path import EgoPath

STRAIGHT = EgoPath.through([(0.0, 0.0), (100.0, 0.0)])
BEND = EgoPath.through([(0.0, 0.0), (20.0, 0.0), (20.0, 50.0)])
HALF = 1.5  # [m]
FOR_EVER = np.inf


def later_crossings(*people, path=STRAIGHT, front=10.0):
    given = np.array(people, dtype=float)
    found = np.empty((len(people), 4))
    fill_later_crossings(path.vertices, path.stations, front, HALF, given, found)
    return found.tolist()


def test_who_crosses_comes_at_one_edge_and_leaves_at_the_other():
    [found] = later_crossings((16.0, -4.5, 0.0, 1.5, FOR_EVER))
    assert found == pytest.approx([6.0, 0.0, 2.0, 4.0])
    [back] = later_crossings((16.0, 4.5, 0.0, -1.5, FOR_EVER))
    assert back == pytest.approx(found)


def test_who_crosses_slantwise_is_elsewhere_by_then():
    [found] = later_crossings((16.0, -3.0, -0.5, 1.0, FOR_EVER))
    assert found == pytest.approx([6.0, -0.5, 1.5, 4.5])


def test_who_is_on_the_way_already_leaves_it():
    [found] = later_crossings((12.0, 0.5, 0.0, 1.0, FOR_EVER))
    assert found == pytest.approx([2.0, 0.0, 0.0, 1.0])


@pytest.mark.parametrize(
    "person",
    [
        (16.0, 4.0, 0.0, 1.0, FOR_EVER),  # walks away
        (16.0, 4.0, 1.3, 0.0, FOR_EVER),  # beside the way
        (16.0, -4.5, 0.0, 1.5, 1.9),  # stops at the kerb
        (16.0, 4.0, 0.0, 0.0, FOR_EVER),  # stands beside it
    ],
)
def test_who_does_not_come_onto_the_way_never_does(person):
    [(*_, leaves)] = later_crossings(person)
    assert leaves == 0.0


def test_who_arrives_on_the_way_is_gone_then():
    [found] = later_crossings((16.0, -4.5, 0.0, 1.5, 3.0))
    assert found[2:] == pytest.approx([2.0, 3.0])


def test_who_walks_along_the_way_stays_on_it():
    [found] = later_crossings((16.0, 0.5, 1.2, 0.0, FOR_EVER))
    assert found == pytest.approx([6.0, 1.2, 0.0, FOR_EVER])


def test_behind_a_bend_people_cross_its_second_leg():
    """20 m ahead of a front that is 5 m before the bend: 15 m up the second leg."""
    [found] = later_crossings((24.5, 15.0, -1.5, 0.0, FOR_EVER), path=BEND, front=15.0)
    assert found == pytest.approx([20.0, 0.0, 2.0, 4.0])
