"""An ego's path as its controller sees it: from the front bumper on, computed when asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from giveway.geometry.path import EgoPath

    Array = NDArray[np.float64]

_WINDOW = 5.0  # [m] over which the curvature of a polyline is taken: its corners are none of ours


class PathView:
    """A :class:`controller.PathAhead`.

    Args:
        path: the ego's.

    Attributes:
        station: of the front bumper [m]; the ego keeps it up to date.
    """

    def __init__(self, path: EgoPath) -> None:
        self._path = path
        self._middles = (path.stations[1:] + path.stations[:-1]) / 2.0
        self._turned = np.unwrap(path.headings)
        self.station = 0.0

    def remaining(self) -> float:
        """How much of the path is left [m]."""
        return max(0.0, self._path.length - self.station)

    def poses(self, distances: Array) -> Array:
        """(k, 3) x, y [m] and heading [rad] at ``distances`` (k,) [m] ahead; straight beyond it."""
        path, at = self._path, self.station + distances
        segment = np.searchsorted(path.stations[1:-1], at, side="right")
        along, heading = at - path.stations[segment], path.headings[segment]
        x = path.vertices[segment, 0] + along * np.cos(heading)
        y = path.vertices[segment, 1] + along * np.sin(heading)
        return np.column_stack([x, y, heading])

    def curvature(self, distances: Array) -> Array:
        """(k,) [1/m] at ``distances`` (k,) [m] ahead, the mean over 5 m; positive to the left."""
        at, half = self.station + distances, _WINDOW / 2.0
        turned = np.interp(at + half, self._middles, self._turned)
        curvature: Array = (turned - np.interp(at - half, self._middles, self._turned)) / _WINDOW
        return curvature
