"""The instants of a drive that a picture shows: its events, and others evenly between them."""

from collections import Counter

import numpy as np
from numpy.typing import NDArray

from giveway.figures.state import WAITS
from giveway.geometry.bodies import VehicleShape
from giveway.run_data.tracks import CrowdTrack, EgoTrack

SNAPSHOTS = 6
ENCOUNTER = 10.0  # Distance [m] to a pedestrian below which a drive is an encounter
_STOPS = 3  # Largest number of stops, the longest ones
_STANDS = 0.1  # Speed [m/s] below which the ego stands
_APART = 1.0  # Time [s] between two events


def telling_instants(ego: EgoTrack, crowd: CrowdTrack, closest: int | None) -> dict[int, str]:
    """Return six instants in their order, each with its event or an empty text.

    They are the closest approach, the beginnings of the longest stops, and instants that fill the
    encounter evenly; the whole run if no pedestrian came close.

    Args:
        ego: Track of the ego.
        crowd: Track of the crowd.
        closest: Instant of the closest approach, or None without people.
    """
    apart = np.hypot(crowd.x - ego.front_x[crowd.step], crowd.y - ego.front_y[crowd.step])
    close = crowd.step[apart < ENCOUNTER]
    found = {closest: "closest approach"} if close.size and closest is not None else {}
    for begin, words in _stops(ego):
        if all(abs(ego.time[begin] - ego.time[other]) >= _APART for other in found):
            found[begin] = words
    first, last = (close[0], close[-1]) if close.size else (0, ego.time.size - 1)
    evenly = np.linspace(first, last, min(SNAPSHOTS, int(last - first) + 1)).round()
    others = [int(k) for k in evenly]
    for event in found:  # takes the place of the nearest one
        if others:
            others.remove(min(others, key=lambda k: abs(k - event)))
    found |= {k: "" for k in others if k not in found}
    return {k: found[k] for k in sorted(found)}


def _stops(ego: EgoTrack) -> list[tuple[int, str]]:
    """Return the beginnings of the longest stops, and their causes in words."""
    stands = np.concatenate([[False], ego.speed < _STANDS, [False]])
    begins = np.flatnonzero(stands[1:] & ~stands[:-1])
    ends = np.flatnonzero(stands[:-1] & ~stands[1:])
    longest = np.argsort(begins - ends, kind="stable")[:_STOPS]
    return [(int(begins[k]), _cause(ego, int(begins[k]), int(ends[k]))) for k in longest]


def _cause(ego: EgoTrack, begin: int, end: int) -> str:
    """Return the most frequent cause of a stop in words."""
    causes = Counter(cause for cause in ego.waits_for[begin:end] if cause in WAITS)
    return WAITS[causes.most_common(1)[0][0]][1] if causes else "stands"


def closest_approach(ego: EgoTrack, crowd: CrowdTrack, shape: VehicleShape) -> int | None:
    """Return the first instant of the smallest distance to a pedestrian, or None without people.

    If a person is inside the rectangle, the distance is negative.
    """
    if not crowd.x.size:
        return None
    step = crowd.step
    cos, sin = np.cos(ego.heading[step]), np.sin(ego.heading[step])
    x, y = crowd.x - ego.front_x[step], crowd.y - ego.front_y[step]
    along = np.abs(x * cos + y * sin + shape.length / 2) - shape.length / 2
    aside = np.abs(y * cos - x * sin) - shape.width / 2
    beyond = np.hypot(np.maximum(along, 0.0), np.maximum(aside, 0.0))
    return int(step[np.argmin(beyond + np.minimum(np.maximum(along, aside), 0.0))])


def nearest_instants(ego: EgoTrack, times: NDArray[np.float64]) -> dict[int, str]:
    """Return the instants nearest to times [s], each once and without an event."""
    return {int(np.abs(ego.time - time).argmin()): "" for time in times}
