"""Sudden starts: people who leave a sidewalk faster than an ego's safety layer assumes."""

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.kernel import Array

_ROUNDING = 1e-6  # [m/s^2]

Numbers = NDArray[np.int64]


class SettingOut:
    """Compares people's velocities from step to step.

    Args:
        limit: Limit of their acceleration towards the kerb [m/s^2].
        time_step: [s].
    """

    def __init__(self, limit: float, time_step: float) -> None:
        self._most = (limit + _ROUNDING) * time_step
        self._who: Numbers = np.empty(0, dtype=np.int64)
        self._velocity = self._kerbs = np.empty((0, 2))

    def beyond(self, numbers: Numbers, velocity: Array, kerbs: Array) -> Numbers:
        """Return who was on a sidewalk a step ago and has accelerated harder since then.

        Args:
            numbers: (n,) one for each person that it keeps.
            velocity: (n, 2) [m/s].
            kerbs: (n, 3) see :meth:`giveway.ego.perception.kerbs.Kerbs.of`.
        """
        _, before, now = np.intersect1d(self._who, numbers, assume_unique=True, return_indices=True)
        more = ((velocity[now] - self._velocity[before]) * self._kerbs[before]).sum(axis=1)
        found: Numbers = numbers[now[more > self._most]]
        on = kerbs[:, 2] > 0.0
        self._who, self._velocity, self._kerbs = numbers[on], velocity[on], kerbs[on, :2]
        return found
