"""The part of a crossing that no lane runs along.

netconvert lays the crossing of a roundabout's arm so close to the circulating lane that both kerbs
are on this lane. SUMO's vehicles pass along such a crossing over those who wait and those who
cross. People use the other side of the crossing there, as they do on the road, where it is a car's
length away from the circulating lane.
"""

from collections.abc import Iterable

import numpy as np

from giveway.walkways.gates import Array

_ROOM = 1.2  # distance [m] kept from a lane's middle: half of a car's width and 0.3 m; own choice
_LEAST = 0.8  # least width [m] that is left for people: a body of 0.54 m with some room; own choice


def part_beside(ends: Array, width: float, lanes: Iterable[Array]) -> tuple[Array, float]:
    """Return ends (2, 2) [m] and width [m] of the part of a crossing that no lane runs along.

    It is the whole crossing where its middle line is free, or where too little would be left.

    Args:
        ends: Middle (2, 2) [m] of each kerb.
        width: Width [m] of the crossing.
        lanes: Centre lines (k, 2) [m] of the vehicles' lanes in its junction.
    """
    way = ends[1] - ends[0]
    length = float(np.hypot(*way))
    along = way / max(length, 1e-9)
    left = np.array([-along[1], along[0]])
    taken = []
    for lane in lanes:
        u, w = (np.einsum("ij,j", lane - ends[0], axis) for axis in (along, left))
        if u[0] > u[-1]:
            u, w = u[::-1], w[::-1]
        if u[0] > 0.0 or u[-1] < length or (np.diff(u) <= 0.0).any():
            continue  # the lane crosses, or is elsewhere
        inside = (u > 0.0) & (u < length)
        beside = np.concatenate([np.interp([0.0, length], u, w), w[inside]])
        taken.append((float(beside.min()) - _ROOM, float(beside.max()) + _ROOM))
    if not any(first < 0.0 < last for first, last in taken):
        return ends, width
    lows, highs = zip(*sorted(taken), strict=True)
    edges = zip((-width / 2.0, *highs), (*lows, width / 2.0), strict=True)
    parts = [(max(low, -width / 2.0), min(high, width / 2.0)) for low, high in edges]
    low, high = max(parts, key=lambda part: part[1] - part[0])
    if high - low < _LEAST:
        return ends, width
    return ends + (low + high) / 2.0 * left, high - low
