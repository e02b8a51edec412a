"""The cost to go: the time that is lost behind the horizon."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from controller._jit import kernel
from controller.planning.cost_to_go import time_to_go

time_to_go = kernel(time_to_go)


NOBODY_LATER = np.empty((0, 4))


def crosser(ahead, enters, leaves, along=0.0):
    return np.array([[ahead, along, enters, leaves]])


def test_who_has_been_passed_or_is_late_costs_no_time():
    assert time_to_go(NOBODY_LATER, 4.0, 4.0) == 0.0
    assert time_to_go(crosser(-1.0, 0.0, 3.0), 4.0, 4.0) == 0.0  # behind the front
    assert time_to_go(crosser(4.0, 1.5, 3.0), 4.0, 4.0) == 0.0  # the ego is there after 1 s
    assert time_to_go(crosser(4.0, 0.0, 0.0), 4.0, 4.0) == 0.0  # never comes


def test_speed_is_regained_with_what_driving_off_allows():
    """From 2 to 4 m/s with 2.5 m/s^2: 0.8 s at 3 m/s in the mean, of which a quarter is lost."""
    assert time_to_go(NOBODY_LATER, 2.0, 4.0) == pytest.approx(0.2, abs=0.06)


def test_the_base_policy_arrives_when_crossing_people_have_left():
    """8 m ahead, gone after 4 s: 2.0 m/s less 1 m of distance keep it from standing there."""
    lost = time_to_go(crosser(8.0, 0.0, 4.0), 4.0, 4.0)
    # It is a metre short of 8 m after 4 s instead of 1.75 s, then regains its speed.
    assert lost == pytest.approx(4.0 - 7.0 / 4.0 + 0.3, abs=0.35)


def test_who_stays_costs_the_whole_of_what_is_left():
    standing = time_to_go(crosser(1.0, 0.0, np.inf), 0.0, 4.0)
    assert standing == pytest.approx(6.0)
    assert 0.0 < time_to_go(crosser(12.0, 0.0, np.inf), 4.0, 4.0) < standing


def test_who_walks_ahead_along_the_way_is_followed():
    followed = time_to_go(crosser(1.0, 0.0, np.inf, along=2.0), 2.0, 4.0)
    assert followed == pytest.approx(3.0, abs=0.3)  # half of the speed, for six seconds


@given(
    later_crossings=st.lists(
        st.tuples(
            st.floats(-5.0, 40.0), st.floats(-2.0, 2.0), st.floats(0.0, 8.0), st.floats(0.0, 12.0)
        ),
        max_size=5,
    ),
    speed=st.floats(0.0, 14.0),
    wanted=st.floats(1.0, 14.0),
)
@settings(max_examples=200)
def test_what_is_lost_later_is_a_finite_time_and_none_is_won(later_crossings, speed, wanted):
    people = np.array(later_crossings, dtype=float).reshape(-1, 4)
    lost = time_to_go(people, speed, wanted)
    alone = time_to_go(NOBODY_LATER, speed, wanted)
    assert 0.0 <= alone <= lost + 1e-9
    assert lost <= 6.0 + 1e-9
