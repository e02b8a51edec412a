"""The merge points on an ego's path, and the vehicles that merge there."""

import itertools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath
from giveway.sumo.network.shared_lanes import Merging

SIGHT = 80.0  # sight distance [m] ahead of a merge point
_SAMPLE = 0.5  # spacing [m] of the sampled points of the path
_OTHERS = 1.25  # half width [m] of merging vehicles, trucks included
_BESIDE = 0.2  # least lateral gap [m] between two vehicles on different lanes


class MergingVehicle(NamedTuple):
    """A vehicle that is going to share a lane with the ego."""

    position: float  # station [m] of its front bumper on the shared lane; negative ahead of it
    speed: float  # speed [m/s]
    length: float  # length of its body [m]


class MergePoint(NamedTuple):
    """A merge point: a station at which the ego's path and others become one."""

    lane: str  # shared lane
    over: frozenset[str]  # lanes from which the others enter the shared lane; empty if any lane
    origin: float  # station [m] at which the shared lane begins
    entry: float  # station [m] of the front bumper from which on the ego obstructs the others
    end: float  # station [m] of the front bumper from which on the ego is on the shared lane


class FollowingConstraint(NamedTuple):
    """The following constraint of a vehicle that keeps behind the ego."""

    speed: float  # speed [m/s] at which the bound on its position moves
    room: float  # distance [m] from its position to the bound; negative if it is too close
    to_wait: float  # distance [m] to where it can wait without obstructing the ego
    braking: float  # largest deceleration [m/s^2]; inf once the ego obstructs it


def merge_points_of(
    path: EgoPath, half_width: float, mergings: Sequence[Merging], departure: float
) -> tuple[MergePoint, ...]:
    """The merge points on an ego's path.

    Args:
        path: Path of the ego.
        half_width: Half of the width of its body [m].
        mergings: Merging lanes along its route.
        departure: Station [m] at which the ego enters.
    """
    apart = half_width + _OTHERS + _BESIDE
    places = []
    for merging in mergings:
        last = min(merging.end, path.length)
        stations = np.arange(max(merging.begin, departure), last, _SAMPLE)
        if not len(stations):
            continue
        near = _distances(path.points(stations), merging.lines)
        if near.min() >= apart:
            continue
        clear = np.flatnonzero(near >= apart)
        if merging.over:  # the paths meet at the end of the stretch
            first = clear[-1] + 1 if len(clear) else 0
            entry = float(stations[min(first, len(stations) - 1)])
            end = last
        else:
            entry = float(stations[np.argmax(near < apart)])
            end = float(stations[np.argmax(near <= near.min() + _BESIDE)])
        places.append(MergePoint(merging.lane, merging.over, merging.origin, entry, end))
    return tuple(sorted(places, key=lambda place: place.entry))


def _distances(points: Array, lines: Sequence[Array]) -> Array:
    """The distances (n,) [m] of ``points`` (n, 2) [m] to the closest of several polylines."""
    x, y = points.T
    nearest = np.full(len(x), np.inf)
    for line in lines:
        for (x_0, y_0), (x_1, y_1) in itertools.pairwise(line):
            d_x, d_y = x_1 - x_0, y_1 - y_0
            squared = max(d_x * d_x + d_y * d_y, 1e-12)
            share = np.clip(((x - x_0) * d_x + (y - y_0) * d_y) / squared, 0.0, 1.0)
            nearest = np.minimum(nearest, np.hypot(x - x_0 - share * d_x, y - y_0 - share * d_y))
    return nearest
