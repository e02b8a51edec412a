"""Crowds, vehicles and parameters: how they are built, cut and joined, and what they refuse."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
import pytest
from crowd_forces import target_of
from hypothesis import given, settings
from hypothesis import strategies as st

from pedestrian_model import (
    Crowd,
    CrowdError,
    CrowdModel,
    Vehicles,
    arrived,
)


def three():
    return Crowd.create(
        [(0, 0), (2, 0), (4, 0)],
        np.zeros((3, 2)),
        [1.0, 1.2, 1.4],
        [[(9, 9)], [(2.0, 0.1), (7, 7)], [(4, 3), (5, 3), (6, 3)]],
    )


def test_waypoints_of_each_stand_at_its_offsets():
    crowd = three()
    np.testing.assert_array_equal(crowd.waypoint_start, [0, 1, 3, 6])
    np.testing.assert_array_equal(target_of(crowd), [(9, 9), (2.0, 0.1), (4, 3)])
    last = crowd.waypoints[crowd.waypoint_start[1:] - 1]
    np.testing.assert_array_equal(last, [(9, 9), (7, 7), (6, 3)])
    assert len(crowd) == 3


def test_a_crowd_owns_its_arrays():
    x, route = np.zeros((1, 2)), np.ones((1, 2))
    crowd = Crowd.create(x, x, 1.0, [route])
    CrowdModel().advance(crowd, Vehicles.empty())
    np.testing.assert_array_equal(x, 0.0)
    route[:] = 5.0
    np.testing.assert_array_equal(crowd.waypoints, 1.0)


def test_select_and_concatenate_keep_routes_and_progress():
    crowd = CrowdModel().step(three(), Vehicles.empty())
    np.testing.assert_array_equal(crowd.waypoint_index, [0, 1, 0])
    rest = crowd.select(np.array([False, True, True]))
    np.testing.assert_array_equal(rest.waypoint_start, [0, 2, 5])
    np.testing.assert_array_equal(rest.waypoint_index, [1, 0])
    np.testing.assert_array_equal(target_of(rest), [(7, 7), (4, 3)])
    again = crowd.select(np.array([True, False, False])).concatenate(rest)
    for name in ("position", "velocity", "desired_speed", "waypoints", "waypoint_start"):
        np.testing.assert_array_equal(getattr(again, name), getattr(crowd, name))
    assert len(crowd.select(np.zeros(3, dtype=bool))) == 0
    assert len(Crowd.empty().concatenate(crowd)) == 3


@pytest.mark.parametrize("mask", [[True, False, True], [False, True, True]])
def test_a_selection_into_given_arrays_equals_a_new_one(mask):
    room = three().select(np.array([True, True, False]))
    crowd = Crowd.create(
        [(1, 0), (2, 1), (4, 1)],
        np.ones((3, 2)),
        [1.1, 1.2, 1.3],
        [[(8, 9), (8, 8)], [(2, 0)], [(4, 3)]],
        signals=[[0, -1], [-1], [2]],
        priority=[0.0, 0.5, 1.0],
    )
    kept = room.select(np.ones(2, dtype=bool))
    fits = len(room.waypoints) == 2 * sum(mask[:1]) + sum(mask[1:])
    reused, own = crowd.select(np.array(mask), room), crowd.select(np.array(mask))
    assert (reused is room) == fits
    for field in fields(Crowd):
        np.testing.assert_array_equal(getattr(reused, field.name), getattr(own, field.name))
    assert reused.signals == own.signals == 3
    if not fits:
        np.testing.assert_array_equal(room.waypoints, kept.waypoints)


def test_arrived_means_the_last_waypoint():
    crowd = Crowd.create(
        [(0, 0), (0, 0), (0, 3)],
        np.zeros((3, 2)),
        1.0,
        [[(0, 0.4)], [(0, 0.4), (9, 9)], [(0, 0)]],
    )
    np.testing.assert_array_equal(arrived(crowd, 0.5), [True, False, False])
    assert arrived(Crowd.empty(), 1.0).shape == (0,)


@pytest.mark.parametrize(
    ("position", "velocity", "speed", "waypoints", "message"),
    [
        ([(0, 0), (np.nan, 0)], np.zeros((2, 2)), 1, [[(0, 0)]] * 2, r"position\[1, 0\] = nan"),
        ([(0, 0)], [(0, np.inf)], 1, [[(0, 0)]], r"velocity\[0, 1\] = inf"),
        ([(0, 2e9)], [(0, 0)], 1, [[(0, 0)]], r"position\[0, 1\] = 2000000000.0.*1e\+09"),
        ([(0, 0)], [(0, 0)], [-1.0], [[(0, 0)]], r"desired_speed\[0\] = -1.0, expected.*>= 0"),
        ([(0, 0)], [(0, 0)], [1.0, 2.0], [[(0, 0)]], r"desired_speed has shape \(2,\)"),
        ([(0, 0)], [(0, 0, 0)], 1, [[(0, 0)]], r"velocity has shape \(1, 3\)"),
        ([0, 0, 0], [(0, 0)], 1, [[(0, 0)]], r"position has shape \(3,\)"),
        ([(0, 0)], [(0, 0)], 1, [], "waypoints has 0 entries"),
        ([(0, 0)], [(0, 0)], 1, [np.empty((0, 2))], "pedestrian 0 has no way-point"),
        ([(0, 0)], [(0, 0)], 1, [(1, 2)], r"waypoints\[0\] has shape \(2,\)"),
        ([(0, 0)], [(0, 0)], 1, [[(np.nan, 2)]], r"waypoints\[0\]\[0, 0\] = nan"),
        ([("a", 0)], [(0, 0)], 1, [[(0, 0)]], "position: expected numbers"),
    ],
)
def test_a_bad_crowd_is_refused_by_index_and_value(position, velocity, speed, waypoints, message):
    with pytest.raises(CrowdError, match=message):
        Crowd.create(position, velocity, speed, waypoints)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"waypoint_index": np.array([0, 2, 0])}, "pedestrian 1 has a waypoint_index beyond"),
        ({"waypoint_index": np.array([0, -1, 0])}, "pedestrian 1 has a negative waypoint_index"),
        ({"waypoint_start": np.array([0, 1, 3, 5])}, "waypoint_start runs from 0 to 5"),
        ({"waypoint_index": np.zeros(3)}, "waypoint_index is float64, expected"),
        ({"position": np.zeros((3, 4))[:, ::2]}, "position is float64, expected C-contiguous"),
    ],
)
def test_a_crowd_put_together_by_hand_is_checked_too(change, message):
    with pytest.raises(CrowdError, match=message):
        replace(three(), **change)


def test_a_mask_must_fit():
    with pytest.raises(CrowdError, match=r"mask is int64 of shape \(3,\)"):
        three().select(np.array([1, 0, 1]))


def test_select_concatenate_and_copy_carry_passages_and_signals():
    crowd = Crowd.create(
        [(0, 0), (1, 0), (2, 0)],
        np.zeros((3, 2)),
        1.0,
        [[(1, 1)], [(2, 2), (3, 3)], [(4, 4)]],
        passages=[[(3, 4, 1)], [(0, 0, 7), (0, 2, 2)], [(-1, 0, 3)]],
        signals=[[2], [-1, 5], [0]],
    )
    np.testing.assert_allclose(
        crowd.waypoint_passage, [(0.6, 0.8, 1), (0, 0, 0), (0, 1, 2), (-1, 0, 3)]
    )
    assert crowd.signals == 6
    rest = crowd.select(np.array([True, False, True]))
    np.testing.assert_array_equal(rest.waypoint_passage, crowd.waypoint_passage[[0, 3]])
    np.testing.assert_array_equal(rest.waypoint_signal, [2, 0])
    assert rest.signals == 3
    both = rest.concatenate(crowd)
    np.testing.assert_array_equal(both.waypoint_signal, [2, 0, 2, -1, 5, 0])
    np.testing.assert_array_equal(both.waypoint_start, [0, 1, 2, 3, 5, 6])
    np.testing.assert_array_equal(both.copy().waypoint_passage, both.waypoint_passage)
    replace(both)  # passes every check of a crowd put together by hand


@settings(max_examples=30)
@given(st.lists(st.integers(1, 4), min_size=1, max_size=12), st.integers(0, 2**12 - 1))
def test_a_selection_joined_with_the_others_is_everybody(lengths, bits):
    rng = np.random.default_rng(len(lengths) + bits)
    n = len(lengths)
    crowd = Crowd.create(
        rng.normal(size=(n, 2)),
        rng.normal(size=(n, 2)),
        rng.uniform(1.0, 2.0, n),
        [rng.normal(size=(k, 2)) for k in lengths],
        passages=[rng.normal(size=(k, 3)) ** 2 for k in lengths],
        signals=[rng.integers(-1, 4, k) for k in lengths],
    )
    mask = np.array([bits >> i & 1 for i in range(n)], dtype=bool)
    order = np.concatenate([np.flatnonzero(mask), np.flatnonzero(~mask)])
    joined = crowd.select(mask).concatenate(crowd.select(~mask))
    replace(joined)
    np.testing.assert_array_equal(joined.position, crowd.position[order])
    for name in ("waypoints", "waypoint_passage", "waypoint_signal"):
        one = np.split(getattr(crowd, name), crowd.waypoint_start[1:-1])
        np.testing.assert_array_equal(
            getattr(joined, name), np.concatenate([one[i] for i in order])
        )


@pytest.mark.parametrize(
    ("features", "message"),
    [
        ({"passages": []}, "passages has 0 entries, expected one for each of 1"),
        ({"passages": [[(1, 0, 1)]]}, r"passages\[0\] has shape \(1, 3\), expected \(2, 3\)"),
        ({"passages": [[(1, 0, 1), (1, np.nan, 1)]]}, r"passages\[0\]\[1, 1\] = nan"),
        ({"passages": [[(1, 0, 1), (1, 0, -1)]]}, r"half-width of waypoint_passage\[1\] = -1"),
        ({"signals": [[0]]}, r"signals\[0\] has shape \(1,\), expected \(2\)"),
        ({"signals": [[0, -3]]}, r"waypoint_signal\[1\] = -3, expected an index >= 0"),
        ({"signals": [[0.5, 1.0]]}, r"signals\[0\] is float64, expected integers"),
    ],
)
def test_bad_passages_and_signals_are_refused_by_index_and_value(features, message):
    with pytest.raises(CrowdError, match=message):
        Crowd.create([(0, 0)], [(0, 0)], 1.0, [[(1, 1), (2, 2)]], **features)
