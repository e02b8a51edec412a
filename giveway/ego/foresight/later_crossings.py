"""The later crossings: people who cross the ego's path beyond the prediction horizon."""

import numpy as np

from giveway.geometry.kernel import Array, inlined, kernel
from giveway.geometry.path import segment_at

_REACH = 60.0  # length [m] of the path beyond the horizon on which people matter
_ABREAST = 1e-3  # speed [m/s] across the path, below which a person walks along it


@kernel
def fill_later_crossings(
    vertices: Array,
    stations: Array,
    front: float,
    half_width: float,
    people: Array,
    later_crossings: Array,
) -> None:
    """Fill ``later_crossings`` as in :class:`controller.Evaluation`.

    People walk straight on at their desired velocities. The segment of the path that is nearest to
    a person counts, as a straight line.

    Args:
        vertices: Vertices of the path.
        stations: Stations [m] of the vertices.
        front: Station of the front bumper [m] at the end of the horizon.
        half_width: Half width of the corridor [m].
        people: Position [m], desired velocity [m/s] and the time [s] for which it is kept, (n, 5),
            at the end of the horizon.
        later_crossings: Later crossings (n, 4), filled.
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
        later_crossings[p, 0], later_crossings[p, 1] = station - front, along
        later_crossings[p, 2], later_crossings[p, 3] = enters, leaves if enters < leaves else 0.0


@inlined
def abreast(
    vertices: Array, stations: Array, first: int, last: int, x: float, y: float
) -> tuple[float, float, float, float]:
    """Find the segment nearest to (x, y) [m] among the segments ``first`` ... ``last``.

    Returns:
        The station [m] and the lateral offset [m] of the point, and the segment's unit vector.
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
