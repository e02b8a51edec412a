"""The station at which a path passes a point."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from giveway.geometry.kernel import kernel
from giveway.geometry.passage import SIGHT, look, window
from giveway.geometry.path import EgoPath

look = kernel(look)
STRAIGHT = EgoPath.through([(0.0, 0.0), (60.0, 0.0)])
BACK = EgoPath.through([(0.0, 0.0), (40.0, 0.0), (40.0, 2.0), (0.0, 2.0)])


def seen(path: EgoPath, x: float, y: float, *, front: float = 0.0, reach: float = 0.0):
    last = len(path.vertices) - 2
    return look(path.vertices, path.stations, (0, last), (x, y), front, 1.25, reach)


@given(st.floats(1.0, 59.0), st.floats(-1.2, 1.2))
def test_on_a_straight_path_it_is_the_distance_along(x: float, y: float) -> None:
    station, reachable = seen(STRAIGHT, x, y)
    assert station == pytest.approx(x)
    assert reachable


def test_beside_the_corridor_the_reach_decides() -> None:
    assert seen(STRAIGHT, 20.0, 3.0) == (np.inf, False)
    assert seen(STRAIGHT, 20.0, 3.0, reach=2.0) == (np.inf, True)


def test_behind_the_front_there_is_no_passage() -> None:
    assert seen(STRAIGHT, 20.0, 0.0, front=25.0)[0] == np.inf


def test_a_path_that_turns_back_passes_a_point_again() -> None:
    assert seen(BACK, 30.0, 1.0)[0] == pytest.approx(30.0)
    assert seen(BACK, 30.0, 1.0, front=35.0)[0] == pytest.approx(52.0)


def test_the_window_is_what_is_within_sight() -> None:
    stations = np.arange(0.0, 500.0, 10.0)
    first, last = window(stations, 200.0, 15.0)
    assert stations[first] <= 185.0 < stations[first + 1]
    assert stations[last] <= 200.0 + SIGHT <= stations[last + 1]
