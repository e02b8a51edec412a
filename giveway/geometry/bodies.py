"""The outlines of vehicles."""

from dataclasses import dataclass
from math import cos, sin

import numpy as np

from giveway.geometry.kernel import Array


@dataclass(frozen=True)
class VehicleShape:
    """A rectangle, placed by the centre of its front bumper and its heading."""

    length: float = 5.0  # [m]
    width: float = 2.0  # [m]

    def corners(self, front: Array, heading: float) -> Array:
        """Return the corners (4, 2) [m], front left first, counter-clockwise.

        Args:
            front: Middle (2,) [m] of the front.
            heading: Heading [rad].
        """
        c, s, half = cos(heading), sin(heading), self.width / 2.0
        local = np.array([(0.0, half), (-self.length, half), (-self.length, -half), (0.0, -half)])
        turned = np.einsum("ij,jk", local, np.array([[c, s], [-s, c]]))
        return np.asarray(turned + front, dtype=np.float64)


BODY = VehicleShape()
"""Body of an ego if neither the options nor SUMO give one (Yang & Özgüner 2019: 5 m by 2 m)."""
