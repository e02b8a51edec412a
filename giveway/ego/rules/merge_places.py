"""Where the way of an ego and those of other vehicles become one, and what is known there."""

import itertools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath
from giveway.sumo.network.shared_lanes import Merging

SIGHT = 80.0  # distance [m] before the place, from which on the ego looks for others
_SAMPLE = 0.5  # [m] between the points of the path that are looked at
_OTHERS = 1.25  # [m] half the width of those who come along the other lane, trucks included
_BESIDE = 0.2  # [m] between two vehicles on different lanes at least


class Rival(NamedTuple):
    """A vehicle that is going to share a lane with the ego."""

    position: float  # [m] of its front bumper along the shared lane; negative: before it begins
    speed: float  # [m/s]
    length: float  # [m]


class Place(NamedTuple):
    """Where the ego's way and others become one."""

    lane: str  # that is shared
    over: frozenset[str]  # lanes right before it that the others come over; empty: any
    origin: float  # [m] station at which that lane begins
    entry: float  # [m] the front bumper's station from which on the ego is in their way
    end: float  # [m] and from which on it is on their lane


class Behind(NamedTuple):
    """What a vehicle that keeps behind the ego has to heed."""

    speed: float  # [m/s] at which the room moves on
    room: float  # [m] that it may still come closer to the ego; negative: it is too close
    to_wait: float  # [m] to where it is not in the ego's way yet
    braking: float  # [m/s^2] at most; inf: the ego is in its way already


def places_of(
    path: EgoPath, half_width: float, mergings: Sequence[Merging], departure: float
) -> tuple[Place, ...]:
    """Where an ego comes into the way of others.

    Args:
        path: of the ego.
        half_width: of its body [m].
        mergings: along its route.
        departure: station [m] at which it enters.
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
        if merging.over:  # the ways meet at its end
            first = clear[-1] + 1 if len(clear) else 0
            entry = float(stations[min(first, len(stations) - 1)])
            end = last
        else:
            entry = float(stations[np.argmax(near < apart)])
            end = float(stations[np.argmax(near <= near.min() + _BESIDE)])
        places.append(Place(merging.lane, merging.over, merging.origin, entry, end))
    return tuple(sorted(places, key=lambda place: place.entry))


def _distances(points: Array, lines: Sequence[Array]) -> Array:
    """(n,) [m] of ``points`` (n, 2) [m] to the closest of polylines."""
    x, y = points.T
    nearest = np.full(len(x), np.inf)
    for line in lines:
        for (x_0, y_0), (x_1, y_1) in itertools.pairwise(line):
            d_x, d_y = x_1 - x_0, y_1 - y_0
            squared = max(d_x * d_x + d_y * d_y, 1e-12)
            share = np.clip(((x - x_0) * d_x + (y - y_0) * d_y) / squared, 0.0, 1.0)
            nearest = np.minimum(nearest, np.hypot(x - x_0 - share * d_x, y - y_0 - share * d_y))
    return nearest
