"""Measures how long background vehicles wait in a junction for people who stand there as well.

A vehicle that stops across a crossing blocks the way of the people for whom it waits, and they
would stand before each other for ever. After a time it is *stuck*, and creeps.
"""

from collections.abc import Set

import numpy as np
from numpy.typing import NDArray

from controller.driving_constants import CREEPING, PATIENCE, STANDING
from giveway.sumo.background import BackgroundVehicles
from giveway.sumo.vehicles import SumoVehicles
from pedestrian_model import Crowd

_NEAR = 4.0  # distance [m] from the front of a vehicle, within which people must stand
_STROLLS = 0.3  # speed [m/s] below which a person counts as standing; people in a jam sway


class Waits:
    """Measures how long vehicles wait for people.

    Args:
        step_length: SUMO's step [s].
    """

    def __init__(self, step_length: float) -> None:
        self._step_length = step_length
        self._waited: dict[str, float] = {}  # time [s] for which each vehicle has waited

    def stuck(
        self,
        background: BackgroundVehicles,
        waiting: NDArray[np.intp],
        crowd: Crowd,
        vehicles: SumoVehicles,
    ) -> Set[str]:
        """The ids of the vehicles that have waited too long for people who stand, in a junction.

        Args:
            background: The background vehicles now.
            waiting: Rows of those that have a person on their way.
            crowd: The pedestrians now.
            vehicles: Vehicles of the running simulation.
        """
        before, self._waited, found = self._waited, {}, set[str]()
        for i in waiting:
            name, speed = background.ids[i], float(background.speed[i])
            waited = before.get(name, 0.0)
            if speed >= STANDING and (waited <= PATIENCE or speed > CREEPING + STANDING):
                continue
            self._waited[name] = waited = waited + self._step_length
            if waited <= PATIENCE or not vehicles.whereabouts(name)[0].startswith(":"):
                continue
            place = background.x[i], background.y[i]
            near = np.hypot(*(crowd.position - place).T) <= _NEAR
            if (np.hypot(*crowd.velocity[near].T) < _STROLLS).all():
                found.add(name)
        return found
