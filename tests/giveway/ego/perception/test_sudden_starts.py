"""Sudden starts: who leaves a sidewalk faster than assumed."""

import numpy as np

from giveway.ego.perception.sudden_starts import SuddenStarts

LIMIT, STEP = 2.0, 0.1  # [m/s^2], [s]
TO_THE_KERB = np.array([[0.0, 1.0, 1.0]])  # direction, and more than 0: on a sidewalk
ON_THE_ROAD = np.array([[0.0, 0.0, 0.0]])
ONE = np.array([4])


def moving(vx: float, vy: float) -> np.ndarray:
    return np.array([[vx, vy]])


def test_only_acceleration_beyond_the_limit_counts() -> None:
    starts = SuddenStarts(LIMIT, STEP)
    assert starts.beyond(ONE, moving(0.0, 0.0), TO_THE_KERB).size == 0
    assert starts.beyond(ONE, moving(0.0, 0.2), TO_THE_KERB).size == 0
    assert starts.beyond(ONE, moving(0.0, 0.41), TO_THE_KERB).tolist() == [4]


def test_acceleration_along_the_kerb_is_none_towards_it() -> None:
    starts = SuddenStarts(LIMIT, STEP)
    starts.beyond(ONE, moving(0.0, 0.0), TO_THE_KERB)
    assert starts.beyond(ONE, moving(3.0, 0.0), TO_THE_KERB).size == 0


def test_on_the_road_nobody_sets_out() -> None:
    starts = SuddenStarts(LIMIT, STEP)
    starts.beyond(ONE, moving(0.0, 0.0), ON_THE_ROAD)
    assert starts.beyond(ONE, moving(0.0, 3.0), ON_THE_ROAD).size == 0


def test_somebody_who_comes_into_sight_has_no_speed_before() -> None:
    starts = SuddenStarts(LIMIT, STEP)
    starts.beyond(ONE, moving(0.0, 0.0), TO_THE_KERB)
    assert starts.beyond(np.array([9]), moving(0.0, 3.0), TO_THE_KERB).size == 0
