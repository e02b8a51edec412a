"""Following and approaching the vehicle in front of the ego."""

from math import inf, sqrt

from controller.driving_constants import FIRM
from giveway.ego.perception.leader import Leader
from giveway.geometry.kernel import Array

_KEPT, _LEAST = 0.5, 0.25  # usual and least share of d_safe that a plan keeps to vehicles
CLOSEST = 2.0  # gap [m] to a standing vehicle that the ego keeps rather than block a crossing
_BUILD_UP = 0.2  # time [s] in which the brake builds up
_APPROACHED = 0.5  # distance [m] before d_safe at which the approach to a vehicle ends
_RECOVERY = 2.0  # time [s] in which a lost safe distance is regained
_REACTION = 1.0  # lag [s] of a planning controller behind a leader's speed (Gipps 1981)


class Following:
    """Bounds of an ego that follows or approaches a vehicle.

    Giveway's controllers follow with a headway. A planning controller accepts less than the usual
    distance to a vehicle if it would otherwise plan a hard stop. The tuned PID takes only
    a distance into account. It is therefore given the distance to where the vehicle could stop.

    Args:
        safe_distance: Safe distance d_safe [m] to a vehicle.
        origin: Distance [m] of the point from which gaps are measured, ahead of the front bumper.
        comfortable: Deceleration [m/s^2] of an approach.
        plans: Whether a planning controller drives.
        tuned: Whether the tuned PID drives.
    """

    def __init__(
        self, safe_distance: float, origin: float, comfortable: float, *, plans: bool, tuned: bool
    ) -> None:
        self._safe_distance, self._origin = safe_distance, origin
        self._comfortable, self._plans = comfortable, plans
        self._lag = comfortable * _REACTION if plans or tuned else 0.0
        self._firmly = 2.0 * FIRM if tuned else inf
        self._spare = max(0.0, safe_distance + origin - CLOSEST)

    def keep_clear_relaxation(self, ahead: float, station: float, keep_clear: float) -> float:
        """The gap relaxation [m] that lets the ego leave a keep-clear zone.

        Args:
            ahead: Station of the vehicle in front [m].
            station: Station of the ego's front bumper [m].
            keep_clear: Keep-clear distance [m]: distance to drive until the zone is free.
        """
        if keep_clear <= 0.0:
            return 0.0
        left = ahead - station - keep_clear - _APPROACHED  # gap [m] behind the zone
        return min(max(0.0, self._spare + CLOSEST - left), self._spare)

    def gap_relaxation(
        self, leader: Leader, ahead: Array, station: float, speed: float, keep_clear: float
    ) -> float:
        """The gap relaxation [m] of the controller. Arguments are as for :func:`gap_relaxation`."""
        closest = min(leader.station, float(ahead.min(initial=inf)))
        relaxation = self.keep_clear_relaxation(closest, station, keep_clear)
        if not self._plans:
            return relaxation
        usual = gap_relaxation(leader, ahead, station, speed, self._safe_distance, self._origin)
        return max(relaxation, usual)

    def leader_station(self, leader: Leader, station: float, keep_clear: float) -> float:
        """The station [m] to which a controller is to keep its distance behind a vehicle.

        The tuned PID gets the station at which the vehicle could stop. A gap relaxation shifts it.
        """
        relaxation = self.keep_clear_relaxation(leader.station, station, keep_clear)
        return leader.station + leader.speed**2 / self._firmly + relaxation

    def speed_limit(self, leader: Leader, stop: float, station: float, keep_clear: float) -> float:
        """The speed [m/s] that comfortable braking allows before a stop or behind a leader.

        Args:
            leader: Closest vehicle in front.
            stop: Station [m] at which the front bumper has to stop; inf if it need not stop.
            station: Station of the front bumper [m].
            keep_clear: Keep-clear distance [m].
        """
        b, limit = self._comfortable, inf
        if stop < inf:
            limit = sqrt(2.0 * b * max(0.0, stop - station))
        if leader.station < inf:
            v = leader.speed
            room = leader.station - station - self._origin - self._safe_distance - _APPROACHED
            room += self.keep_clear_relaxation(leader.station, station, keep_clear)
            if room <= 0.0:
                behind = v + room / _RECOVERY
            else:
                behind = sqrt(v * v + 2.0 * b * room + self._lag**2) - self._lag
            limit = min(limit, max(0.0, behind))
        return limit


def gap_relaxation(
    leader: Leader,
    ahead: Array,
    station: float,
    speed: float,
    safe_distance: float,
    origin: float,
) -> float:
    """The part of the safe distance [m] that a plan gives up to avoid hard braking for a vehicle.

    As a rule a plan keeps half of the safe distance. It keeps less, down to a quarter, if a vehicle
    that cuts in, stops at once or comes from the side leaves too little room for firm braking.

    Args:
        leader: Closest vehicle in front.
        ahead: Stations (N,) [m] of the closest vehicle at steps 1 ... N.
        station: Station of the front bumper [m].
        speed: Speed of the ego [m/s].
        safe_distance: Safe distance d_safe [m].
        origin: Distance [m] of the point from which gaps are measured, ahead of the front bumper.
    """
    kept = _KEPT * safe_distance + origin
    coming = float(ahead.min())  # a vehicle closer than the leader comes from the side
    gap = min(leader.station, coming) - station
    if gap < inf:
        its_speed = leader.speed if leader.station <= coming else 0.0
        closing = max(0.0, speed - its_speed)
        room = gap - closing * (_BUILD_UP + closing / (2.0 * FIRM))
        kept = min(kept, max(room, min(_LEAST * safe_distance, gap)))
    return safe_distance + origin - kept
