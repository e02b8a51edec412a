"""Finds sudden starts: people who leave a sidewalk faster than the safety layer assumes."""

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.kernel import Array

_ROUNDING = 1e-6  # tolerance [m/s^2]

Numbers = NDArray[np.int64]


class SuddenStarts:
    """Compares people's velocities from step to step.

    Args:
        limit: Largest assumed acceleration [m/s^2] of people towards the kerb.
        time_step: Control step [s].
    """

    def __init__(self, limit: float, time_step: float) -> None:
        self._most = (limit + _ROUNDING) * time_step
        self._who: Numbers = np.empty(0, dtype=np.int64)
        self._velocity = self._kerbs = np.empty((0, 2))

    def beyond(self, numbers: Numbers, velocity: Array, kerbs: Array) -> Numbers:
        """Return the ids of people on a sidewalk who accelerated harder than assumed in this step.

        Args:
            numbers: Person ids (n,).
            velocity: Velocities (n, 2) [m/s].
            kerbs: Kerbs (n, 3), as :meth:`giveway.ego.perception.kerbs.Kerbs.of` returns them.
        """
        _, before, now = np.intersect1d(self._who, numbers, assume_unique=True, return_indices=True)
        more = ((velocity[now] - self._velocity[before]) * self._kerbs[before]).sum(axis=1)
        found: Numbers = numbers[now[more > self._most]]
        on = kerbs[:, 2] > 0.0
        self._who, self._velocity, self._kerbs = numbers[on], velocity[on], kerbs[on, :2]
        return found
