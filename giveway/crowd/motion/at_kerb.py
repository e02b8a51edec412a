"""People who wait for a gap stay off the roadway, whoever pushes them. This works with any model.

Other people and passing vehicles would push them onto the roadway, where vehicles stop for them
while they wait for the vehicles. Those who have come to the kerb stand there, and give way to
others slowly.
"""

import numpy as np
import shapely
from numpy.typing import NDArray

from giveway.crowd.motion.neighbours import AroundModel
from giveway.geometry.kernel import Array
from pedestrian_model import (
    OPEN_GROUND,
    Crowd,
    PedestrianModel,
    Surroundings,
    Vehicles,
    targets,
)

_AT_KERB = 0.4  # distance [m] to the way-point at the kerb within which people stand; own choice
_SHUFFLES = 0.3  # share of their motion that people who stand make, as others push; own choice


class HeldAtKerb(AroundModel):
    """A model whose people do not leave the sidewalk at a kerb at which they wait for a gap.

    Args:
        model: Model that moves all people.
        first: First of the signals at which people wait for a gap.
        count: Number of these signals.
        sidewalks: Sidewalks and walkingareas around the kerbs.
    """

    def __init__(
        self, model: PedestrianModel, first: int, count: int, sidewalks: shapely.Geometry
    ) -> None:
        super().__init__(model)
        self._first, self._count, self._sidewalks = first, count, sidewalks
        shapely.prepare(sidewalks)

    def advance(
        self, crowd: Crowd, vehicles: Vehicles, surroundings: Surroundings = OPEN_GROUND
    ) -> None:
        """Step the crowd in place."""
        signal = crowd.waypoint_signal[crowd.waypoint_start[:-1] + crowd.waypoint_index]
        for_gap = (signal >= self._first) & (signal < self._first + self._count)
        rows = np.flatnonzero(for_gap & surroundings.closed[signal])
        before = crowd.position[rows]
        self._model.advance(crowd, vehicles, surroundings)
        if not len(rows):
            return
        self._stand(crowd, rows, before)
        left = ~shapely.contains_xy(self._sidewalks, crowd.position[rows])
        left &= shapely.contains_xy(self._sidewalks, before)
        crowd.position[rows[left]] = before[left]
        crowd.velocity[rows[left]] = 0.0

    def _stand(self, crowd: Crowd, rows: NDArray[np.intp], before: Array) -> None:
        """Let people at the kerb stand, and give way to others slowly."""
        goal, now = targets(crowd, rows), crowd.position[rows]
        stands = np.hypot(*(goal - now).T) < _AT_KERB
        crowd.position[rows[stands]] = before[stands] + _SHUFFLES * (now - before)[stands]
