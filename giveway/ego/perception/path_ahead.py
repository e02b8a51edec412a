"""The path ahead of an ego's front bumper, as its controller may ask for it."""

from functools import cached_property

import numpy as np

from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath

HALF = 2.5
"""Half of the length [m] of path over which a curvature is averaged."""


class PathView:
    """The path ahead of the ego, a :class:`controller.PathAhead`.

    Args:
        path: Path of the ego.

    Attributes:
        station: Station of the front bumper [m], which the ego updates.
    """

    def __init__(self, path: EgoPath) -> None:
        self._path = path
        self.station = 0.0

    @cached_property
    def _turned(self) -> tuple[Array, Array]:
        """Stations [m], and the integral of the heading up to each [rad.m]."""
        headings = np.unwrap(self._path.headings)
        beyond = 3.0 * HALF  # length of the straight continuations
        at = np.concatenate([[-beyond], self._path.stations, [self._path.length + beyond]])
        steps = np.diff(at) * np.concatenate([headings[:1], headings, headings[-1:]])
        return at, np.concatenate([[0.0], np.cumsum(steps)])

    def remaining(self) -> float:
        """Return the length of path that is left [m]."""
        return max(0.0, self._path.length - self.station)

    def poses(self, distances: Array) -> Array:
        """The poses (k, 3), x, y [m] and heading [rad], at ``distances`` (k,) [m] ahead.

        The path goes on straight beyond its end.
        """
        path, at = self._path, self.station + distances
        segment = np.searchsorted(path.stations[1:-1], at, side="right")
        along, heading = at - path.stations[segment], path.headings[segment]
        x = path.vertices[segment, 0] + along * np.cos(heading)
        y = path.vertices[segment, 1] + along * np.sin(heading)
        return np.column_stack([x, y, heading])

    def curvature(self, distances: Array) -> Array:
        """Return the mean curvatures (k,) [1/m] over 5 m at ``distances`` (k,) [m] ahead.

        A polyline turns in its corners only. The mean headings of the 2.5 m before and behind a
        point are therefore compared.
        """
        at = np.clip(self.station + distances, -HALF, self._path.length + HALF)
        before, here, behind = (
            np.interp(at + shift, *self._turned) for shift in (-HALF, 0.0, HALF)
        )
        curvature: Array = (before - 2.0 * here + behind) / HALF**2
        return curvature
