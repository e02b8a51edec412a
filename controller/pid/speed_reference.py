"""The speed a tuned PID aims at: a profile over the gap, and how it is got to smoothly."""

from dataclasses import dataclass
from math import copysign, inf, sqrt
from typing import Literal

from controller.defaults import BUFFER_DISTANCE, REFERENCE_SPEED, SAFE_DISTANCE
from controller.parameters import require, require_not_negative, require_positive

ProfileName = Literal["braking-curve", "linear"]

_OTHERS_CURVE = 4.0  # Largest deceleration [m/s^2] to follow an external limit
_STANDS = 0.005  # Reference speed [m/s] below which the brake holds the vehicle


@dataclass(frozen=True, slots=True)
class ReferenceParameters:
    """The parameters of stopping and braking, chosen by the study in docs/pid.md."""

    reference_speed: float = REFERENCE_SPEED  # v_r [m/s]
    safe_distance: float = SAFE_DISTANCE  # d_safe [m]
    profile: ProfileName = "braking-curve"
    buffer_distance: float = BUFFER_DISTANCE  # d_buffer [m] of the linear profile
    deceleration: float = 1.0  # b [m/s^2] of the braking curve, and of braking in comfort
    approach_lag: float = 0.5  # tau [s]: near d_safe the braking curve is the line (gap-d_safe)/tau
    acceleration: float = 3.0  # a [m/s^2] of driving off
    jerk: float = 10.0  # j [m/s^3] of a change of acceleration in comfort
    firm_deceleration: float = 3.0  # [m/s^2] largest used to keep d_safe; beyond it d_last counts
    last_distance: float = 2.0  # d_last [m]: braking is as hard as needed to keep it
    creep_speed: float = 0.1  # [m/s] target speeds below it count as a stop

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

    It is the positive x of x lag + x^2 / (2 rate) = room (the safe speed of Gipps 1981): far away
    the braking curve sqrt(2 rate room), near the end the line room / lag, of finite slope.
    """
    return sqrt((rate * lag) ** 2 + 2.0 * rate * room) - rate * lag


class SpeedReference:
    """v_ref and its slope: what the profile asks for, within limits of acceleration and jerk.

    In comfort acceleration, deceleration and jerk are the parameters'. Where that would end closer
    than ``last_distance`` to who is in front, it brakes as hard as a stop there takes.

    Args:
        parameters: profile and comfort.
        strongest: acceleration [m/s^2] that the vehicle's forces reach.
        sharpest: jerk [m/s^3] that they reach.
        time_step: dt [s].
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
        self._build_up = self._down / self._jerk  # [s] until comfortable braking is reached
        # A change of acceleration takes effect a step later; shorter lags overshoot the target.
        self._lag = 2.0 * time_step
        self._wanted, self._asked = 0.0, (0.0, 0.0)  # to who is that close nobody drives
        self.start(0.0)

    def start(self, speed: float, acceleration: float = 0.0) -> None:
        """Go on from the vehicle's speed [m/s] and acceleration [m/s^2]."""
        self.speed = max(0.0, speed)
        self.acceleration = acceleration
        self._limit = inf

    def target(self, gap: float, limit: float = inf) -> float:
        """The profile [m/s] at ``gap`` [m] to who is in front; never more than ``limit`` [m/s]."""
        if (gap, limit) == self._asked:  # as by who wants to know what was just aimed at
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
        # Limits for stop lines and vehicles are braking curves already and have to be followed.
        down = needed if limit == inf else min(max(needed, _OTHERS_CURVE), self._strongest)
        away = wanted - now
        jerk = self._jerk if away >= 0.0 else min(self._sharpest, needed / self._build_up)
        a = self._slope(speed, wanted, limit)
        a += copysign(stoppable(abs(away), jerk, self._lag), away)
        a = min(max(a, -down), self._up)
        release = min(self._sharpest, max(jerk, -before / self._build_up))
        a = min(max(a, before - jerk * dt), before + release * dt)
        a = max(a, -now / dt)  # it does not go back
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
        """The target's own slope [m/s^2], while the vehicle approaches who stands in front."""
        p = self.parameters
        if wanted == 0.0 or wanted >= p.reference_speed:
            return 0.0
        if wanted == limit:
            change = (limit - self._limit) / self.time_step
            return change if abs(change) <= _OTHERS_CURVE else 0.0  # else it has just appeared
        if p.profile == "linear":
            return -speed * p.reference_speed / p.buffer_distance
        return -speed * self._down / (wanted + self._down * p.approach_lag)
