"""The predictor ``drift`` in windows of recordings."""

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.kernel import Array
from giveway.validation.protocol import Window
from pedestrian_model.drift.features import FEATURES, fill_features, steps_back
from pedestrian_model.drift.forest import fill_corrections
from pedestrian_model.drift.motion import fill_positions
from pedestrian_model.drift.trained import Fit


def numbers_of(window: Window, time_step: float) -> tuple[Array, Array]:
    """Return the headings (n, 2) of the people of a window, and their numbers (n, FEATURES)."""
    past = window.past
    n = past.shape[1]
    unseen = np.isnan(past[:, :, 0])
    known = np.where(unseen.any(axis=0), unseen.argmax(axis=0), len(past)) - 1
    everybody: NDArray[np.int64] = np.arange(n)
    heading, numbers = np.empty((n, 2)), np.empty((n, FEATURES))
    out = everybody, heading, numbers
    fill_features(past, 0, everybody, known, steps_back(time_step), time_step, out)
    return heading, numbers


class DriftTracks:
    """Constant velocity with the trained corrections.

    Args:
        fit: Fit of the trees.
        time_step: Time [s] from frame to frame.
        frames: Number H of frames of a window.
    """

    def __init__(self, fit: Fit, time_step: float, frames: int) -> None:
        self._trees, self._time_step, self._frames = fit.trees, time_step, frames

    def __call__(self, window: Window) -> Array:
        """Return the positions (H, n, 2) [m] at 1 ... H frames ahead."""
        heading, numbers = numbers_of(window, self._time_step)
        n = len(heading)
        corrections, out = np.empty((n, 3, 2)), np.empty((self._frames, n, 2))
        fill_corrections(self._trees, heading, numbers, corrections)
        fill_positions(window.position, window.velocity, heading, corrections, self._time_step, out)
        return out
