"""The truth that sensors are shown: nothing but sensors, recorder and metrics may use it."""

from dataclasses import dataclass

import numpy as np

from giveway.geometry.kernel import Array
from pedestrian_model import Crowd


@dataclass(slots=True)
class Truth:
    """The world round the egos at one instant; the run refills one object in place.

    Attributes:
        people: Pedestrians within the zone, n of them.
        vehicles: Poses of all vehicles, (m, 7): x, y [m], heading [rad], speed [m/s], distances [m]
            from the reference point to the front and to the rear, width [m].
        outlines: Static outlines that may hide people, (k, 4): x0, y0, x1, y1 [m]; k may be 0.
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
