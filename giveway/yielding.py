"""SUMO's own cars and the pedestrians that giveway moves: the cars brake for them.

SUMO's drivers look for persons on lanes and crossings; who is moved from outside is on none, and
they drive through him. So each car's speed is limited to one from which it stops before the next
pedestrian in its corridor, with the deceleration of its own type: Krauss's safe speed
(Krauss 1998, eq. 2.24, with a standing leader).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from giveway.corridor import closest_in_front
from giveway.ego_path import EgoPath
from giveway.errors import ScenarioError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from giveway.sumo_vehicles import SumoVehicles
    from giveway.traffic import BackgroundVehicles
    from pedestrian_model import Crowd

    Array = NDArray[np.float64]

_SIDE = 0.25  # [m] of the corridor beyond the car's body, as for the ego
_LOOK_AHEAD = 1.0  # [s] for which people are expected to walk on as they do
_REACTION = 1.0  # [s] of SUMO's default driver


class Yielding:
    """Slows SUMO's cars down for pedestrians.

    Args:
        vehicles: SUMO's.
        step_length: SUMO's step [s], in which a limit holds.
        distance: [m] the cars want to stop before a pedestrian.
    """

    def __init__(self, vehicles: SumoVehicles, step_length: float, distance: float) -> None:
        self._vehicles = vehicles
        self._reaction = max(step_length, _REACTION)
        self._distance = distance
        self._limited: set[str] = set()
        self._ever: set[str] = set()
        self._step_length = step_length
        self._time = 0.0

    @property
    def report(self) -> dict[str, float]:
        """How many cars ever yielded, and for how long [s] in all."""
        return {"vehicles_that_yielded": len(self._ever), "time_yielding": round(self._time, 6)}

    def update(self, cars: BackgroundVehicles, crowd: Crowd) -> None:
        """Once after each SUMO step: limit whom somebody stands before, release the others.

        Args:
            cars: SUMO's own vehicles now.
            crowd: the pedestrians now.
        """
        limits = self._limits(cars, crowd) if cars.ids and len(crowd) else {}
        if not limits and not self._limited:
            return
        present = set(cars.ids)
        for name in sorted(self._limited - limits.keys()):
            if name in present:
                self._vehicles.release(name)
        for name, limit in limits.items():
            self._vehicles.limit(name, limit)
        self._limited = set(limits)
        self._ever |= self._limited
        self._time += self._step_length * len(limits)

    def _limits(self, cars: BackgroundVehicles, crowd: Crowd) -> dict[str, float]:
        """The speed [m/s] of each car that has somebody in its way."""
        walked = crowd.position + _LOOK_AHEAD * crowd.velocity
        people = np.concatenate([crowd.position, walked])
        tree = cKDTree(people)
        # nobody brakes at less than 2 m/s^2, so this is how far a car has to look
        sight = cars.speed * self._reaction + cars.speed**2 / 4.0 + self._distance + 10.0
        found = tree.query_ball_point(np.column_stack([cars.x, cars.y]), sight)
        limits = {}
        for i in range(len(cars.ids)):
            if found[i]:
                near = people[sorted(found[i])]
                limit = self._limit(cars, i, float(sight[i]), near)
                if limit is not None:
                    limits[cars.ids[i]] = limit
        return limits

    def _limit(self, cars: BackgroundVehicles, i: int, sight: float, people: Array) -> float | None:
        name = cars.ids[i]
        points = self._vehicles.path_ahead(name, sight)
        if points is None:
            return None
        try:
            path = EgoPath.through(points)
        except ScenarioError:
            return None  # at the very end of its way
        half_width = float(cars.width[i]) / 2 + _SIDE
        segments = len(path.headings) - 1
        gap, _ = closest_in_front(
            path.vertices, path.stations, 0, segments, people, 0.0, half_width, 0.0
        )
        if not gap <= sight:
            return None
        b = self._vehicles.deceleration(name)
        room = max(0.0, gap - self._distance)
        reaction = b * self._reaction
        safe = -reaction + math.sqrt(reaction * reaction + 2.0 * b * room)
        return safe if safe < cars.speed[i] + b * self._step_length else None
