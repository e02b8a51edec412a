"""The closest vehicle behind the ego, which it would slow by driving slowly itself."""

import numpy as np

from giveway.geometry.kernel import Array, kernel
from giveway.geometry.path import project, segment_at

_SAME_WAY = 0.7  # cosine of the angle to the ego's path, above which a vehicle drives the same way
_IN_LANE = 1.6  # lateral distance [m] from the path within which a vehicle is in the ego's lane


@kernel
def gap_behind(
    path: tuple[Array, Array, Array], vehicles: Array, own: int, rear: float, sight: float
) -> float:
    """The distance [m] from the ego's rear to the closest vehicle behind; inf if none is in sight.

    Args:
        path: Vertices, stations and headings of the ego's path, which begins straight.
        vehicles: Poses (m, 7) of all vehicles now.
        own: Row of the ego.
        rear: Station [m] of the ego's rear bumper.
        sight: Largest distance [m] that counts.
    """
    vertices, stations, headings = path
    closest = np.inf
    for j in range(vehicles.shape[0]):
        if j == own:
            continue
        x, y, heading, nose = vehicles[j, 0], vehicles[j, 1], vehicles[j, 2], vehicles[j, 4]
        x, y = x + nose * np.cos(heading), y + nose * np.sin(heading)
        station, lateral = project(vertices, stations, x, y)
        gap = rear - station
        if not 0.0 <= gap <= min(sight, closest) or abs(lateral) > _IN_LANE:
            continue
        if np.cos(heading - headings[segment_at(stations, station)]) > _SAME_WAY:
            closest = gap
    return closest
