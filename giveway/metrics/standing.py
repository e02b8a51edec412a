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
    found = np.array(runs(ego.speed < stop_speed), dtype=np.int64).reshape(-1, 2)
    return np.minimum(found, ego.time.size - 1)


def runs(mask: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return the stretches in which ``mask`` (n,) is true: first index, and one after the last."""
    edges = np.diff(np.concatenate([[0], mask.astype(np.int8), [0]]))
    begins, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    return list(zip(begins.tolist(), ends.tolist(), strict=True))


def waiting_times(ego: EgoTrack, stop_speed: float = STANDING) -> NDArray[np.float64]:
    """Return the duration [s] of every stop, in order of time."""
    begins, ends = stops(ego, stop_speed).T
    return np.asarray(ego.time[ends] - ego.time[begins], dtype=np.float64)
