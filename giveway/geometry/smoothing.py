"""A smooth path: as a car would drive it, not as a polyline is drawn.

A driver rounds a corner of the polyline: first outwards, then inwards, with as little bending as
the room allows. The smooth path minimises the integral of the squared curvature, plus the squared
distance to the polyline over the fourth power of a length, with a bound on the distance. Both are
quadratic in the coordinates. The bound is held by weights that grow where it is exceeded, and at
the solution each weight is its bound's multiplier.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from giveway.geometry.kernel import Array, inner, kernel
from giveway.geometry.path import EgoPath

_SPACING = 1.0  # Distance [m] between the points of a smooth part
_ROUNDING = 20.0  # Length [m] over which a corner is rounded where there is room for it
_ROUNDS = 100  # Number of adaptations of the weights
_FIXED = 1e6  # Weight of the two points at each end of a part, which stay where they are
_ENDS = [0, 1, -2, -1]  # Indices of these points
_FEWEST = 6  # Number of points below which a part stays as it is


Room = Callable[[Array], tuple[Array, Array]]


class SmoothPath(NamedTuple):
    """A smooth path, and where it has the stations of the polyline."""

    path: EgoPath
    before: Array  # (k,) [m] stations of the polyline, ascending
    after: Array  # (k,) [m] the same places as stations of the smooth path

    def station(self, station: float) -> float:
        """Return the station [m] on the smooth path of a ``station`` [m] on the polyline."""
        known = min(max(station, self.before[0]), self.before[-1])  # straight on beyond the ends
        return float(np.interp(known, self.before, self.after) + (station - known))


def smooth(path: EgoPath, parts: Sequence[tuple[float, float]], room: Room) -> SmoothPath:
    """Return the path with smooth ``parts``, between which it stays as it is.

    Args:
        path: Polyline.
        parts: Begin and end [m] of each part, in order, apart from each other.
        room: Function that returns, for stations (n,) [m], the centres (n, 2) [m] and the radii
            (n,) [m] of the circles in which the smooth path has to pass.
    """
    vertices, before, after = [], [], []
    driven, done = 0.0, 0.0  # stations up to which all is known, on the new path and the old one
    for begin, end in parts:
        count = round((end - begin) / _SPACING) + 1
        if count < _FEWEST:
            continue
        stations = np.linspace(begin, end, count)
        drawn = path.points(stations)
        centres, radii = room(stations)
        centres[_ENDS] = drawn[_ENDS]
        points = np.empty_like(drawn)
        _relax(points, centres, radii, _SPACING / _ROUNDING)
        kept = (path.stations >= done) & (path.stations < begin)
        vertices += [path.vertices[kept], points]
        before += [path.stations[kept], stations]
        after.append(path.stations[kept] - done + driven)
        along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
        ways = np.gradient(points, axis=0)
        ways /= np.hypot(*ways.T)[:, None]
        slips = np.sum((drawn - points) * ways, axis=1)
        after.append(begin - done + driven + np.maximum.accumulate(along + slips))
        driven, done = begin - done + driven + along[-1], np.nextafter(end, np.inf)
    kept = path.stations >= done
    vertices.append(path.vertices[kept])
    before.append(path.stations[kept])
    after.append(path.stations[kept] - done + driven)
    smoothed = EgoPath.through(np.concatenate(vertices))
    return SmoothPath(smoothed, np.concatenate(before), np.concatenate(after))


@kernel
def _relax(points: Array, centres: Array, radii: Array, stiffness: float) -> None:
    """Fill ``points`` (n, 2) [m] with the line that bends least, n >= 6.

    Args:
        points: Array to be filled.
        centres: Points (n, 2) [m] to which those of the line are near.
        radii: Largest distance (n,) [m] of each point.
        stiffness: Spacing of the points over the length along which a corner is rounded.
    """
    n = len(points)
    free = stiffness**4
    weights = np.full(n, free)
    for i in (0, 1, n - 2, n - 1):
        weights[i] = _FIXED
    for _ in range(_ROUNDS):
        _solve(weights, centres, points)
        for i in range(2, n - 2):
            off = np.hypot(points[i, 0] - centres[i, 0], points[i, 1] - centres[i, 1])
            weights[i] = max(free, weights[i] * (off / radii[i]) ** 2)
    for i in (0, 1, n - 2, n - 1):
        points[i] = centres[i]


@inner
def _solve(weights: Array, centres: Array, points: Array) -> None:
    """Solve (D'D + W) points = W centres, with the second differences D, by Cholesky's method."""
    n = len(weights)
    diagonal, first, second = np.empty(n), np.zeros(n), np.zeros(n)  # of the factor L
    for i in range(n):
        near_end = min(i, n - 1 - i)
        own = 1.0 if near_end == 0 else 5.0 if near_end == 1 else 6.0
        beside = 0.0 if i == 0 else -2.0 if i in (1, n - 1) else -4.0
        if i > 1:
            second[i] = 1.0 / diagonal[i - 2]
            beside -= second[i] * first[i - 1]
        if i > 0:
            first[i] = beside / diagonal[i - 1]
        diagonal[i] = np.sqrt(own + weights[i] - first[i] ** 2 - second[i] ** 2)
        for k in range(2):
            value = weights[i] * centres[i, k]
            if i > 0:
                value -= first[i] * points[i - 1, k]
            if i > 1:
                value -= second[i] * points[i - 2, k]
            points[i, k] = value / diagonal[i]
    for i in range(n - 1, -1, -1):
        for k in range(2):
            value = points[i, k]
            if i < n - 1:
                value -= first[i + 1] * points[i + 1, k]
            if i < n - 2:
                value -= second[i + 2] * points[i + 2, k]
            points[i, k] = value / diagonal[i]
