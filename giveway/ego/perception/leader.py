"""The closest vehicle in front, and how it is followed.

What is in front defines :mod:`giveway.ego.corridor`.
"""

from math import inf, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.kernel import Array, kernel
from giveway.geometry.passage import BEHIND, SIGHT, look, window
from giveway.geometry.path import body_pose, project, segment_at

_ONCOMING = -0.8  # cosine of the angle to the ego's path there
_PARALLEL = 0.95  # likewise: 18 degrees, as a body in a bend lies askew
_OUTLINE = 1.0  # [m] at most between the points of a vehicle's outline that are looked at
_FINEST_OUTLINE = 0.1  # [m] and at least
_KEPT, _LEAST = 0.5, 0.25  # of d_safe that a plan keeps to vehicles, and that it keeps at least
CLOSEST = 2.0  # [m] behind one who stands, where the ego would block a crossing or junction else
FIRM = 3.0  # [m/s^2] of braking that the share in between may cost
_BUILD_UP = 0.2  # [s] until the brake has it
_APPROACHED = 0.5  # [m] before the safe distance at which the approach to a vehicle ends
_RECOVERY = 2.0  # [s] in which a lost safe distance is to be regained
_REACTION = 1.0  # [s] in which a planning controller follows a leader's speed (Gipps 1981)


class Leader(NamedTuple):
    """The closest vehicle in front."""

    station: float  # [m] of its closest point; inf: none
    speed: float  # [m/s] along the ego's path, at least 0


NO_LEADER = Leader(inf, 0.0)
NOBODY_BESIDE: NDArray[np.bool_] = np.empty(0, dtype=np.bool_)


class Following:
    """How an ego follows and approaches vehicles.

    Ours follow with a headway. A planning controller plans no hard stop for a little less of the
    distance to a vehicle that it keeps on the average; the tuned PID, which brakes for a distance
    alone, is shown how far it is to where the vehicle in front could stop.

    Args:
        safe_distance: d_safe [m] to a vehicle.
        origin: of the distance to who is in front, ahead of the front bumper [m].
        comfortable: deceleration [m/s^2] of an approach.
        plans: a planning controller drives.
        tuned: the tuned PID does.
    """

    def __init__(
        self, safe_distance: float, origin: float, comfortable: float, *, plans: bool, tuned: bool
    ) -> None:
        self._safe_distance, self._origin = safe_distance, origin
        self._comfortable, self._plans = comfortable, plans
        self._lag = comfortable * _REACTION if plans or tuned else 0.0
        self._firmly = 2.0 * FIRM if tuned else inf
        self._spare = max(0.0, safe_distance + origin - CLOSEST)

    def closes_up(self, station: float, front: float, to_clear: float) -> float:
        """How much [m] of the safe distance it gives up, rather than block a place.

        Args:
            station: of the vehicle in front [m].
            front: station of the front bumper [m].
            to_clear: [m] to be driven on to leave the place.
        """
        if to_clear <= 0.0:
            return 0.0
        left = station - front - to_clear - _APPROACHED  # where it would have left it
        return min(max(0.0, self._spare + CLOSEST - left), self._spare)

    def given_up(
        self, leader: Leader, ahead: Array, front: float, speed: float, to_clear: float
    ) -> float:
        """What a plan may give up of the safe distance [m]; arguments of :func:`given_up`."""
        station = min(leader.station, float(ahead.min(initial=inf)))
        spared = self.closes_up(station, front, to_clear)
        if not self._plans:
            return spared
        return max(spared, given_up(leader, ahead, front, speed, self._safe_distance, self._origin))

    def station(self, leader: Leader, front: float, to_clear: float) -> float:
        """The station [m] of the vehicle in front that a controller is to keep its distance to."""
        spared = self.closes_up(leader.station, front, to_clear)
        return leader.station + leader.speed**2 / self._firmly + spared

    def speed_limit(self, leader: Leader, stop: float, front: float, to_clear: float) -> float:
        """The speed [m/s] that comfortable braking allows before a stop or behind a leader.

        Args:
            leader: the closest vehicle in front.
            stop: station [m] at which the front bumper has to stop; inf: nowhere.
            front: its station [m].
            to_clear: [m] to be driven on to leave what it would block.
        """
        b, limit = self._comfortable, inf
        if stop < inf:
            limit = sqrt(2.0 * b * max(0.0, stop - front))
        if leader.station < inf:
            v = leader.speed
            room = leader.station - front - self._origin - self._safe_distance - _APPROACHED
            room += self.closes_up(leader.station, front, to_clear)
            if room <= 0.0:
                behind = v + room / _RECOVERY
            else:
                behind = sqrt(v * v + 2.0 * b * room + self._lag**2) - self._lag
            limit = min(limit, max(0.0, behind))
        return limit


def given_up(
    leader: Leader,
    ahead: Array,
    front: float,
    speed: float,
    safe_distance: float,
    origin: float,
) -> float:
    """What a plan may give up of the safe distance to vehicles [m], so as not to brake hard for it.

    That is half of it; and as much as to a quarter where a vehicle that cuts in, stops at once or
    comes from the side leaves no room for firm braking to half of it.

    Args:
        leader: the closest vehicle in front.
        ahead: (N,) stations [m] of the closest at steps 1 ... N.
        front: the front bumper's station [m].
        speed: of the ego [m/s].
        safe_distance: d_safe [m].
        origin: of the distance to who is in front, ahead of the front bumper [m].
    """
    kept = _KEPT * safe_distance + origin
    coming = float(ahead.min())  # before the leader: from the side
    gap = min(leader.station, coming) - front
    if gap < inf:
        its_speed = leader.speed if leader.station <= coming else 0.0
        closing = max(0.0, speed - its_speed)
        room = gap - closing * (_BUILD_UP + closing / (2.0 * FIRM))
        kept = min(kept, max(room, min(_LEAST * safe_distance, gap)))
    return safe_distance + origin - kept


@kernel
def outline_in_front(
    vertices: Array,
    stations: Array,
    first: int,
    last: int,
    vehicle: Array,
    front: float,
    half_width: float,
) -> float:
    """Station of the closest point of a vehicle's outline in front; inf: none is."""
    cos, sin = np.cos(vehicle[2]), np.sin(vehicle[2])
    rear, length, half = -vehicle[5], vehicle[4] + vehicle[5], vehicle[6] / 2.0
    apart = max(
        _FINEST_OUTLINE, min(_OUTLINE, half_width)
    )  # so that no vehicle slips through the corridor
    along = max(1, int(np.ceil(length / apart)))
    closest = np.inf
    for i in range(along + 1):
        to_x = rear + length * i / along
        across = max(1, int(np.ceil(2.0 * half / apart))) if i in (0, along) else 1
        for j in range(across + 1):
            to_y = -half + 2.0 * half * j / across
            x = vehicle[0] + cos * to_x - sin * to_y
            y = vehicle[1] + sin * to_x + cos * to_y
            station, _ = look(vertices, stations, first, last, x, y, front, half_width, 0.0)
            closest = min(closest, station)
    return closest


@kernel
def vehicles_in_front(
    vertices: Array,
    stations: Array,
    headings: Array,
    poses: Array,
    own: int,
    front: float,
    advance: float,
    time_step: float,
    half_width: float,
    straight: int,
    beside: NDArray[np.bool_],
    ahead: Array,
) -> tuple[float, float]:
    """The closest vehicle now (station, speed along the path); fills ``ahead`` for 1 ... N.

    A vehicle that is in the corridor now is predicted to follow the path at its present speed, any
    other to go straight on for ``straight`` steps. So one ahead in a bend stays ahead, and one
    from the side arrives. Where N is longer than these steps, vehicles along the path beside it,
    the same way or oncoming, are predicted to keep to their own lane, and what comes from the side
    beyond the path's end is no matter. Whoever is ``beside`` (of the last vehicles) is predicted to
    keep to the lane that leads it past the path. A vehicle in the corridor behind the front bumper
    stays behind: it does not drive through the ego.
    """
    N = ahead.shape[0]
    known = poses.shape[1] - beside.shape[0]
    end = stations[-1] if straight < N else np.inf
    first, last = window(stations, front, BEHIND)
    ahead[:] = np.inf
    nearest, its_speed = np.inf, 0.0
    x_0, y_0, _ = body_pose(vertices, stations, headings, front, 0.0)
    for j in range(poses.shape[1]):
        vehicle = poses[0, j]
        size = vehicle[4] + vehicle[5] + vehicle[6]
        away = np.hypot(vehicle[0] - x_0, vehicle[1] - y_0)
        if j == own or away > SIGHT + size:
            continue
        station = outline_in_front(vertices, stations, first, last, vehicle, front, half_width)
        if station < np.inf:
            i = segment_at(stations, station)
            along = max(0.0, vehicle[3] * np.cos(vehicle[2] - headings[i]))
            if station < nearest:
                nearest, its_speed = station, along
            for k in range(N):
                ahead[k] = min(ahead[k], station + (k + 1) * time_step * along)
            continue
        if j >= known and beside[j - known]:
            continue
        if straight < N:
            nearest_to_it, _ = project(vertices, stations, vehicle[0], vehicle[1])
            i = segment_at(stations, nearest_to_it)
            aligned = np.cos(vehicle[2] - headings[i])
            if aligned < _ONCOMING or aligned > _PARALLEL:
                continue  # it is on a lane beside ours, which bends as ours does
        reach = min(N, straight) * (advance + abs(vehicle[3]) * time_step) + size + half_width
        if away > reach:
            continue  # it cannot meet the ego within the horizon
        rear = front - reach
        begin = segment_at(stations, rear)
        if outline_in_front(vertices, stations, begin, last, vehicle, rear, half_width) < np.inf:
            continue
        for k in range(1, min(N, straight, poses.shape[0] - 1) + 1):
            at = front + k * advance
            station = outline_in_front(vertices, stations, first, last, poses[k, j], at, half_width)
            if station <= end:
                ahead[k - 1] = min(ahead[k - 1], station)
    return nearest, its_speed
