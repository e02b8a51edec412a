"""How long things take, and which gaps drivers want."""

import math

import pytest

from giveway.ego.rules.gap_acceptance import (
    MAJOR_LEFT,
    MINOR_LEFT,
    MINOR_RIGHT,
    MINOR_STRAIGHT,
    PERMITTED,
    gap_of,
    travel_time,
)
from giveway.sumo.network.junction_links import Movement


@pytest.mark.parametrize(
    ("distance", "speed", "fastest", "seconds"),
    [
        (12.0, 0.0, 20.0, math.sqrt(2.0 * 12.0 / 1.5)),  # speeding up all the way
        (27.0, 0.0, 6.0, 4.0 + 15.0 / 6.0),  # 12 m and 4 s up to 6 m/s, and 15 m at that speed
        (20.0, 8.0, 8.0, 2.5),
        (20.0, 10.0, 8.0, 2.0),  # who is faster than wanted is not slowed down
        (-1.0, 3.0, 8.0, 0.0),
        (1.0, 0.0, 0.0, math.inf),
    ],
)
def test_travel_time(distance: float, speed: float, fastest: float, seconds: float) -> None:
    assert travel_time(distance, speed, 1.5, fastest) == pytest.approx(seconds)


def movement(direction: str) -> Movement:
    nobody = frozenset[int]()
    return Movement("j", 0, "a_0", "b_0", (":j_0_0",), "m", direction, 8.0, "", -1, nobody, nobody)


@pytest.mark.parametrize(
    ("direction", "at_lights", "major", "gap"),
    [
        ("l", False, True, MAJOR_LEFT),
        ("r", False, False, MINOR_RIGHT),
        ("s", False, False, MINOR_STRAIGHT),
        ("l", False, False, MINOR_LEFT),
        ("t", False, False, MINOR_LEFT),
        ("l", True, False, PERMITTED),
    ],
)
def test_the_gap_that_a_manoeuvre_wants(
    direction: str, at_lights: bool, major: bool, gap: object
) -> None:
    assert gap_of(movement(direction), at_lights=at_lights, major=major) == gap
