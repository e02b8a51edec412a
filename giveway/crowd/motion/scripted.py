"""A walk by a script: stand, set out, accelerate evenly, go on at one speed, whatever comes."""

from dataclasses import dataclass
from math import cos, inf, radians, sin, sqrt

import numpy as np

from giveway.config.tables.scripted import ScriptedConfig
from giveway.geometry.kernel import Array
from pedestrian_model import Vehicles

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
        self._time = -entry.begin  # since setting out [s]
        self._waits = entry.meet_after is not None

    def go_on(self, vehicles: Vehicles, time_step: float) -> tuple[Array, Array]:
        """Return the position (2,) [m] and velocity (2,) [m/s] after the next step.

        Args:
            vehicles: Vehicles at the beginning of the step.
            time_step: Length of the step [s].
        """
        if self._waits:
            left = self._time_left(vehicles)
            if left < time_step:
                self._waits, self._time = False, -max(left, 0.0)
        if not self._waits:
            self._time += time_step
        walked, speed = (0.0, 0.0) if self._waits else self._script.at(self._time)
        return self._start + walked * self._direction, speed * self._direction

    def _time_left(self, vehicles: Vehicles) -> float:
        """Return the time [s] to setting out, so as to meet the first vehicle; inf without one."""
        entry, soonest = self._entry, inf
        assert entry.meet_after is not None
        for x, y, heading, speed, front, *_ in vehicles.array:
            way = cos(heading), sin(heading)
            ahead = (entry.meet_x - x) * way[0] + (entry.meet_y - y) * way[1] - front
            if ahead >= 0.0 and speed > _MOVING:
                soonest = min(soonest, ahead / speed)
        return soonest - self._script.time_at(entry.meet_after)
