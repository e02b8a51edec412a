"""Slowing for people: an ego's speed compared with its free speed."""

import math

import numpy as np
from numpy.typing import NDArray

from giveway.run_data.tracks import EgoTrack

SLOWED = 0.8
"""Share of the free speed below which an ego is slowed."""
SLOWING = 0.95
"""Share of the free speed at which an ego that will be slowed begins to slow."""
_RISE = 0.5  # Acceleration [m/s^2] of the free speed from the start, or from the place of a delay
_HELD = 30.0  # Distance [m] to a stop or a vehicle in front below which these may delay the ego
_STANDING = 0.1  # Free speed [m/s] below which nothing can be concluded


def slowed(ego: EgoTrack, reference: float | None) -> bool:
    """Return whether the ego was ever below 0.8 times its free speed.

    The free speed rises with 0.5 m/s^2 from the start up to the reference speed of the place. A
    stop (a red light) or a vehicle less than 30 m in front may slow an ego without people, too.
    Such instants do not count, and after them the free speed rises again from the ego's speed.

    Args:
        ego: Track of the ego.
        reference: Reference speed v_r [m/s], or None if the lanes' limits count. Then it is the
            speed that the controller aimed at while nobody was in front, interpolated over the
            path.
    """
    return _first_slowed(ego, free_speed(ego, reference)) is not None


def slowing_begins(ego: EgoTrack, reference: float | None) -> int | None:
    """Return the index of the control instant at which the ego starts to slow, or None.

    From the first instant at which :func:`slowed` holds, go back to the last one at which the speed
    was at least 0.95 of the free speed, or to the first instant after a stop or a leader held the
    ego up.

    Args:
        ego: Track of the ego.
        reference: Reference speed as for :func:`slowed`.
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
    """Return the free speed (T,) [m/s] of the ego; nan where a stop or a vehicle is near."""
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
    """Return the first instant at which the ego is slowed, or None."""
    slow = np.flatnonzero((free > _STANDING) & (ego.speed < SLOWED * free))
    return int(slow[0]) if slow.size else None


def _reference(ego: EgoTrack, reference: float | None) -> NDArray[np.float64]:
    """Return the reference speed (T,) [m/s] at the ego's place at each instant."""
    if reference is not None:
        return np.full(len(ego.time), reference)
    free = np.isinf(ego.gap) & np.isfinite(ego.reference_speed)
    free &= (ego.vehicle_gap >= _HELD) & (ego.stop_gap >= _HELD)
    if not free.any():
        return np.zeros(len(ego.time))  # nothing can be concluded
    places = np.maximum.accumulate(ego.position)
    return np.asarray(np.interp(places, places[free], ego.reference_speed[free]), dtype=np.float64)
