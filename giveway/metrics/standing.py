"""The stops of an ego."""

import numpy as np
from numpy.typing import NDArray

from controller.driving_constants import STANDING
from giveway.run_data.tracks import EgoTrack


def stops(ego: EgoTrack, stop_speed: float = STANDING) -> NDArray[np.int64]:
    """Return the instants (n, 2) at which each stop begins and ends, in order of time.

    A stop lasts from the first instant below ``stop_speed`` [m/s] to the first one that is not, or
    to the end of the track, since each instant stands for the time until the next one.
    """
    standing = np.concatenate(([False], ego.speed < stop_speed, [False]))
    edges = np.diff(standing.astype(np.int8))
    begins, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    return np.column_stack([begins, np.minimum(ends, ego.time.size - 1)]).astype(np.int64)


def waiting_times(ego: EgoTrack, stop_speed: float = STANDING) -> NDArray[np.float64]:
    """Return the duration [s] of every stop, in order of time."""
    begins, ends = stops(ego, stop_speed).T
    return np.asarray(ego.time[ends] - ego.time[begins], dtype=np.float64)
