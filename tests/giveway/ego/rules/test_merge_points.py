"""Merge points: where bodies on two lanes would touch."""

import numpy as np
import pytest

from giveway.ego.rules.merge_points import merge_points_of
from giveway.geometry.path import EgoPath
from giveway.sumo.network.shared_lanes import Merging as Lane


def test_a_lane_change_begins_where_bodies_would_touch():
    x = np.linspace(0.0, 200.0, 401)
    share = np.clip((x - 100.0) / 30.0, 0.0, 1.0)
    path = EgoPath.through(np.column_stack([x, 3.2 * share * share * (3.0 - 2.0 * share)]))
    line = np.array([[0.0, 3.2], [200.0, 3.2]])
    lane = Lane("main_1", 0.0, 0.0, 200.0, (line,), frozenset())
    (place,) = merge_points_of(path, 0.9, [lane], 20.0)
    beside = 3.2 - np.interp([place.entry - 1.0, place.entry], path.stations, path.vertices[:, 1])
    assert beside[0] > 0.9 + 1.25 + 0.2 > beside[1]
    assert 120.0 < place.end < 131.0
    far = np.array([[0.0, 9.0], [200.0, 9.0]])
    assert merge_points_of(path, 0.9, [lane._replace(lines=(far,))], 20.0) == ()
    assert merge_points_of(path, 0.9, [lane], 20.0 + path.length) == ()


def test_the_merge_point_of_a_zipper_is_where_the_paths_join():
    path = EgoPath.through([(0.0, 0.0), (200.0, 0.0)])
    other = np.array([[0.0, 1.0], [20.0, 3.2], [90.0, 3.2], [100.0, 0.0]])
    zipper = Lane("out_0", 100.0, 0.0, 100.0, (other,), frozenset({":b_0_0"}))
    (place,) = merge_points_of(path, 0.9, [zipper], 0.0)
    assert place.entry == pytest.approx(90.0 + (3.2 - 2.35) / 0.32, abs=0.6)
    assert (place.end, place.origin) == (100.0, 100.0)
