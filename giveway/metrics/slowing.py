"""Whether people ever slowed an ego: its speed against what it drives there with nobody about."""

import math

import numpy as np
from numpy.typing import NDArray

from giveway.run_data.tracks import EgoTrack

SLOWED = 0.8
"""Of the free speed: an ego below it is slowed."""
SLOWING = 0.95
"""Of the free speed: an ego that gets below it, and then is slowed, begins to slow there."""
_RISE = 0.5  # [m/s^2] with which the free speed rises from the start, or from where it was held up
_HELD = 30.0  # [m] nearer to a stop or a vehicle in front, these may hold it up, whoever walks
_STANDING = 0.1  # [m/s] a free speed below it says nothing


def slowed(ego: EgoTrack, reference: float | None) -> bool:
    """Whether the ego was, at any instant, below 0.8 times its speed with nobody about.

    The free speed rises with 0.5 m/s^2 from the start up to the reference speed of the place. A
    stop (a red light) or a vehicle less than 30 m in front may slow an ego that is alone, too: such
    instants do not count, and the free speed rises anew from the ego's after them.

    Args:
        ego: its track.
        reference: v_r [m/s]; None where the lanes say how fast: then what the controller aimed
            at while nobody was in front, interpolated over the way.
    """
    return _first_slowed(ego, free_speed(ego, reference)) is not None


def slowing_begins(ego: EgoTrack, reference: float | None) -> int | None:
    """The instant at which an ego that is ever :func:`slowed` begins to slow; None: it never is.

    The last instant before it is, for the first time, at which it was not below 0.95 times its
    speed with nobody about; if it was always below, since the start or since it was held up, the
    first one of these.

    Args:
        ego: its track.
        reference: as :func:`slowed` takes it.
    """
    free = free_speed(ego, reference)
    at = _first_slowed(ego, free)
    if at is None:
        return None
    for k in range(at - 1, -1, -1):
        if np.isnan(free[k]):
            return k + 1
        if ego.speed[k] >= SLOWING * free[k]:
            return k
    return 0


def free_speed(ego: EgoTrack, reference: float | None) -> NDArray[np.float64]:
    """(T,) [m/s] what the ego drives with nobody about; nan where a stop or a vehicle is near."""
    held = (ego.vehicle_gap < _HELD) | (ego.stop_gap < _HELD)
    way = np.diff(ego.position, prepend=ego.position[0])
    columns = held, ego.speed, way, _reference(ego, reference)
    square, free = float(ego.speed[0]) ** 2, []
    for stops, speed, driven, top in zip(*(column.tolist() for column in columns), strict=True):
        rising = square + 2.0 * _RISE * max(driven, 0.0)
        square = speed**2 if stops else min(rising, top**2)
        free.append(math.nan if stops else math.sqrt(square))
    return np.array(free)


def _first_slowed(ego: EgoTrack, free: NDArray[np.float64]) -> int | None:
    """The first instant at which the ego is slowed."""
    slow = np.flatnonzero((free > _STANDING) & (ego.speed < SLOWED * free))
    return int(slow[0]) if slow.size else None


def _reference(ego: EgoTrack, reference: float | None) -> NDArray[np.float64]:
    """(T,) [m/s] the speed to aim at where the ego is at each instant."""
    if reference is not None:
        return np.full(len(ego.time), reference)
    free = np.isinf(ego.gap) & np.isfinite(ego.reference_speed)
    free &= (ego.vehicle_gap >= _HELD) & (ego.stop_gap >= _HELD)
    if not free.any():
        return np.zeros(len(ego.time))  # it says nothing
    places = np.maximum.accumulate(ego.position)
    return np.asarray(np.interp(places, places[free], ego.reference_speed[free]), dtype=np.float64)
