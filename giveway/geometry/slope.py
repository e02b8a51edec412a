"""The slope of a path whose network has heights."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from giveway.geometry.kernel import Array

_FLAT = 1e-6  # [m] largest difference of heights of a level path


@dataclass(frozen=True)
class Slope:
    """The heights along a path, interpolated linearly.

    Attributes:
        stations: Stations (k,) [m] along the path, which is laid out in the plane.
        heights: Heights (k,) [m] at the stations.
    """

    stations: Array
    heights: Array

    @classmethod
    def through(cls, points: Sequence[tuple[float, float]]) -> Slope | None:
        """Return the slope through stations and heights [m] in order, or None if it is level."""
        if not points:
            return None
        stations, heights = np.array(points, dtype=np.float64).T
        return None if np.ptp(heights) < _FLAT else cls(stations, heights)

    def grade(self, front: float, length: float) -> float:
        """Return the grade [rad] of a body from its rear to its front, uphill positive.

        Args:
            front: Station of its front [m].
            length: Length of the body [m]; its part beyond an end of the path does not count.
        """
        first, last = self.stations[0], self.stations[-1]
        rear = min(max(front - length, first), last)
        front = min(max(front, first), last)
        if front - rear < 1e-3:
            return 0.0
        low, high = np.interp((rear, front), self.stations, self.heights)
        return math.atan2(float(high - low), float(front - rear))

    @property
    def steepest(self) -> float:
        """Return the largest angle [rad] between two of its points a metre or more apart."""
        along, up = np.diff(self.stations), np.diff(self.heights)
        long = along >= 1.0
        return math.atan(float((np.abs(up[long]) / along[long]).max(initial=0.0)))
