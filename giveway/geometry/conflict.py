"""The conflict of two paths: where bodies on them would touch."""

from typing import NamedTuple

import numpy as np

from giveway.geometry.kernel import Array
from giveway.geometry.path import points_at, stations_of

_SAMPLE = 0.25  # Distance [m] between the compared points of the paths


class Conflict(NamedTuple):
    """The part of each path that no two bodies can be on at once; stations of their fronts [m]."""

    enter: float
    leave: float
    other_enter: float
    other_leave: float


def conflict(own: Array, other: Array, apart: float) -> Conflict | None:
    """Return the conflict of two paths, or None without one.

    Args:
        own: One path (k, 2) [m].
        other: Other path (m, 2) [m].
        apart: Distance [m] between the paths' middles from which on bodies on them do not touch.
    """
    along, points = _sampled(own)
    other_along, other_points = _sampled(other)
    away = points[:, None, :] - other_points[None, :, :]
    close = np.hypot(away[:, :, 0], away[:, :, 1]) < apart
    mine, others = np.flatnonzero(close.any(axis=1)), np.flatnonzero(close.any(axis=0))
    if not len(mine):
        return None
    return Conflict(
        float(along[mine[0]]),
        float(along[mine[-1]]),
        float(other_along[others[0]]),
        float(other_along[others[-1]]),
    )


def _sampled(points: Array) -> tuple[Array, Array]:
    """Return stations (n,) [m] along a polyline, and the points (n, 2) [m] there."""
    at = stations_of(points)
    stations = np.linspace(0.0, at[-1], max(2, int(np.ceil(at[-1] / _SAMPLE)) + 1))
    return stations, points_at(points, at, stations)
