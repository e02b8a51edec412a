"""Gap acceptance: the headways that drivers accept in the traffic with priority.

The critical headway is the smallest gap [s] in the stream with priority that a driver accepts at
the line. The follow-up headway is the time after which the next driver uses the same gap.
Both are the Highway Capacity Manual's (HCM 2010): exhibits 19-10 and 19-11 for stop and give-way
lines on two-lane roads (base values), chapter 18 for left turns against oncoming traffic at lights.
"""

import math
from typing import NamedTuple

from giveway.sumo.network.junction_links import Movement

_LEFT, _RIGHT = "lLt", "rR"  # SUMO's letters; a U-turn ("t") counts as a left turn


class Gap(NamedTuple):
    """The headways that drivers accept in the traffic with priority."""

    critical: float  # critical headway [s]
    follow_up: float  # follow-up headway [s]


MAJOR_LEFT = Gap(4.1, 2.2)
MINOR_RIGHT = Gap(6.2, 3.3)
MINOR_STRAIGHT = Gap(6.5, 4.0)
MINOR_LEFT = Gap(7.1, 3.5)
PERMITTED = Gap(4.5, 2.5)  # permitted turn at a traffic light


def gap_of(movement: Movement, *, at_lights: bool, major: bool) -> Gap:
    """The headways that drivers of a movement accept.

    Args:
        movement: Link through a junction.
        at_lights: Whether the movement has green but must give way.
        major: Whether the movement comes from a road with priority.
    """
    if at_lights:
        return PERMITTED
    if movement.direction in _RIGHT:
        return MINOR_RIGHT
    if major:
        return MAJOR_LEFT
    return MINOR_LEFT if movement.direction in _LEFT else MINOR_STRAIGHT


def travel_time(distance: float, speed: float, acceleration: float, fastest: float) -> float:
    """The travel time [s] of a vehicle that speeds up to its highest speed and then keeps it.

    Args:
        distance: Distance [m] to drive; at most 0 if the vehicle is there already.
        speed: Initial speed [m/s].
        acceleration: Acceleration [m/s^2], positive.
        fastest: Highest speed [m/s] of the vehicle.
    """
    if distance <= 0.0:
        return 0.0
    if speed >= fastest:
        return distance / speed if speed > 0.0 else math.inf
    speeding_up = (fastest * fastest - speed * speed) / (2.0 * acceleration)
    if distance <= speeding_up:
        return (math.sqrt(speed * speed + 2.0 * acceleration * distance) - speed) / acceleration
    return (fastest - speed) / acceleration + (distance - speeding_up) / fastest
