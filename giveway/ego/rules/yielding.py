"""Constants and functions of giving way, at crossings, junctions and merge points."""

import math

from controller.driving_constants import COMFORTABLE, FIRM
from giveway.ego.perception.leader import Leader

STOP_BEFORE = 1.0  # distance [m] of a stop before a line or a crossing
CRAWLING = 2.0  # speed [m/s] below which a vehicle is assumed to be about to stop
USUAL_SPEED = 13.9  # speed [m/s] to which other vehicles are expected to accelerate
BUILD_UP = 0.2  # time [s] in which the brake builds up
_CAR = 5.0  # length [m] of the vehicle ahead that stops at a red light
_QUEUE = 100.0  # distance [m] before a red light, within which a queue may stand


def needed_braking(speed: float, room: float) -> float:
    """The deceleration [m/s^2] that stops from ``speed`` [m/s] within ``room`` [m]."""
    return speed * speed / (2.0 * max(room, 1e-3))


def firm_stop(front: float, speed: float) -> float:
    """The nearest station [m] at which firm braking stops.

    Args:
        front: Station of the front bumper [m].
        speed: Speed [m/s].
    """
    return front + speed * (BUILD_UP + speed / (2.0 * FIRM))


def at_rest(leader: Leader, stop: float) -> Leader:
    """The vehicle ahead, at the station where it comes to rest if a red light makes it stop.

    Args:
        leader: Vehicle ahead.
        stop: Station [m] at which the ego has to stop at a light; inf without a red light.
    """
    if leader.station >= stop or stop == math.inf:
        return leader
    braked = leader.station + leader.speed**2 / (2.0 * COMFORTABLE)
    if braked < stop - _QUEUE:
        return leader
    return Leader(max(leader.station, min(stop - _CAR, braked)), 0.0)


def leaves_no_room(leader: Leader, entry: float, leave: float, room: float) -> bool:
    """Return whether a slow vehicle ahead may keep the ego from leaving a crossing or junction.

    The ego would have to stop on it (Vienna Convention on Road Traffic, 1968, art. 18.2).

    Args:
        leader: Vehicle ahead.
        entry: Station [m] of the front bumper at which the ego enters the area.
        leave: Station [m] of the rear at which the ego has left the area.
        room: Length [m] that the ego needs behind the leader: its body and the gap it keeps.
    """
    return (
        leader.speed < CRAWLING
        and leader.station > entry
        and leader.station - leave < room + leader.speed
    )
