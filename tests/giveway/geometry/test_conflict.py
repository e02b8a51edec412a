"""Where two ways meet."""

import numpy as np
import pytest

from giveway.geometry.conflict import conflict

EASTWARD = np.array([[0.0, 0.0], [20.0, 0.0]])


def test_ways_that_cross_meet_round_the_crossing_point() -> None:
    northward = np.array([[8.0, -10.0], [8.0, 10.0]])
    where = conflict(EASTWARD, northward, 2.0)
    assert where is not None
    assert where.enter == pytest.approx(6.0, abs=0.3)
    assert where.leave == pytest.approx(10.0, abs=0.3)
    assert where.other_enter == pytest.approx(8.0, abs=0.3)
    assert where.other_leave == pytest.approx(12.0, abs=0.3)


def test_ways_that_join_meet_from_there_to_the_end() -> None:
    joining = np.array([[8.0, -10.0], [10.0, -2.0], [12.0, 0.0], [20.0, 0.0]])
    where = conflict(EASTWARD, joining, 1.0)
    assert where is not None
    assert 10.0 < where.enter < 12.0
    assert where.leave == 20.0
    assert where.other_leave == pytest.approx(np.hypot(*np.diff(joining, axis=0).T).sum())


def test_lanes_side_by_side_do_not_meet() -> None:
    assert conflict(EASTWARD, EASTWARD[::-1] + [0.0, 3.2], 2.1) is None
