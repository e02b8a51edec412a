"""The outputs of a vehicle FMU that are recorded besides its motion, as its profile lists them."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.run_data.columns import Column

ROAD_GRADE = (
    "road_grade",
    "rad",
    "angle at which the ego's body stands on the road, by the heights of the net; uphill positive",
)
"""Name, unit and meaning of the column for egos on roads with heights."""


class Output(NamedTuple):
    """One variable of an ego's FMU, at the ego's control instants."""

    name: str
    unit: str  # unit in the FMU; empty if it declares none
    description: str  # description in the FMU; empty if it declares none
    values: NDArray[np.float64]  # (T,) values

    @property
    def column(self) -> Column:
        """Return the column of ``ego.csv`` that holds the output."""
        described = self.description or "as the FMU gives it"
        return Column(self.name, "number", self.unit or None, described)
