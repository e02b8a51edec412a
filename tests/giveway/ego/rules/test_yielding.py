"""Whether there is room behind a crossing or a junction: entered at 20 m, left at 30 m."""

import math

import pytest

from giveway.ego.perception.leader import NO_LEADER, Leader
from giveway.ego.rules.yielding import at_rest, firm_stop, leaves_no_room

ROOM = 5.0 + 8.5  # [m] the ego's length, and the gap that it keeps


@pytest.mark.parametrize(
    ("station", "speed", "none"),
    [
        (43.0, 0.0, True),  # the ego's rear would be at 29.5 m
        (43.6, 0.0, False),
        (44.0, 1.0, True),  # it may stand a metre farther on at the next look
        (43.0, 2.5, False),  # it drives
        (19.0, 0.0, False),  # it stands before the crossing itself
        (math.inf, 0.0, False),
    ],
)
def test_who_stands_right_behind_leaves_no_room(station: float, speed: float, none: bool) -> None:
    assert leaves_no_room(Leader(station, speed), 20.0, 30.0, ROOM) == none


def test_who_drives_up_to_a_red_light_will_stand_there() -> None:
    driving = Leader(35.0, 4.0)
    assert at_rest(driving, math.inf) == driving
    assert at_rest(driving, 150.0) == driving  # the light is far off: it will have gone on by then
    assert at_rest(driving, 46.0) == Leader(39.0, 0.0)  # with 2 m/s^2
    assert at_rest(driving, 41.0) == Leader(36.0, 0.0)  # at the line, 5 m long
    assert at_rest(driving, 37.0) == Leader(35.0, 0.0)  # a part of it beyond the line
    assert at_rest(driving, 34.0) == driving  # it has passed the line
    assert at_rest(NO_LEADER, 46.0) == NO_LEADER
    assert not leaves_no_room(driving, 20.0, 30.0, ROOM)
    assert leaves_no_room(at_rest(driving, 46.0), 20.0, 30.0, ROOM)


def test_a_firm_stop_takes_time_to_build_up() -> None:
    assert firm_stop(100.0, 0.0) == 100.0
    assert firm_stop(100.0, 6.0) == pytest.approx(100.0 + 0.2 * 6.0 + 36.0 / 6.0)
