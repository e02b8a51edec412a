"""Where the ego's front gets to: its poses along the path, as far as it needs to stop."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from giveway.geometry.kernel import kernel
from giveway.geometry.path import body_pose, segment_at

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from giveway.geometry.path import EgoPath

    Array = NDArray[np.float64]

_FINEST = 0.25  # [m] between poses: a chord of a bend of 5 m radius is 1.6 mm off
_MOST = 256  # poses


class WayAhead:
    """The poses of a body's front along a path; the array is handed out again and again.

    Args:
        path: of the front's middle, and of the rear's.
        length: of the body [m].
    """

    def __init__(self, path: EgoPath, length: float) -> None:
        self.path = path
        self.length = length
        self._way = np.zeros((_MOST, 4))

    def sample(self, front: float, reach: float) -> tuple[Array, float]:
        """The poses (k, 4) x, y [m], cos, sin from the station ``front`` on, and their spacing [m].

        Where the path is straight, from the rear bumper to ``reach`` [m] ahead of the front, one
        pose says everything.
        """
        spacing = max(_FINEST, reach / (_MOST - 2))
        path = self.path
        count = fill_way(
            path.vertices,
            path.stations,
            path.headings,
            front,
            self.length,
            reach,
            spacing,
            self._way,
        )
        return self._way[:count], spacing


@kernel
def fill_way(
    vertices: Array,
    stations: Array,
    headings: Array,
    front: float,
    length: float,
    reach: float,
    spacing: float,
    way: Array,
) -> int:
    """Fill ``way`` with x, y, cos, sin at front, front + spacing, ...; how many there are."""
    straight = segment_at(stations, front - length) == segment_at(stations, front + reach)
    count = 1 if straight else min(2 + int(reach / spacing), way.shape[0])
    for i in range(count):
        x, y, heading = body_pose(vertices, stations, headings, front + i * spacing, length)
        way[i, 0], way[i, 1] = x, y
        way[i, 2], way[i, 3] = np.cos(heading), np.sin(heading)
    return count
