"""The truth that sensors are shown. Only sensors, recorder and metrics may use it."""

from dataclasses import dataclass

import numpy as np

from giveway.geometry.kernel import Array
from pedestrian_model import Crowd


@dataclass(slots=True)
class Truth:
    """The world around the egos at one instant; the run refills one object in place.

    Attributes:
        people: Pedestrians (n,) within the zone.
        vehicles: Poses (m, 7) of all vehicles: x, y [m], heading [rad], speed [m/s], distances [m]
            from the reference point to the front and to the rear, width [m].
        outlines: Static outlines (k, 4) that may hide people: x0, y0, x1, y1 [m]; k may be 0.
        time: SUMO's clock [s].
    """

    people: Crowd
    vehicles: Array
    outlines: Array
    time: float

    @classmethod
    def of_people(cls, people: Crowd) -> "Truth":
        """The truth of pedestrians on open ground without vehicles, at time 0."""
        return cls(people, np.empty((0, 7)), np.empty((0, 4)), 0.0)
