"""The recorder: whose rows are kept, and what is given back."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.journal.recorder import Recorder

EGOS = np.array([[0.0, 0.0], [100.0, 0.0]])
PLACES = np.array([[3.0, 4.0], [50.0, 0.0], [100.0, -5.0], [5.1, 0.0]])


def recorded(within: float, egos: np.ndarray = EGOS, instants: int = 1) -> Recorder:
    recorder = Recorder()
    recorder.name_pedestrians(["a", "b", "c", "d"])
    for k in range(instants):
        recorder.instant(0.05 * k)
        recorder.crowd(np.array([3, 2, 1, 0]), PLACES, -PLACES, egos, within)
    return recorder


def test_who_is_near_any_ego_is_recorded_with_the_boundary() -> None:
    track = recorded(5.0).rows().crowd_track()
    assert track.pedestrian.tolist() == [3, 1]
    assert track.x.tolist() == [3.0, 100.0]
    assert track.vy.tolist() == [-4.0, 5.0]


@pytest.mark.parametrize(("within", "egos"), [(np.inf, EGOS), (np.inf, np.empty((0, 2)))])
def test_without_a_limit_everybody_is_recorded(within: float, egos: np.ndarray) -> None:
    assert recorded(within, egos).rows().crowd_track().pedestrian.tolist() == [3, 2, 1, 0]


def test_without_an_ego_nobody_is_near_one() -> None:
    assert len(recorded(5.0, np.empty((0, 2))).rows().crowd_track().x) == 0


def test_rows_that_were_not_filled_are_taken_by_the_next_instant() -> None:
    track = recorded(5.0, instants=2000).rows().crowd_track()  # the table grows on the way
    assert track.step.tolist() == [k for k in range(2000) for _ in range(2)]
    assert set(track.x.tolist()) == {3.0, 100.0}
