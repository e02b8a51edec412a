"""The competent and careful human driver of UN Regulation No. 157, as a reference driver.

Annex 3 of the regulation (automated lane keeping, 2021) has a performance model of such a driver,
who says which collisions are preventable: risk is perceived for 0.4 s, 0.75 s later the vehicle
begins to decelerate, after another 0.6 s it does so with 0.774 g, and holds that. It is about
vehicles that cut in; here a person who steps onto the way less than 2 s before the vehicle, too
close for comfortable braking, cuts in as well (ours). For all others, stop lines and leaders it
brakes comfortably; the regulation has its driver keep 2 s to the latter. Numbers cited from memory.

It does not look for gaps and expects nobody to step onto its way: what it cannot prevent, it hits.
It is an example of a controller by the door that is open to everybody:
:mod:`controller.plug_ins.plug_in`.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, sqrt

import numpy as np

from controller.observation import Observation
from controller.parameters import require_not_negative, require_positive
from controller.plug_ins.plug_in import Acceleration, Setup
from controller.reference_drivers.people_ahead import people_ahead

_G = 9.81  # [m/s^2]
_SLOWEST = 1.0  # [m/s] with which it counts when it will be somewhere
_CREEP = 0.2  # [m/s] below it the vehicle stands
_AT_LINE = 0.5  # [m] before a stop line it stands
_NEARLY = 0.1  # [m] the shortest way to stop in
_URGENT = 1.2  # Factor on comfortable deceleration beyond which a person has cut in
_BEGINS = 0.8  # Factor on it from which braking to a standstill begins
_TAKES_UP = 0.5  # [s] in which it takes up a speed


@dataclass(frozen=True)
class CarefulOptions:
    """Parameters of the driver.

    Attributes:
        perception: [s] for which risk is evaluated.
        delay: [s] from then until deceleration begins.
        ramp: [s] until it is as hard as it gets.
        deceleration: [g] then.
        horizon: [s] to somebody on the way, below which that is a risk.
        headway: [s] to a leader.
        comfort: [m/s^2] of accelerating, and of braking where nothing is urgent.
        gap: [m] to whoever is ahead, at standstill.
        half_width: [m] from the middle of its way, nearer than which a person's centre is on it.

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
    """Brakes late and hard for those who cut in, and gently for all else.

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
        self._known: dict[int, float] = {}  # [s] in which somebody on the way will be perceived
        self._braking = 0.0  # [s] for which it has braked as hard as it can

    def control(self, seen: Observation) -> Acceleration:
        """Emergency braking if it has come to that, else the least comfortable acceleration."""
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
        """The acceleration [m/s^2] that leads to another speed within a distance [m]."""
        o = self._options
        left = max(room - o.gap, 0.0)
        needed = (v * v - speed * speed) / (2.0 * max(left, _NEARLY))
        if needed > _BEGINS * o.comfort:
            return -min(needed, _URGENT * o.comfort)
        return (sqrt(speed * speed + 2.0 * o.comfort * left) - v) / _TAKES_UP

    def _is_urgent(self, room: float, speed: float) -> bool:
        """Return whether comfortable braking is too weak for somebody within the horizon."""
        o = self._options
        if speed < _CREEP or room / max(speed, _SLOWEST) >= o.horizon:
            return False
        needed = speed * speed / (2.0 * max(room - o.gap, _NEARLY))
        return needed > _URGENT * o.comfort or self._braking > 0.0

    def _nearest(self, seen: Observation) -> float:
        """Return the distance [m] along the way to the closest perceived person on it.

        A person who steps onto it urgently close is perceived with a delay, all others at once.
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
