"""Where people walk next."""

from __future__ import annotations

import numpy as np
import pytest

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


@pytest.mark.parametrize(
    ("position", "signal", "target"),
    [
        ((4.99, 1.0), -1, (5.0, 1.0)),
        ((5.01, 1.0), -1, (9.0, 4.5)),  # over the line: on to the next one
        ((5.01, 1.0), 0, (5.0, 1.0)),  # which may be closed
        ((5.01, 2.1), -1, (5.0, 2.0)),  # round its end
    ],
)
def test_a_line_that_somebody_has_stepped_over_is_done_with(position, signal, target):
    crowd = Crowd.create(
        [position],
        np.zeros((1, 2)),
        1.0,
        [[(5.0, 0.0), (9.0, 5.0)]],
        passages=[[(1.0, 0.0, 2.0), (1.0, 0.0, 0.5)]],
        signals=[[signal, -1]],
    )
    np.testing.assert_allclose(targets(crowd, np.array([0])), [target])
    crowd.position[0] = (9.01, 5.2)
    crowd.waypoint_index[0] = 1
    np.testing.assert_allclose(targets(crowd, np.array([0])), [(9.0, 5.2)])  # the last one stays
