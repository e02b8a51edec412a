"""Where people walk next."""

from __future__ import annotations

import numpy as np

from pedestrian_model import Crowd, targets


def test_the_way_point_or_the_nearest_point_of_its_line():
    crowd = Crowd.create(
        [(0.0, 0.0), (0.0, 1.0), (0.0, 9.0)],
        np.zeros((3, 2)),
        1.0,
        [[(5.0, 4.0)], [(5.0, 0.0), (8.0, 0.0)], [(5.0, 0.0)]],
        passages=[[(0, 0, 0)], [(1.0, 0.0, 2.0), (0, 0, 0)], [(1.0, 0.0, 2.0)]],
    )
    np.testing.assert_allclose(targets(crowd, np.array([2, 0, 1])), [(5, 2), (5, 4), (5, 1)])
    crowd.waypoint_index[1] = 1
    np.testing.assert_allclose(targets(crowd, np.array([1])), [(8, 0)])
    assert targets(crowd, np.empty(0, dtype=np.int64)).shape == (0, 2)
