"""The people who come onto the ego's way beyond the horizon, with time and place."""

import numpy as np

from giveway.geometry.kernel import Array, inlined, kernel
from giveway.geometry.path import segment_at

_REACH = 60.0  # [m] of the way beyond the horizon on which people matter
_ABREAST = 1e-3  # [m/s] across the way below which somebody goes along it


@kernel
def fill_crossers(
    vertices: Array,
    stations: Array,
    front: float,
    half_width: float,
    people: Array,
    crossers: Array,
) -> None:
    """Fill ``crossers`` as in :class:`controller.Prospect`: straight on at the velocity wished for.

    Where the way bends, each walks past the part that is nearest, as if it went on straight.

    Args:
        vertices: Vertices of the path.
        stations: [m] of these.
        front: the front bumper's station [m] at the horizon's end.
        half_width: Half width of the corridor [m].
        people: (n, 5) position [m], velocity [m/s], and for how long it is kept [s]; at the
            horizon's end.
        crossers: (n, 4).
    """
    first, last = segment_at(stations, front), segment_at(stations, front + _REACH)
    for p in range(people.shape[0]):
        x, y, w_x, w_y, until = people[p]
        station, lateral, e_x, e_y = abreast(vertices, stations, first, last, x, y)
        along, across = w_x * e_x + w_y * e_y, w_y * e_x - w_x * e_y
        enters, leaves = 0.0, until
        if abs(across) > _ABREAST:
            one, other = (half_width - lateral) / across, (-half_width - lateral) / across
            enters, leaves = max(0.0, min(one, other)), min(max(one, other), until)
        elif abs(lateral) > half_width:
            leaves = 0.0
        crossers[p, 0], crossers[p, 1] = station - front, along
        crossers[p, 2], crossers[p, 3] = enters, leaves if enters < leaves else 0.0


@inlined
def abreast(
    vertices: Array, stations: Array, first: int, last: int, x: float, y: float
) -> tuple[float, float, float, float]:
    """Somebody beside the nearest of the segments ``first`` ... ``last``, or ahead of them.

    The station [m], how far to the left of the way [m], and the direction of the segment.
    """
    closest, station, lateral, along_x, along_y = np.inf, 0.0, 0.0, 0.0, 0.0
    for i in range(first, last + 1):
        x_0, y_0 = vertices[i, 0], vertices[i, 1]
        length = stations[i + 1] - stations[i]
        e_x, e_y = (vertices[i + 1, 0] - x_0) / length, (vertices[i + 1, 1] - y_0) / length
        ahead = (x - x_0) * e_x + (y - y_0) * e_y
        beside = (y - y_0) * e_x - (x - x_0) * e_y
        beyond = 0.0
        if ahead < 0.0 and i > first:
            beyond = ahead
        elif ahead > length and i < last:
            beyond = ahead - length
        distance = beside * beside + beyond * beyond
        if distance < closest:
            closest, station, lateral = distance, stations[i] + ahead, beside
            along_x, along_y = e_x, e_y
    return station, lateral, along_x, along_y
