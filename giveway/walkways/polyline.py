"""Centre lines: stations along them, and the gates of a route that follows them."""

import bisect
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from giveway.walkways.gates import BODY_RADIUS, Array

_STRAIGHT = 0.05  # Distance [m] from its neighbours' line up to which a vertex is no bend
_SHARPEST = 0.5  # Cosine of half the sharpest bend at which a walkway keeps its full width


def usable_half_width(width: float) -> float:
    """Return the largest distance [m] of a body's centre from the middle of a walkway."""
    return max(0.0, width / 2 - BODY_RADIUS)


@dataclass(frozen=True)
class Polyline:
    """A centre line in the direction of its lane.

    Attributes:
        points: Points (k, 2) [m], k >= 2.
        stations: Arc length [m] at each point, from 0.
    """

    points: Array
    stations: list[float]

    @classmethod
    def through(cls, points: Array) -> Self:
        """Return the polyline through ``points`` (k, 2) [m], without nearly straight vertices."""
        kept = points[_bends(points)]
        return cls(kept, [0.0, *np.cumsum(np.hypot(*np.diff(kept, axis=0).T)).tolist()])

    @property
    def length(self) -> float:
        """The arc length [m]."""
        return self.stations[-1]

    @cached_property
    def directions(self) -> Array:
        """The unit direction (k - 1, 2) of each segment."""
        steps = np.diff(self.points, axis=0)
        lengths: Array = np.hypot(*steps.T)
        return np.asarray(steps / np.maximum(lengths, 1e-12)[:, None])

    @cached_property
    def _segments(self) -> list[tuple[float, float, float, float, float]]:
        return [
            (*start, *direction, self.stations[i + 1] - self.stations[i])
            for i, (start, direction) in enumerate(
                zip(self.points.tolist(), self.directions.tolist(), strict=False)
            )
        ]

    def project(self, x: float, y: float) -> tuple[float, float]:
        """Return the nearest station [m] to a point, and the point's distance to the left [m]."""
        best = math.inf, 0.0, 0.0
        for i, (x_0, y_0, d_x, d_y, length) in enumerate(self._segments):
            along = (x - x_0) * d_x + (y - y_0) * d_y
            left = (y - y_0) * d_x - (x - x_0) * d_y
            clipped = min(max(along, 0.0), length)
            distance = math.hypot(along - clipped, left)
            if distance < best[0]:
                best = distance, self.stations[i] + clipped, left
        return best[1], best[2]

    def gates(self, half_width: float) -> Array:
        """Return a gate (k, 7) across every vertex and end, ``half_width`` [m] to both sides.

        In a bend the gate lies on the bisector and is longer there, so that people keep their
        distance to the centre line.
        """
        along = self.directions
        before, after = np.vstack([along[:1], along]), np.vstack([along, along[-1:]])
        middle = before + after
        size = np.hypot(*middle.T)
        # A hairpin bend has no bisector: the gate lies across the direction after it.
        middle = np.where(size[:, None] > 1e-6, middle / np.maximum(size, 1e-6)[:, None], after)
        half_angle = np.maximum((middle * after).sum(axis=1), _SHARPEST)
        spread = np.column_stack([-middle[:, 1], middle[:, 0]]) * (half_width / half_angle)[:, None]
        return np.column_stack([self.points, spread, middle, np.full(len(middle), -1.0)])

    def gate_at(self, station: float, half_width: float) -> Array:
        """Return a gate (1, 7) across the line at ``station`` [m]."""
        i = min(bisect.bisect_right(self.stations, station), len(self.stations) - 1) - 1
        x, y, d_x, d_y, _ = self._segments[i]
        along = station - self.stations[i]
        middle = x + along * d_x, y + along * d_y
        return np.array([[*middle, -d_y * half_width, d_x * half_width, d_x, d_y, -1.0]])


def _bends(points: Array) -> NDArray[np.int64]:
    """Return the indices of the ends and of the bends (Douglas and Peucker 1973)."""
    kept = {0, len(points) - 1}
    stack = [(0, len(points) - 1)]
    while stack:
        first, last = stack.pop()
        if last - first < 2:
            continue
        chord = points[last] - points[first]
        offset = points[first + 1 : last] - points[first]
        length = math.hypot(*chord)
        if length < 1e-9:
            away = np.hypot(*offset.T)
        else:
            away = np.abs(offset[:, 0] * chord[1] - offset[:, 1] * chord[0]) / length
        worst = int(np.argmax(away))
        if away[worst] > _STRAIGHT:
            middle = first + 1 + worst
            kept.add(middle)
            stack += [(first, middle), (middle, last)]
    return np.array(sorted(kept), dtype=np.int64)
