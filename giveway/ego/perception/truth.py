"""The truth that sensors are shown. Only sensors, recorder and metrics may use it."""

from dataclasses import dataclass, field

import numpy as np

from giveway.geometry.kernel import Array
from pedestrian_model import Crowd

ADULT = 1.719
"""Height [m] of SUMO's pedestrians by default."""


@dataclass(slots=True)
class Truth:
    """The world around the egos at one instant; the run refills one object in place.

    Attributes:
        people: Pedestrians (n,) within the zone.
        vehicles: Poses (m, 7) of all vehicles: x, y [m], heading [rad], speed [m/s], distances [m]
            from the reference point to the front and to the rear, width [m].
        outlines: Walls and buildings (k, 5): x0, y0, x1, y1, height [m]; k may be 0.
        time: SUMO's clock [s].
        vehicle_heights: Heights (m,) [m] of the vehicles.
        person_heights: Heights (n,) [m] of the pedestrians.
    """

    people: Crowd
    vehicles: Array
    outlines: Array
    time: float
    vehicle_heights: Array = field(default_factory=lambda: np.empty(0))
    person_heights: Array = field(default_factory=lambda: np.empty(0))

    @classmethod
    def of_people(cls, people: Crowd) -> "Truth":
        """The truth of pedestrians on open ground without vehicles, at time 0."""
        heights = np.full(len(people), ADULT)
        return cls(people, np.empty((0, 7)), np.empty((0, 5)), 0.0, person_heights=heights)
