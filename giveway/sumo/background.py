"""SUMO's own vehicles at one instant."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class BackgroundVehicles:
    """SUMO's own vehicles at one instant; ``x``, ``y`` are front-bumper centres."""

    ids: tuple[str, ...]
    types: tuple[str, ...]
    x: NDArray[np.float64]  # (m,) [m] front-bumper centre
    y: NDArray[np.float64]  # (m,) [m] front-bumper centre
    heading: NDArray[np.float64]  # (m,) [rad] counter-clockwise from +x
    speed: NDArray[np.float64]  # (m,) [m/s]
    length: NDArray[np.float64]  # (m,) [m]
    width: NDArray[np.float64]  # (m,) [m]

    @property
    def numbers(self) -> tuple[NDArray[np.float64], ...]:
        """The columns of numbers: all except ids and types."""
        return self.x, self.y, self.heading, self.speed, self.length, self.width

    @property
    def bodies(self) -> NDArray[np.float64]:
        """The rectangles (m, 5) of the vehicles: x, y [m], heading [rad], length, width [m]."""
        return np.column_stack([self.x, self.y, self.heading, self.length, self.width])


NO_VEHICLES = BackgroundVehicles((), (), *(np.empty(0) for _ in range(6)))
