"""Tracks of walks: what they hold up to an instant."""

import numpy as np
import pytest

from giveway.run_data.walks import WalkTrack


@pytest.fixture
def track() -> WalkTrack:
    """Two people at the instants 0 to 3; the second one arrives at 2 and is gone then."""
    step = np.array([0, 0, 1, 1, 2, 2, 3])
    number = np.arange(7.0)
    return WalkTrack(
        step=step,
        pedestrian=np.array([0, 1, 0, 1, 0, 1, 0]),
        x=number,
        y=-number,
        vx=0.1 * number,
        vy=0.2 * number,
        remaining=10.0 - number,
        walked=2.0 * number,
        arrival_step=np.array([2]),
        arrival_pedestrian=np.array([1]),
        desired_speed=np.array([1.3, 1.4]),
        near=np.array([True, True]),
        ids=("ped0", "ped1"),
        time_step=0.05,
        last=3,
    )


def test_up_to_an_instant_it_ends_there(track: WalkTrack) -> None:
    cut = track.until(1)
    assert cut.last == 1
    assert cut.step.tolist() == [0, 0, 1, 1]
    assert cut.x.tolist() == [0.0, 1.0, 2.0, 3.0]
    assert cut.walked.tolist() == [0.0, 2.0, 4.0, 6.0]
    assert cut.arrival_step.size == 0
    assert cut.ids == track.ids


def test_an_arrival_at_that_instant_belongs_to_it(track: WalkTrack) -> None:
    assert track.until(2).arrival_pedestrian.tolist() == [1]


def test_beyond_its_end_it_is_itself(track: WalkTrack) -> None:
    assert track.until(3) is track
    assert track.until(100) is track
