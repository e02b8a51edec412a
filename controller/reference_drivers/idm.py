"""A human driver for reference: the intelligent driver model, with gap acceptance towards people.

The car-following model is the improved IDM of Treiber and Kesting, *Traffic Flow Dynamics*
(Springer 2013), chapter 11, with its parameters for city traffic. The IDM is by Treiber, Hennecke
and Helbing (Phys. Rev. E 62, 1805, 2000). It responds to leaders and stop lines. For people the
driver accepts gaps. A person on the driver's way counts as a standing leader, and so does one who
will come onto it, at the present velocity, before the driver has passed. A person who will have
left before the driver arrives does not count, nor does one who arrives after the driver has passed.
Both need a margin of time.

The driver is an example of a controller that uses the plug-in protocol,
:mod:`controller.plug_in`.
"""

from dataclasses import dataclass
from math import inf, sqrt

import numpy as np
from numpy.typing import NDArray

from controller._jit import Array
from controller.driving_constants import FOLLOW_LIMIT
from controller.observation import Observation
from controller.parameters import require_not_negative, require_positive
from controller.plug_in import Acceleration, Setup
from controller.reference_drivers.people_ahead import people_ahead

_AT_LINE = 0.5  # distance [m] to a stop line at standstill
_NEARLY = 0.01  # least gap [m] and speed [m/s], against a division by zero
_POSITIVE = {
    "acceleration": "m/s^2",
    "deceleration": "m/s^2",
    "exponent": "-",
    "half_width": "m",
    "length": "m",
}
_TAKES_UP = 0.5  # time constant [s] with which the driver follows a limit that falls, as in a bend
_SLOWEST = 1.0  # least speed [m/s] for the computation of arrival times


@dataclass(frozen=True)
class IdmOptions:
    """Parameters of the driver.

    Attributes:
        acceleration: Largest acceleration a [m/s^2].
        deceleration: Comfortable deceleration b [m/s^2].
        headway: Headway T [s] to a leader.
        standing_gap: Gap s_0 [m] to a leader, at standstill.
        exponent: Exponent delta of the free acceleration.
        half_width: Half width [m] of the way, on which a person's centre counts.
        length: Length [m] of the vehicle, for the time at which it has passed a person.
        margin: Least time [s] between the vehicle and a person who crosses before or after it.

    Raises:
        ParameterError: a value is not finite or out of range.
    """

    acceleration: float = 1.0
    deceleration: float = 1.5
    headway: float = 1.0
    standing_gap: float = 2.0
    exponent: float = 4.0
    half_width: float = 1.4
    length: float = 4.5
    margin: float = 1.0

    def __post_init__(self) -> None:
        for name, unit in _POSITIVE.items():
            require_positive(name, getattr(self, name), unit)
        for name, unit in {"headway": "s", "standing_gap": "m", "margin": "s"}.items():
            require_not_negative(name, getattr(self, name), unit)


class IntelligentDriver:
    """A car-following driver who accepts gaps between people.

    Args:
        setup: Setup of the drive.
        options: Options of the driver.
    """

    Options = IdmOptions

    def __init__(self, setup: Setup, options: IdmOptions) -> None:
        self._setup, self._options = setup, options

    def control(self, seen: Observation) -> Acceleration:
        """Return the acceleration for the leader that allows the least."""
        v, o = seen.speed, self._options
        wanted, cause = self._setup.reference_speed, "free"
        if seen.speed_limit < wanted:
            wanted, cause = max(seen.speed_limit, _NEARLY), "speed limit"
        best = self._acceleration(v, wanted, inf, 0.0), cause
        if seen.speed_limit < v:  # the IDM alone comes down to a limit only slowly
            best = min(best, (max((seen.speed_limit - v) / _TAKES_UP, -FOLLOW_LIMIT), cause))
        leaders = (
            (seen.leader_gap, seen.leader_speed, "vehicle"),
            (seen.stop_gap - _AT_LINE + o.standing_gap, 0.0, "stop line"),
            (self._nearest_person(seen), 0.0, "person"),
        )
        for gap, speed, name in leaders:
            if gap < inf:
                best = min(best, (self._acceleration(v, wanted, gap, speed), name))
        hardest = self._setup.force_limit / self._setup.mass
        return Acceleration(max(best[0], -hardest), best[1])

    def _acceleration(self, v: float, wanted: float, gap: float, leader: float) -> float:
        """The acceleration [m/s^2] of the improved IDM.

        Args:
            v: Speed [m/s].
            wanted: Speed [m/s] on a free road.
            gap: Gap [m] to the leader; inf without one.
            leader: Speed [m/s] of the leader.
        """
        o = self._options
        a, b = o.acceleration, o.deceleration
        needed = o.standing_gap + max(0.0, v * o.headway + v * (v - leader) / (2.0 * sqrt(a * b)))
        z = needed / max(gap, _NEARLY)
        if v <= wanted:
            free: float = a * (1.0 - (v / wanted) ** o.exponent)
            if z >= 1.0:
                return a * (1.0 - z * z)
            return float(free * (1.0 - z ** (2.0 * a / free))) if free > 0.0 else 0.0
        free = -b * (1.0 - (wanted / v) ** (a * o.exponent / b))
        return free + a * (1.0 - z * z) if z >= 1.0 else free

    def _nearest_person(self, seen: Observation) -> float:
        """The distance [m] along the way to the closest person who counts; inf without one."""
        found = people_ahead(seen)
        if found is None:
            return inf
        blocks = self._takes_the_way(*found, seen.speed)
        return float(found.distance[blocks & found.in_sight].min(initial=inf))

    def _takes_the_way(
        self, distance: Array, aside: Array, towards: Array, speed: float
    ) -> NDArray[np.bool_]:
        """Return whether each person (n,) is on the way or comes onto it before the vehicle.

        Args:
            distance: Distances (n,) [m] of people along the way.
            aside: Distances (n,) [m] from the middle of the way.
            towards: Speeds (n,) [m/s] towards the middle of the way.
            speed: Speed of the vehicle [m/s].
        """
        o, pace = self._options, max(speed, _SLOWEST)
        comes = towards > 0.0
        per_metre = 1.0 / np.where(comes, towards, 1.0)
        enters = np.maximum(aside - o.half_width, 0.0) * per_metre
        leaves = (aside + o.half_width) * per_metre
        arrives = np.maximum(distance, 0.0) / pace
        passed = self._travel_time(np.maximum(distance, 0.0) + o.length, speed)
        in_time = leaves + o.margin < arrives
        later = enters > passed + o.margin
        on_it = aside < o.half_width
        going = np.maximum(o.half_width - aside, 0.0) / np.maximum(-towards, _NEARLY)
        gone = np.where(comes, in_time, going + o.margin < arrives)
        return np.asarray(np.where(on_it, ~gone, comes & ~in_time & ~later))

    def _travel_time(self, distance: Array, speed: float) -> Array:
        """The time [s] that each distance (n,) [m] takes if the driver speeds up from now on."""
        a, wanted = self._options.acceleration, max(self._setup.reference_speed, speed, _SLOWEST)
        rising = (wanted * wanted - speed * speed) / (2.0 * a)
        while_rising = (np.sqrt(speed * speed + 2.0 * a * np.minimum(distance, rising)) - speed) / a
        return np.asarray(while_rising + np.maximum(distance - rising, 0.0) / wanted)
