"""The rectangular part of the plane that a picture shows."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

# Largest ratio of height to width of the overview; that of width to height is twice as large
SLENDEREST = 2.2

# Corners of a vehicle's nose, as parts of its length and width
NOSE = np.array([(0.9, 0.5), (0.6, 0.85), (0.6, 0.15)])


def nose_of(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the triangle (3, 2) [m] in a vehicle's outline that points forwards.

    Args:
        corners: Corners (4, 2) [m] of the vehicle, front left first, counter-clockwise.
    """
    _, rear_left, rear_right, front_right = corners
    along, across = front_right - rear_right, rear_left - rear_right
    return np.asarray(rear_right + NOSE[:, :1] * along + NOSE[:, 1:] * across)


class Box(NamedTuple):
    """The limits of a view [m]."""

    left: float
    bottom: float
    right: float
    top: float

    @classmethod
    def around(cls, points: NDArray[np.float64], margin: float) -> Box:
        """Return the box of the points (n, 2) [m] with a margin [m] around them."""
        left, bottom = points.min(axis=0) - margin
        right, top = points.max(axis=0) + margin
        return cls(float(left), float(bottom), float(right), float(top))

    @classmethod
    def centred(cls, middle: NDArray[np.float64], size: tuple[float, float]) -> Box:
        """Return a box of a width and height [m] around a point (2,) [m]."""
        half = np.array(size) / 2.0
        return cls(*(middle - half).tolist(), *(middle + half).tolist())

    def less_slender(self) -> Box:
        """Return the same view, widened if it is too slender for its place in the picture."""
        width, height = self.right - self.left, self.top - self.bottom
        more_x = max(0.0, height / SLENDEREST - width) / 2.0
        more_y = max(0.0, width / (2.0 * SLENDEREST) - height) / 2.0
        return Box(self.left - more_x, self.bottom - more_y, self.right + more_x, self.top + more_y)

    @property
    def size(self) -> tuple[float, float]:
        """The width and height [m]."""
        return self.right - self.left, self.top - self.bottom

    @property
    def aspect(self) -> float:
        """The ratio of height to width."""
        return (self.top - self.bottom) / (self.right - self.left)

    def touches(self, points: NDArray[np.float64]) -> bool:
        """Return whether the bounding box of the points meets this box."""
        low, high = points.min(axis=0), points.max(axis=0)
        apart = high[0] < self.left or low[0] > self.right
        return bool(not (apart or high[1] < self.bottom or low[1] > self.top))

    def apply(self, axes: Axes) -> None:
        """Show this view in ``axes``, to scale."""
        axes.set(xlim=(self.left, self.right), ylim=(self.bottom, self.top), aspect="equal")
