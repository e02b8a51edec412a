"""The cohesion of groups: people far from the middle of their group accelerate towards it.

Moussaïd et al. 2010 (groups.py) have an acceleration of 3 m/s^2 towards the centre of a group of N,
for people more than (N - 1)/2 m from it. Here it rises to this value over another metre (ours), so
that nobody oscillates at the threshold. The paper's turning of heads and repulsion within a group
are left out, because the models' own repulsion keeps people apart. Only force-based models support
cohesion.
"""

from collections.abc import Callable
from typing import Final

import numpy as np
from numpy.typing import NDArray

from giveway.crowd.motion.neighbours import AroundModel
from giveway.crowd.motion.sway import pushed
from giveway.geometry.kernel import Array
from pedestrian_model import (
    OPEN_GROUND,
    Crowd,
    PedestrianModel,
    Surroundings,
    Vehicles,
)

BY_FORCES: Final = frozenset({"vci", "social-force"})
"""The models that support the cohesion of groups."""

_ATTRACTION = 3.0  # largest acceleration [m/s^2] towards the middle of the group
_RISE = 1.0  # distance [m] over which the acceleration rises to this value


class Cohesive(AroundModel):
    """A model whose groups stay together.

    Args:
        model: Model that moves all people.
        groups: Function that returns the index (n,) of each person's group; -1 for single people.
    """

    def __init__(self, model: PedestrianModel, groups: Callable[[], NDArray[np.int64]]) -> None:
        super().__init__(model)
        self._groups = groups

    def advance(
        self, crowd: Crowd, vehicles: Vehicles, surroundings: Surroundings = OPEN_GROUND
    ) -> None:
        """Step the crowd in place."""
        pull = attraction(crowd.position, self._groups())
        if not pull.any():
            self._model.advance(crowd, vehicles, surroundings)
            return
        before = crowd.velocity.copy()
        self._model.advance(crowd, vehicles, surroundings)
        pushed(self._model, crowd, before, pull * self._model.time_step)


def attraction(position: Array, groups: NDArray[np.int64]) -> Array:
    """Return the accelerations (n, 2) [m/s^2] of people towards the middle of their group.

    Args:
        position: Position (n, 2) [m] of each person.
        groups: Index (n,) of each person's group; -1 for single people.
    """
    pull = np.zeros_like(position)
    rows = np.flatnonzero(groups >= 0)
    if not len(rows):
        return pull
    _, member_of, size = np.unique(groups[rows], return_inverse=True, return_counts=True)
    middle = np.zeros((len(size), 2))
    np.add.at(middle, member_of, position[rows])
    way = (middle / size[:, None])[member_of] - position[rows]
    distance = np.hypot(way[:, 0], way[:, 1])
    beyond = distance - (size[member_of] - 1) / 2.0
    strength = _ATTRACTION * np.clip(beyond / _RISE, 0.0, 1.0)
    pull[rows] = (strength / np.maximum(distance, 1e-9))[:, None] * way
    return pull
