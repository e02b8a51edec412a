"""The competent and careful human driver of UN Regulation No. 157, as a reference driver.

Annex 3 of the regulation (automated lane keeping, 2021) has a performance model of such a driver,
which defines the collisions that are preventable. The driver perceives a risk for 0.4 s. The
vehicle begins to decelerate 0.75 s later, reaches 0.774 g after another 0.6 s, and holds it. The
regulation applies this to vehicles that cut in. Here it also applies to a person who steps onto the
way less than 2 s ahead of the vehicle, too close for comfortable braking (giveway's addition). For
all other people, for stop lines and for leaders the driver brakes comfortably, with the
regulation's headway of 2 s to a leader. Numbers are cited from memory.

The driver does not look for gaps and does not expect anybody to step onto its way. It is an example
of a controller that uses the plug-in protocol, :mod:`controller.plug_in`.
"""

from dataclasses import dataclass
from math import inf, sqrt

import numpy as np

from controller.driving_constants import STANDING
from controller.observation import Observation
from controller.parameters import require_not_negative, require_positive
from controller.plug_in import Acceleration, Setup
from controller.reference_drivers.people_ahead import people_ahead

_G = 9.81  # acceleration of gravity [m/s^2]
_SLOWEST = 1.0  # least speed [m/s] for the computation of arrival times
_AT_LINE = 0.5  # distance [m] to a stop line at standstill
_NEARLY = 0.1  # least distance [m] of a stop, against a division by zero
_URGENT = 1.2  # factor on comfortable deceleration, beyond which a person has cut in
_BEGINS = 0.8  # factor on comfortable deceleration, from which on the driver brakes
_TAKES_UP = 0.5  # time constant [s] with which the driver approaches a speed


@dataclass(frozen=True)
class CarefulOptions:
    """Parameters of the driver.

    Attributes:
        perception: Time [s] for which a risk is evaluated.
        delay: Time [s] from then until the deceleration begins.
        ramp: Time [s] in which the deceleration reaches its largest value.
        deceleration: Largest deceleration [g].
        horizon: Time [s] to a person on the way, below which the person is a risk.
        headway: Headway [s] to a leader.
        comfort: Comfortable acceleration and deceleration [m/s^2].
        gap: Distance [m] to an obstacle ahead, at standstill.
        half_width: Half width [m] of the way, on which a person's centre counts.

    Raises:
        ParameterError: a value is not finite or out of range.
    """

    perception: float = 0.4
    delay: float = 0.75
    ramp: float = 0.6
    deceleration: float = 0.774
    horizon: float = 2.0
    headway: float = 2.0
    comfort: float = 1.5
    gap: float = 2.0
    half_width: float = 1.4

    def __post_init__(self) -> None:
        for name, unit in {"perception": "s", "delay": "s", "headway": "s", "gap": "m"}.items():
            require_not_negative(name, getattr(self, name), unit)
        positive = {"ramp": "s", "deceleration": "g", "horizon": "s", "comfort": "m/s^2"}
        for name, unit in (positive | {"half_width": "m"}).items():
            require_positive(name, getattr(self, name), unit)


class CarefulDriver:
    """The careful driver: it brakes late and hard for people who cut in, and gently otherwise.

    Args:
        setup: Setup of the drive.
        options: Options of the driver.
    """

    Options = CarefulOptions

    def __init__(self, setup: Setup, options: CarefulOptions) -> None:
        self._setup, self._options = setup, options
        self.reset()

    def reset(self) -> None:
        """Forget the past."""
        self._known: dict[int, float] = {}  # time [s] until a person on the way is perceived
        self._braking = 0.0  # duration [s] of the present emergency braking

    def control(self, seen: Observation) -> Acceleration:
        """Return the emergency braking for a person who cuts in, or a comfortable acceleration."""
        o, setup, v = self._options, self._setup, seen.speed
        hardest = setup.force_limit / setup.mass
        person = self._nearest(seen)
        if self._is_urgent(person, v):
            self._braking += setup.time_step
            wanted = -min(1.0, self._braking / o.ramp) * o.deceleration * _G
            return Acceleration(max(wanted, -hardest), "cut in")
        self._braking = 0.0
        best = (min(setup.reference_speed, seen.speed_limit) - v) / _TAKES_UP, "free"
        for room, speed, cause in (
            (person, 0.0, "person"),
            (seen.leader_gap - o.headway * v, max(seen.leader_speed, 0.0), "vehicle"),
            (seen.stop_gap - _AT_LINE + o.gap, 0.0, "stop line"),
        ):
            if room < inf:
                best = min(best, (self._comfortable(room, v, speed), cause))
        return Acceleration(max(-hardest, min(best[0], o.comfort)), best[1])

    def _comfortable(self, room: float, v: float, speed: float) -> float:
        """The acceleration [m/s^2] that leads from ``v`` to ``speed`` [m/s] within ``room`` [m]."""
        o = self._options
        left = max(room - o.gap, 0.0)
        needed = (v * v - speed * speed) / (2.0 * max(left, _NEARLY))
        if needed > _BEGINS * o.comfort:
            return -min(needed, _URGENT * o.comfort)
        return (sqrt(speed * speed + 2.0 * o.comfort * left) - v) / _TAKES_UP

    def _is_urgent(self, room: float, speed: float) -> bool:
        """Return whether comfortable braking is too weak for a person at distance ``room`` [m]."""
        o = self._options
        if speed < STANDING or room / max(speed, _SLOWEST) >= o.horizon:
            return False
        needed = speed * speed / (2.0 * max(room - o.gap, _NEARLY))
        return needed > _URGENT * o.comfort or self._braking > 0.0

    def _nearest(self, seen: Observation) -> float:
        """Return the distance [m] along the way to the closest perceived person on it.

        A person who cuts in is perceived with a delay, all others at once.
        """
        o, found = self._options, people_ahead(seen)
        if found is None:
            self._known = {}
            return inf
        nearest, known = inf, dict[int, float]()
        for i in np.flatnonzero((found.aside < o.half_width) & found.in_sight):
            name = int(i) if seen.person_ids is None else int(seen.person_ids[i])
            distance = float(found.distance[i])
            left = self._known.get(name)
            if left is None:
                late = self._is_urgent(distance, seen.speed)
                left = o.perception + o.delay if late else 0.0
            known[name] = left - self._setup.time_step
            if left <= 0.0:
                nearest = min(nearest, distance)
        self._known = known
        return nearest
