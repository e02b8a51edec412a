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

from giveway.cosimulation.paths_ahead import PathsAhead, gaps_ahead, sort_people

if TYPE_CHECKING:
    from giveway.sumo.background import BackgroundVehicles
    from giveway.sumo.vehicles import SumoVehicles
    from pedestrian_model import Crowd

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
        self._limited: dict[str, float] = {}
        self._paths = PathsAhead(vehicles)
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
        if not cars.ids and not self._limited:
            return
        limits = self._limits(cars, crowd) if cars.ids and len(crowd) else {}
        before = self._limited
        if before and before.keys() - limits.keys():
            gone = before.keys() - set(cars.ids)
            for name in sorted(before.keys() - limits.keys() - gone):
                self._vehicles.release(name)
        for name, limit in limits.items():
            if before.get(name) != limit:
                self._vehicles.limit(name, limit)
        self._limited = limits
        self._ever.update(limits)
        self._time += self._step_length * len(limits)

    def _limits(self, cars: BackgroundVehicles, crowd: Crowd) -> dict[str, float]:
        """The speed [m/s] of each car that has somebody in its way."""
        # nobody brakes at less than 2 m/s^2, so this is how far a car has to look
        sight = cars.speed * self._reaction + cars.speed**2 / 4.0 + self._distance + 10.0
        people = np.concatenate([crowd.position, crowd.position + _LOOK_AHEAD * crowd.velocity])
        numbers, positions = self._paths.of(cars.ids, sight.tolist())
        self._paths.forget(cars.ids)
        gaps = np.full(len(cars.ids), np.inf)
        if (numbers >= 0).any():
            gaps_ahead(
                np.column_stack([cars.x, cars.y]),
                positions,
                numbers,
                self._paths.ways,
                sight,
                cars.width / 2 + _SIDE,
                people,
                sort_people(people),
                gaps,
            )
        limits = {}
        for i in np.flatnonzero(gaps <= sight):
            b = self._vehicles.deceleration(cars.ids[i])
            room = max(0.0, float(gaps[i]) - self._distance)
            reaction = b * self._reaction
            safe = -reaction + math.sqrt(reaction * reaction + 2.0 * b * room)
            if safe < cars.speed[i] + b * self._step_length:
                limits[cars.ids[i]] = safe
        return limits
