"""The passage of a path close to a point."""

import numpy as np

from giveway.geometry.kernel import Array, inner, kernel
from giveway.geometry.path import segment_at

SIGHT = 100.0
"""Sight distance [m] along the path; persons and things farther ahead are out of sight."""

BEHIND = 10.0
"""Distance [m] behind the front bumper from which on pedestrians and vehicles are considered."""


@inner
def look(
    vertices: Array,
    stations: Array,
    part: tuple[int, int],
    point: tuple[float, float],
    front: float,
    half_width: float,
    reach: float,
) -> tuple[float, bool]:
    """Return the station at which a path passes a point ahead, and whether it may get there.

    Args:
        vertices: Points (k + 1, 2) [m] of the path.
        stations: Stations (k + 1,) [m] of its vertices.
        part: First and last segment that count.
        point: Coordinates x, y of the point [m].
        front: Station [m] of the ego's front.
        half_width: Half width of the corridor along the path [m].
        reach: Distance [m] that the point could move.

    Returns:
        The station [m] of the closest passage within the corridor, or inf without one, and whether
        the point, moved by ``reach``, could be within the corridor.
    """
    (first, last), (x, y) = part, point
    end = len(vertices) - 2
    closest = np.inf
    reachable = False
    beyond_before = False  # True if (x, y) is beyond the end of the segment before
    for i in range(first, last + 1):
        # Each segment counts separately: a path that crosses itself or turns back passes the same
        # place twice, and only the passage ahead matters.
        # place twice, and only the passage ahead matters.
        x_0, y_0 = vertices[i, 0], vertices[i, 1]
        length = stations[i + 1] - stations[i]
        e_x, e_y = (vertices[i + 1, 0] - x_0) / length, (vertices[i + 1, 1] - y_0) / length
        along = (x - x_0) * e_x + (y - y_0) * e_y
        at_corner = along < 0.0 and i > 0 and beyond_before
        beside = (along >= 0.0 or i == 0) and (along <= length or i == end)
        beyond_before = along > length
        if not (beside or at_corner):
            continue
        if at_corner:
            along = 0.0
        d_x, d_y = x - (x_0 + along * e_x), y - (y_0 + along * e_y)
        distance = np.sqrt(d_x * d_x + d_y * d_y)
        station = stations[i] + along
        if distance <= half_width + reach and not (end == 0 and station + reach < front):
            reachable = True
        if front < station < closest and distance <= half_width:
            closest = station
    return closest, reachable


@kernel
def window(stations: Array, front: float, behind: float) -> tuple[int, int]:
    """Return the first and last segment of the path within sight, from ``behind`` [m] on."""
    return segment_at(stations, front - behind), segment_at(stations, front + SIGHT)
