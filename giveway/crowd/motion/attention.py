"""Distracted people, who look at a phone, notice a vehicle late. This works with any model.

A distracted person walks as if there were no vehicle until one is within 2 m, and then like
everybody else. Studies show that they look less for traffic (Thompson et al., Injury Prevention 19,
2013: "failing to look both ways"). The distance of 2 m is giveway's own assumption.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from giveway.crowd.motion.neighbours import AroundModel
from giveway.geometry.kernel import Array
from pedestrian_model import (
    OPEN_GROUND,
    Crowd,
    PedestrianModel,
    Surroundings,
    Vehicles,
)

NOTICED = 2.0  # distance [m] to a vehicle, within which distracted people notice it
_NONE = Vehicles.empty()


class Inattentive(AroundModel):
    """A model whose distracted people notice vehicles late.

    If somebody does not notice a vehicle, the crowd is stepped twice: with and without vehicles.
    This needs a model without a memory, as the bundled ones are.

    Args:
        model: Model that moves all people.
        distracted: Function that returns the marks (n,) of distracted people.
    """

    def __init__(self, model: PedestrianModel, distracted: Callable[[], NDArray[np.bool_]]) -> None:
        super().__init__(model)
        self._distracted = distracted

    def advance(
        self, crowd: Crowd, vehicles: Vehicles, surroundings: Surroundings = OPEN_GROUND
    ) -> None:
        """Step the crowd in place."""
        unaware = self._distracted()
        if len(vehicles) and unaware.any():
            unaware &= distance_to_next(crowd.position, vehicles) > NOTICED
        if not (len(vehicles) and unaware.any()):
            self._model.advance(crowd, vehicles, surroundings)
            return
        alone = crowd.copy()
        self._model.advance(alone, _NONE, surroundings)
        self._model.advance(crowd, vehicles, surroundings)
        for now, instead in zip(crowd.state, alone.state, strict=True):
            now[unaware] = instead[unaware]


def distance_to_next(position: Array, vehicles: Vehicles) -> Array:
    """Return the distance (n,) [m] of each ``position`` (n, 2) [m] to the nearest vehicle."""
    return np.asarray(distances(position, vehicles).min(axis=1))


def distances(position: Array, vehicles: Vehicles) -> Array:
    """Return the distance (n, m) [m] of each ``position`` (n, 2) [m] to each of m vehicles."""
    x, y, heading, _, front, rear, width = vehicles.array.T
    d_x, d_y = position[:, :1] - x, position[:, 1:] - y
    along = d_x * np.cos(heading) + d_y * np.sin(heading)
    beside = np.abs(d_y * np.cos(heading) - d_x * np.sin(heading)) - width / 2.0
    beyond = np.maximum(along - front, -rear - along)
    return np.asarray(np.hypot(np.maximum(beyond, 0.0), np.maximum(beside, 0.0)))
