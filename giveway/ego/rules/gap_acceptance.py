"""Which gap in the traffic with priority a driver takes, and how long things take.

The critical gap is the time to the next vehicle with priority that a driver wants at the line, so
as to go first; the follow-up gap is the time after which the next driver goes through the same gap.
Both are the Highway Capacity Manual's (HCM 2010): exhibits 19-10 and 19-11 for stop and give-way
lines on two-lane roads (base values), chapter 18 for left turns against oncoming traffic at lights.
"""

import math
from typing import NamedTuple

from giveway.sumo.network.junction_links import Movement

_LEFT, _RIGHT = "lLt", "rR"  # SUMO's letters; a turn back crosses what a left turn does


class Gap(NamedTuple):
    """What drivers want of the traffic with priority."""

    critical: float  # [s]
    follow_up: float  # [s]


MAJOR_LEFT = Gap(4.1, 2.2)
MINOR_RIGHT = Gap(6.2, 3.3)
MINOR_STRAIGHT = Gap(6.5, 4.0)
MINOR_LEFT = Gap(7.1, 3.5)
PERMITTED = Gap(4.5, 2.5)  # at lights


def gap_of(movement: Movement, *, at_lights: bool, major: bool) -> Gap:
    """What drivers of a movement want.

    Args:
        movement: the link through a junction.
        at_lights: which show a green letter that has to give way.
        major: it comes from a road with priority.
    """
    if at_lights:
        return PERMITTED
    if movement.direction in _RIGHT:
        return MINOR_RIGHT
    if major:
        return MAJOR_LEFT
    return MINOR_LEFT if movement.direction in _LEFT else MINOR_STRAIGHT


def travel_time(distance: float, speed: float, acceleration: float, fastest: float) -> float:
    """How long [s] a vehicle takes that goes on, and speeds up where it is slower than it may be.

    Args:
        distance: [m]; at most 0: it is there.
        speed: at first [m/s].
        acceleration: [m/s^2], positive.
        fastest: [m/s] that it wants to drive.
    """
    if distance <= 0.0:
        return 0.0
    if speed >= fastest:
        return distance / speed if speed > 0.0 else math.inf
    speeding_up = (fastest * fastest - speed * speed) / (2.0 * acceleration)
    if distance <= speeding_up:
        return (math.sqrt(speed * speed + 2.0 * acceleration * distance) - speed) / acceleration
    return (fastest - speed) / acceleration + (distance - speeding_up) / fastest
