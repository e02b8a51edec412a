"""Conflict areas: where the ego's body sweeps over a crossing."""

import pytest
from support.crossing_world import (
    NORTH,
    drive,
    ego,
)

from giveway.metrics.law.areas import areas_of

THROUGH = ego((15.0, 0.0))  # at 4 m/s over the crossing, on it from 5 s on


def test_the_area_is_where_the_body_sweeps_over_the_crossing():
    (area,) = areas_of(drive(THROUGH))
    assert (area.entry, area.leave) == pytest.approx((20.0, 29.0), abs=0.06)
    assert (area.low, area.high) == pytest.approx((NORTH + 0.75, NORTH + 2.75))


def test_in_a_bend_only_what_is_on_the_crossing_counts():
    """The lane turns left 3 m behind the crossing: the front goes north, the rear swings south."""
    bend = ((0.0, -1.75), (27.0, -1.75), (27.0, 30.0))
    (area,) = areas_of(drive(THROUGH, points=bend))
    assert 3.5 < area.low < NORTH + 0.75 - 0.2
    assert NORTH + 2.75 + 0.2 < area.high <= area.length
    assert area.leave > 30.0


def test_an_area_beyond_the_end_of_the_drive_counts_for_nothing():
    assert areas_of(drive(THROUGH, goal=19.0)) == ()
    assert len(areas_of(drive(THROUGH, goal=21.0))) == 1


def test_a_way_that_comes_by_again_has_an_area_each_time():
    """Once round the block: what is far from the crossing in between is not looked at."""
    block = ((0.0, -1.75), (60.0, -1.75), (60.0, 400.0), (-40.0, 400.0), (-40.0, -1.75))
    first, again = areas_of(drive(THROUGH, points=(*block, (45.0, -1.75))))
    assert (first.entry, first.leave) == pytest.approx((20.0, 29.0), abs=0.06)
    assert again.entry - first.entry == pytest.approx(2 * (100.0 + 401.75), abs=0.06)
    assert again.leave - first.leave == pytest.approx(2 * (100.0 + 401.75), abs=0.06)
    assert (first.low, first.high) == pytest.approx((again.low, again.high))
