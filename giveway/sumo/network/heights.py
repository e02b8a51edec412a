"""The heights of lanes: SUMO gives a lane's shape as x, y, and z only at a place on it."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from giveway.geometry.kernel import Array
from giveway.geometry.path import stations_of


class Height(NamedTuple):
    """A point of the road's height profile along a lane path."""

    station: float  # [m] station along the lane path
    z: float  # [m] height


def heights_of(sumo: Any, lane: str, shape: Array, begin: float, length: float) -> Iterator[Height]:
    """Yield the heights at the vertices of a lane's centre line.

    SUMO measures places on a lane along the inclined line, but a path lies in the plane. Therefore
    the vertices are looked up twice, the second time by their distances in space.

    Args:
        sumo: The libsumo module.
        lane: SUMO's id of the lane.
        shape: Centre line (k, 2) [m] of the lane.
        begin: Station [m] on the path at which the lane begins.
        length: Length [m] of the lane on the path; it is more where the path changes lanes.
    """
    flat = stations_of(shape)
    if flat[-1] < 1e-6:  # a lane without length, as inside a small junction
        yield Height(begin, _z(sumo, lane, np.zeros(1))[0])
        return
    z = _z(sumo, lane, flat / flat[-1])
    inclined = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(flat), np.diff(z)))])
    z = _z(sumo, lane, inclined / inclined[-1])
    yield from map(Height, (begin + flat * (length / flat[-1])).tolist(), z.tolist())


def _z(sumo: Any, lane: str, shares: Array) -> Array:
    """Return the heights (k,) [m] at shares of a lane's length."""
    edge, _, index = lane.rpartition("_")
    nominal = float(sumo.lane.getLength(lane))
    at = (share * nominal for share in shares.tolist())
    return np.array([sumo.simulation.convert3D(edge, place, int(index))[2] for place in at])
