"""The desired speeds of people, learnt from their speeds as seen."""

import numpy as np
import pytest

from giveway.ego.perception.desired_speeds import Pace
from pedestrian_model import Crowd

STEP = 0.05  # [s]
TYPICAL = 1.3  # [m/s]


def walking(*speeds: float) -> Crowd:
    """One person per speed, along +x."""
    n = len(speeds)
    velocity = np.column_stack([speeds, np.zeros(n)])
    places = np.column_stack([np.zeros(n), 3.0 * np.arange(n)])
    return Crowd.create(
        places, velocity, np.full(n, TYPICAL), [places[i : i + 1] + 20.0 for i in range(n)]
    )


def after(seconds: float, pace: Pace, *speeds: float) -> np.ndarray:
    numbers = np.arange(len(speeds))
    for _ in range(round(seconds / STEP)):
        found = pace.learn(walking(*speeds), numbers)
    return found


def test_a_faster_pace_is_learnt_in_a_quarter_of_a_second() -> None:
    (found,) = after(0.25, Pace(TYPICAL, STEP), 2.3)
    assert found == pytest.approx(TYPICAL + 1.0 - np.exp(-1.0))


def test_a_slower_pace_takes_twenty_times_as_long() -> None:
    (found,) = after(5.0, Pace(TYPICAL, STEP), 1.0)
    assert found == pytest.approx(1.0 + 0.3 * np.exp(-1.0))


def test_who_hardly_walks_tells_nothing() -> None:
    assert after(10.0, Pace(TYPICAL, STEP), 0.0, 0.4) == pytest.approx([TYPICAL, TYPICAL])


def test_everybody_is_known_by_their_number() -> None:
    pace = Pace(TYPICAL, STEP)
    after(1.0, pace, 2.0, 1.3)
    swapped = pace.learn(walking(1.3, 2.0), np.array([1, 0]))
    assert swapped[0] == pytest.approx(TYPICAL)
    assert swapped[1] > 1.9
