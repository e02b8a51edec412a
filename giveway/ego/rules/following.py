"""Following and approaching the vehicle in front of the ego."""

from math import inf, sqrt

from controller import VehicleAhead
from controller.driving_constants import (
    FIRM,
    RESPONSE,
    RESTORING,
    UNHURRIED,
    VEHICLE_GAP,
    VEHICLE_HEADWAY,
)
from controller.kernels import needed_behind, safe_speed_behind
from giveway.ego.perception.leader import Leader
from giveway.geometry.kernel import Array

_LEAST = 1.0  # least gap [m] to vehicles that a plan keeps
_MARGIN = 1.5  # gap [m] that is left of the safe distance if the vehicle ahead brakes hard
_URGENCY = 1.2  # factor on the deceleration that just keeps a gap
_CLOSEST = 1.0  # gap [m] to a standing vehicle that the ego keeps rather than block a crossing
_BUILD_UP = 0.2  # time [s] in which the brake builds up
_APPROACHED = 0.5  # distance [m] before d_safe at which the approach to a vehicle ends
_LAG = 0.5  # time [s] by which a controller lags, also behind a vehicle that stands
_STOP_LAG = 0.5  # time [s] by which a controller lags before a stop, so that it brakes no harder
_URGENT_LAG = 2.0  # time [s] by which a plan lags behind a limit that falls fast
_KEEPS_UP = 3.0  # speed [m/s] of a vehicle ahead from which on the whole headway is kept
_RECOVERY = 2.0  # time [s] in which a lost safe distance is regained


class Following:
    """Bounds of an ego that follows or approaches a vehicle.

    Behind a vehicle the ego keeps a gap at rest, a headway, and the age of what it knows of the
    vehicle (Gipps 1981). It also keeps the safe distance of the safety layer and a margin, so that
    the layer need not act. The tuned PID takes only a distance into account. It is therefore given
    the distance to where the vehicle could stop. The paper's controllers keep d_safe instead.

    Args:
        safe_distance: Safe distance d_safe [m] to people.
        origin: Distance [m] of the point from which gaps are measured, ahead of the front bumper.
        comfortable: Deceleration [m/s^2] of an approach.
        time_step: Control step [s].
        plans: Whether a planning controller drives.
        tuned: Whether the tuned PID drives.
        paper: Whether one of the paper's controllers drives.
    """

    def __init__(
        self,
        safe_distance: float,
        origin: float,
        comfortable: float,
        time_step: float,
        *,
        plans: bool = False,
        tuned: bool = False,
        paper: bool = False,
    ) -> None:
        self._comfortable, self._plans, self._paper = comfortable, plans, paper
        self._time_step, self._headway = time_step, 0.0 if paper else VEHICLE_HEADWAY
        self._braking = 2.0 * UNHURRIED if tuned else inf
        bumper = safe_distance + origin  # distance [m] that the bumper keeps to people
        self._kept = bumper if paper else min(bumper, VEHICLE_GAP)
        self._closest = VEHICLE_GAP if paper else _CLOSEST
        self._spare = max(0.0, self._kept - self._closest)
        self._closer = bumper - self._kept
        self._last = inf  # speed [m/s] that the vehicle ahead allowed in the step before

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
        return min(max(0.0, self._spare + self._closest - left), self._spare)

    def gap_relaxation(
        self, leader: Leader, ahead: Array, station: float, speed: float, keep_clear: float
    ) -> float:
        """The distance [m] by which the controller comes closer to a vehicle than to a person.

        A plan comes even closer to avoid hard braking, see :func:`gap_kept`.

        Args:
            leader: Closest vehicle in front.
            ahead: Stations (N,) [m] of the closest vehicle at steps 1 ... N.
            station: Station of the front bumper [m].
            speed: Speed of the ego [m/s].
            keep_clear: Keep-clear distance [m].
        """
        closest = min(leader.station, float(ahead.min(initial=inf)))
        relaxation = self.keep_clear_relaxation(closest, station, keep_clear)
        if not self._plans:
            return self._closer + relaxation
        usual = self._kept - relaxation
        return self._closer + self._kept - gap_kept(leader, ahead, station, speed, usual)

    def leader_station(self, leader: Leader, station: float, keep_clear: float) -> float:
        """The station [m] to which a controller is to keep d_safe behind a vehicle.

        The tuned PID gets the station at which the vehicle could stop without hurry, so that it
        follows by the speed limit. A gap relaxation shifts the station.
        """
        relaxation = self.keep_clear_relaxation(leader.station, station, keep_clear)
        return leader.station + leader.speed**2 / self._braking + self._closer + relaxation

    def stop_limit(self, stop: float, station: float) -> float:
        """The speed [m/s] that comfortable braking allows before a stop.

        A controller lags behind a limit that falls. Only the paper's are not spared that.

        Args:
            stop: Station [m] at which the front bumper has to stop; inf if it need not stop.
            station: Station of the front bumper [m].
        """
        if stop == inf:
            return inf
        lag = 0.0 if self._paper else self._comfortable * _STOP_LAG
        return sqrt(2.0 * self._comfortable * max(0.0, stop - station) + lag * lag) - lag

    def speed_limit(
        self,
        leader: Leader,
        station: float,
        keep_clear: float,
        speed: float = 0.0,
        followed: VehicleAhead | None = None,
    ) -> float:
        """The speed [m/s] that comfortable braking allows behind a leader.

        Args:
            leader: Closest vehicle in front.
            station: Station of the front bumper [m].
            keep_clear: Keep-clear distance [m].
            speed: Speed of the ego [m/s].
            followed: Vehicle ahead as the safety layer knows it, or None without one.
        """
        if leader.station == inf:
            self._last = inf
            return inf
        v = leader.speed
        room = leader.station - station - self._kept - _APPROACHED
        room += self.keep_clear_relaxation(leader.station, station, keep_clear)
        if self._paper:
            followed = None
        headway = self._headway + (0.0 if followed is None else followed.step)
        lag = self._comfortable * max(min(headway, _LAG), headway * min(1.0, v / _KEEPS_UP))
        if room <= 0.0:
            behind = v + room / _RECOVERY
        else:
            behind = sqrt(v * v + 2.0 * self._comfortable * room + lag * lag) - lag
        if followed is not None:
            safe = safe_speed_behind(followed, RESPONSE, _MARGIN, 2.0 * self._time_step)
            behind = self._gently(min(behind, safe), speed, followed)
        return max(0.0, behind)

    def _gently(self, wanted: float, speed: float, followed: VehicleAhead) -> float:
        """The speed [m/s] with which a gap is restored that is too small.

        It falls with `RESTORING`, or as fast as the vehicle ahead makes it necessary.
        """
        needed = _URGENCY * needed_behind(speed, followed, _LEAST)
        falls = max(RESTORING, needed) * self._time_step
        self._last = max(wanted, min(self._last - falls, speed))
        # What is urgent is asked for earlier by the lag with which controllers follow a limit.
        lag = _URGENT_LAG if self._plans else _LAG
        return self._last - lag * max(0.0, needed - RESTORING)


def gap_kept(leader: Leader, ahead: Array, station: float, speed: float, usual: float) -> float:
    """The gap [m] that a plan keeps to a vehicle.

    As a rule a plan keeps the usual gap. It keeps less if a vehicle that cuts in, stops at once or
    comes from the side leaves too little room for firm braking.

    Args:
        leader: Closest vehicle in front.
        ahead: Stations (N,) [m] of the closest vehicle at steps 1 ... N.
        station: Station of the front bumper [m].
        speed: Speed of the ego [m/s].
        usual: Usual gap [m].
    """
    coming = float(ahead.min())  # a vehicle closer than the leader comes from the side
    gap = min(leader.station, coming) - station
    if gap == inf:
        return usual
    its_speed = leader.speed if leader.station <= coming else 0.0
    closing = max(0.0, speed - its_speed)
    room = gap - closing * (_BUILD_UP + closing / (2.0 * FIRM))
    return min(usual, max(room, min(_LEAST, gap)))
