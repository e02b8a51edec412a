"""What giving way has in common, at crossings, at junctions and where lanes become one."""

import math

from giveway.ego.perception.leader import Leader

STOP_BEFORE = 1.0  # [m] before a line or a crossing the front bumper is to stand
HARDEST = 3.0  # [m/s^2] of braking that anybody with priority may ask for
CRAWLING = 2.0  # [m/s] a vehicle that is slower may come to a stand
USUAL_SPEED = 13.9  # [m/s] that vehicles are expected to speed up to
AFTER, BEFORE = 1.0, 0.5  # [s] to whoever has priority, who passes after or before
_COMFORT = 2.0  # [m/s^2] with which others brake before a red light
_CAR = 5.0  # [m] length of one who stands there
_QUEUE = 100.0  # [m] before a red light, from which on others may stand there already


def needed_braking(speed: float, room: float) -> float:
    """The deceleration [m/s^2] that stops from ``speed`` [m/s] within ``room`` [m]."""
    return speed * speed / (2.0 * max(room, 1e-3))


def at_rest(leader: Leader, stop: float) -> Leader:
    """The vehicle ahead where it comes to rest, if it is about to stop at a red light ahead.

    Args:
        leader: the vehicle ahead.
        stop: station [m] at which the ego has to stop at a light; inf: nowhere.
    """
    if leader.station >= stop or stop == math.inf:
        return leader
    braked = leader.station + leader.speed**2 / (2.0 * _COMFORT)
    if braked < stop - _QUEUE:
        return leader
    return Leader(max(leader.station, min(stop - _CAR, braked)), 0.0)


def leaves_no_room(leader: Leader, entry: float, leave: float, room: float) -> bool:
    """Whether a slow vehicle ahead may keep the ego from leaving a crossing or junction.

    Who enters would have to stand on it (Vienna Convention on Road Traffic, 1968, art. 18.2).

    Args:
        leader: the vehicle ahead.
        entry: station [m] of the front bumper at which the ego comes onto it.
        leave: station [m] that the rear passes last.
        room: [m] that the ego takes behind the leader: its length, and the gap that it keeps.
    """
    return (
        leader.speed < CRAWLING
        and leader.station > entry
        and leader.station - leave < room + leader.speed
    )
