"""How an ego follows and approaches the vehicle in front of it."""

from math import inf, sqrt

from giveway.ego.perception.leader import Leader
from giveway.geometry.kernel import Array

_KEPT, _LEAST = 0.5, 0.25  # of d_safe that a plan keeps to vehicles, and that it keeps at least
CLOSEST = 2.0  # [m] behind one who stands, where the ego would block a crossing or junction else
FIRM = 3.0  # [m/s^2] of braking that the share in between may cost
_BUILD_UP = 0.2  # [s] until the brake has it
_APPROACHED = 0.5  # [m] before the safe distance at which the approach to a vehicle ends
_RECOVERY = 2.0  # [s] in which a lost safe distance is to be regained
_REACTION = 1.0  # [s] in which a planning controller follows a leader's speed (Gipps 1981)


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
