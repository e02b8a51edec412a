"""Background vehicles brake for the pedestrians that giveway moves.

SUMO's vehicles look for persons on lanes and crossings. A person that is moved from outside is on
none of them, so SUMO's vehicles would drive through it. Therefore each vehicle's speed is limited
to one from which it stops before the next pedestrian in its corridor, with the deceleration of its
own type: Krauss's safe speed (Krauss 1998, eq. 2.24, with a standing leader).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from giveway.config.controller_sections import CORRIDOR_MARGIN
from giveway.cosimulation.lane_paths import LanePaths, gaps_ahead, sort_pedestrians

if TYPE_CHECKING:
    from giveway.sumo.background import BackgroundVehicles
    from giveway.sumo.vehicles import SumoVehicles
    from pedestrian_model import Crowd

_LOOK_AHEAD = 1.0  # [s] for which pedestrians are expected to keep their velocity
_REACTION = 1.0  # [s] reaction time of SUMO's default car-following model


class Yielding:
    """Slows background vehicles down for pedestrians.

    Args:
        vehicles: of the running simulation.
        step_length: SUMO's step [s], in which a limit holds.
        distance: [m] before a pedestrian at which vehicles want to stop.

    Attributes:
        limited: the speed [m/s] of those that yield at present, by their ids.
    """

    limited: dict[str, float]

    def __init__(self, vehicles: SumoVehicles, step_length: float, distance: float) -> None:
        self._vehicles = vehicles
        self._reaction = max(step_length, _REACTION)
        self._distance = distance
        self.limited = {}
        self._lane_paths = LanePaths(vehicles)
        self._ever: set[str] = set()
        self._step_length = step_length
        self._time = 0.0

    @property
    def report(self) -> dict[str, float]:
        """How many vehicles ever yielded, and for how long [s] in all."""
        return {"vehicles_that_yielded": len(self._ever), "time_yielding": round(self._time, 6)}

    def update(self, background: BackgroundVehicles, crowd: Crowd) -> None:
        """Once after each SUMO step: limit vehicles with a pedestrian ahead, release the others.

        Args:
            background: the background vehicles now.
            crowd: the pedestrians now.
        """
        limits = self._limits(background, crowd) if background.ids and len(crowd) else {}
        before = self.limited
        if before and before.keys() - limits.keys():
            gone = before.keys() - set(background.ids)
            for name in sorted(before.keys() - limits.keys() - gone):
                self._vehicles.release(name)
        for name, limit in limits.items():
            if before.get(name) != limit:
                self._vehicles.limit(name, limit)
        self.limited = limits
        self._ever.update(limits)
        self._time += self._step_length * len(limits)

    def _limits(self, background: BackgroundVehicles, crowd: Crowd) -> dict[str, float]:
        """The speed limit [m/s] of each vehicle with a pedestrian ahead."""
        # decelerations are at least 2 m/s^2, so this is how far a vehicle has to look
        sight = (
            background.speed * self._reaction + background.speed**2 / 4.0 + self._distance + 10.0
        )
        pedestrians = np.concatenate(
            [crowd.position, crowd.position + _LOOK_AHEAD * crowd.velocity]
        )
        numbers, positions = self._lane_paths.of(background.ids, sight.tolist())
        self._lane_paths.forget(background.ids)
        gaps = np.full(len(background.ids), np.inf)
        if (numbers >= 0).any():
            gaps_ahead(
                np.column_stack([background.x, background.y]),
                positions,
                numbers,
                self._lane_paths.pool,
                sight,
                background.width / 2 + CORRIDOR_MARGIN,
                pedestrians,
                sort_pedestrians(pedestrians),
                gaps,
            )
        limits = {}
        for i in np.flatnonzero(gaps <= sight):
            b = self._vehicles.deceleration(background.ids[i])
            room = max(0.0, float(gaps[i]) - self._distance)
            reaction = b * self._reaction
            safe = -reaction + math.sqrt(reaction * reaction + 2.0 * b * room)
            if safe < background.speed[i] + b * self._step_length:
                limits[background.ids[i]] = safe
        return limits
