"""The reference speed of the tuned PID: a profile over the gap, and a smooth approach to it."""

from dataclasses import dataclass
from math import copysign, inf, sqrt
from typing import Literal

from controller.defaults import BUFFER_DISTANCE, REFERENCE_SPEED, SAFE_DISTANCE
from controller.driving_constants import FOLLOW_LIMIT
from controller.parameters import require, require_not_negative, require_positive

ProfileName = Literal["braking-curve", "linear"]

_STANDS = 0.005  # Reference speed [m/s] below which the brake holds the vehicle


@dataclass(frozen=True, slots=True)
class ReferenceParameters:
    """The parameters of stopping and braking, chosen by the study in docs/pid.md."""

    reference_speed: float = REFERENCE_SPEED  # v_r [m/s]
    safe_distance: float = SAFE_DISTANCE  # d_safe [m]
    profile: ProfileName = "braking-curve"
    buffer_distance: float = BUFFER_DISTANCE  # d_buffer [m] of the linear profile
    deceleration: float = 1.0  # b [m/s^2] of the braking curve and of comfortable braking
    approach_lag: float = 0.5  # tau [s]: near d_safe the braking curve is the line (gap-d_safe)/tau
    acceleration: float = 3.0  # largest acceleration a [m/s^2]
    jerk: float = 10.0  # jerk j [m/s^3] of comfortable changes of acceleration
    firm_deceleration: float = 3.0  # largest deceleration [m/s^2] to keep d_safe
    last_distance: float = 2.0  # distance d_last [m] that is kept with any deceleration
    creep_speed: float = 0.1  # target speed [m/s] below which the target is a stop

    def __post_init__(self) -> None:
        require_positive("reference_speed", self.reference_speed, "m/s")
        require_not_negative("safe_distance", self.safe_distance, "m")
        known = self.profile in ("braking-curve", "linear")
        require(known, "profile", self.profile, "'braking-curve' or 'linear'")
        require_positive("buffer_distance", self.buffer_distance, "m")
        require_positive("deceleration", self.deceleration, "m/s^2")
        require_positive("approach_lag", self.approach_lag, "s")
        require_positive("acceleration", self.acceleration, "m/s^2")
        require_positive("jerk", self.jerk, "m/s^3")
        require_not_negative("firm_deceleration", self.firm_deceleration, "m/s^2")
        require_not_negative("last_distance", self.last_distance, "m")
        require_not_negative("creep_speed", self.creep_speed, "m/s")


def stoppable(room: float, rate: float, lag: float) -> float:
    """Return the largest value that ``rate`` brings to 0 within ``room``, after ``lag``.

    It is the positive x of x lag + x^2 / (2 rate) = room (the safe speed of Gipps 1981). Far away
    this is the braking curve sqrt(2 rate room). Near the end it is the line room / lag.
    """
    return sqrt((rate * lag) ** 2 + 2.0 * rate * room) - rate * lag


class SpeedReference:
    """The reference speed v_ref and its slope: the profile, limited in acceleration and jerk.

    The parameters limit acceleration, deceleration and jerk as long as this keeps at least
    ``last_distance`` to the person in front. Otherwise the deceleration is what a stop there needs.

    Args:
        parameters: Profile and limits of comfort.
        strongest: Acceleration [m/s^2] of the vehicle's largest force.
        sharpest: Jerk [m/s^3] of the largest change of this force.
        time_step: Control step dt [s].
    """

    def __init__(
        self, parameters: ReferenceParameters, strongest: float, sharpest: float, time_step: float
    ) -> None:
        self.parameters = parameters
        self.time_step = time_step
        self._strongest = strongest
        self._sharpest = sharpest
        self._up = min(parameters.acceleration, strongest)
        self._down = min(parameters.deceleration, strongest)
        self._jerk = min(parameters.jerk, sharpest)
        self._build_up = self._down / self._jerk  # time [s] in which comfortable braking builds up
        # A change of acceleration takes effect one step later. Shorter lags overshoot the target.
        self._lag = 2.0 * time_step
        self._wanted, self._asked = 0.0, (0.0, 0.0)  # the last target, and its gap and limit
        self.start(0.0)

    def start(self, speed: float, acceleration: float = 0.0) -> None:
        """Restart from the vehicle's speed [m/s] and acceleration [m/s^2]."""
        self.speed = max(0.0, speed)
        self.acceleration = acceleration
        self._limit = inf

    def target(self, gap: float, limit: float = inf) -> float:
        """The target speed [m/s] of the profile.

        Args:
            gap: Distance [m] to the closest person in front; inf without one.
            limit: Upper bound [m/s] of the result.
        """
        if (gap, limit) == self._asked:  # the target was just computed
            return self._wanted
        p = self.parameters
        room = gap - p.safe_distance
        if room <= 0.0:
            return 0.0
        if p.profile == "linear":
            wanted = p.reference_speed * min(room / p.buffer_distance, 1.0)
        else:
            wanted = min(p.reference_speed, stoppable(room, self._down, p.approach_lag))
        wanted = min(wanted, limit)
        return wanted if wanted >= p.creep_speed else 0.0

    def advance(self, speed: float, gap: float, limit: float) -> tuple[float, float]:
        """The reference speed [m/s] at t_k, and its acceleration [m/s^2] until t_k+1.

        Args:
            speed: Speed of the vehicle [m/s].
            gap: Distance to the closest person in front [m]; inf without one.
            limit: Upper bound on the reference speed [m/s].
        """
        dt, now, before = self.time_step, self.speed, self.acceleration
        self._wanted, self._asked = self.target(gap, limit), (gap, limit)
        wanted, needed = self._wanted, self._braking(speed, gap)
        # Limits for stop lines and vehicles are braking curves themselves, and must be followed.
        down = needed if limit == inf else min(max(needed, FOLLOW_LIMIT), self._strongest)
        away = wanted - now
        jerk = self._jerk if away >= 0.0 else min(self._sharpest, needed / self._build_up)
        a = self._slope(speed, wanted, limit)
        a += copysign(stoppable(abs(away), jerk, self._lag), away)
        a = min(max(a, -down), self._up)
        release = min(self._sharpest, max(jerk, -before / self._build_up))
        a = min(max(a, before - jerk * dt), before + release * dt)
        a = max(a, -now / dt)  # the reference speed does not become negative
        if wanted == 0.0 and now <= _STANDS:
            a = -now / dt
        self._limit = limit
        self.speed, self.acceleration = now + dt * a, a
        return now, a

    def _braking(self, speed: float, gap: float) -> float:
        """Return the deceleration [m/s^2] allowed: comfortable, or what a stop in time needs."""
        if gap == inf:
            return self._down
        p = self.parameters
        needed = self._to_stop(speed, gap - p.last_distance)
        in_time = self._to_stop(speed, gap - p.safe_distance)
        if in_time <= p.firm_deceleration:
            needed = max(needed, in_time)
        return min(max(self._down, needed), self._strongest)

    def _to_stop(self, speed: float, room: float) -> float:
        """The deceleration [m/s^2] that stops within ``room`` [m] once the brakes have built up."""
        left = room - speed * self._build_up
        return speed * speed / (2.0 * left) if left > 0.0 else inf

    def _slope(self, speed: float, wanted: float, limit: float) -> float:
        """The slope [m/s^2] of the target while the vehicle approaches a standing person."""
        p = self.parameters
        if wanted == 0.0 or wanted >= p.reference_speed:
            return 0.0
        if wanted == limit:
            change = (limit - self._limit) / self.time_step
            return change if abs(change) <= FOLLOW_LIMIT else 0.0  # 0 for a limit that is new
        if p.profile == "linear":
            return -speed * p.reference_speed / p.buffer_distance
        return -speed * self._down / (wanted + self._down * p.approach_lag)
