"""A walk by a script: stand, set out, accelerate evenly, go on at one speed, whatever comes."""

from dataclasses import dataclass
from math import cos, inf, radians, sin, sqrt

import numpy as np

from giveway.config.tables.scripted import ScriptedConfig
from giveway.geometry.kernel import Array
from pedestrian_model import Vehicles

_STRAIGHT = 1e-3  # Change of heading [rad] up to which a vehicle comes straight on
_MOVING = 0.1  # Speed [m/s] above which a vehicle comes to a meeting


@dataclass(frozen=True)
class Script:
    """The distance walked over the time since setting out.

    Attributes:
        speed: Speed [m/s] after the acceleration.
        acceleration_distance: Distance [m] of the acceleration.
        distance: Length of the walk [m].
    """

    speed: float
    acceleration_distance: float
    distance: float

    @property
    def acceleration(self) -> float:
        """The acceleration [m/s^2] at first."""
        return self.speed**2 / (2.0 * self.acceleration_distance)

    def time_at(self, distance: float) -> float:
        """Return the time [s] after which a distance [m] has been walked."""
        if distance <= self.acceleration_distance:
            return sqrt(2.0 * distance / self.acceleration)
        return (distance + self.acceleration_distance) / self.speed

    def at(self, time: float) -> tuple[float, float]:
        """Return the distance walked [m] and the speed [m/s] at a time [s], which may be < 0."""
        time = max(time, 0.0)
        speed = min(self.acceleration * time, self.speed)
        walked = speed * time - speed**2 / (2.0 * self.acceleration)
        return (self.distance, 0.0) if walked >= self.distance else (walked, speed)


class ScriptedWalk:
    """The walk of one person by a script.

    Args:
        entry: Entry of the configuration.
    """

    def __init__(self, entry: ScriptedConfig) -> None:
        self._entry = entry
        self._script = Script(entry.speed, entry.acceleration_distance, entry.distance)
        angle = radians(entry.heading)
        self._direction = np.array([cos(angle), sin(angle)])
        self._start = np.array([entry.x, entry.y])
        self._time = -entry.begin  # since setting out [s]; unknown before a meeting
        self._met: float | None = None  # heading [rad] of the vehicle that is to be met
        if entry.meet_after is not None:
            self._time = -inf

    def go_on(self, vehicles: Vehicles, time_step: float) -> tuple[Array, Array]:
        """Return the position (2,) [m] and velocity (2,) [m/s] after the next step.

        Args:
            vehicles: Vehicles at the beginning of the step.
            time_step: Length of the step [s].
        """
        if self._entry.meet_after is not None and self._time < 0.0:
            self._time = -self._time_left(vehicles, self._entry.meet_after)
        self._time += time_step
        walked, speed = self._script.at(self._time)
        return self._start + walked * self._direction, speed * self._direction

    def _time_left(self, vehicles: Vehicles, meet_after: float) -> float:
        """Return the time [s] to setting out, so as to meet the first vehicle; inf without one.

        A vehicle that has turned since it came straight on is expected at the time that was known.
        """
        entry, soonest, turned = self._entry, inf, False
        for x, y, heading, speed, front, *_ in vehicles.array:
            if speed <= _MOVING:
                continue
            if self._met is not None and abs(heading - self._met) > _STRAIGHT:
                turned = True
                continue
            way = cos(heading), sin(heading)
            ahead = (entry.meet_x - x) * way[0] + (entry.meet_y - y) * way[1] - front
            if ahead >= 0.0 and ahead / speed < soonest:
                soonest, came = ahead / speed, heading
        if soonest < inf:
            self._met = came
            return max(soonest - self._script.time_at(meet_after), 0.0)
        return -self._time if turned else inf
