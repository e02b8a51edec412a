"""Estimates the desired speeds of people from their perceived speeds.

Other people and the ego slow people down, but hardly anything makes them walk faster than they want
to. The estimate therefore rises quickly to a higher speed and falls slowly to a lower one. People
who stand or nearly stand do not change it.
"""

import math

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.kernel import Array
from pedestrian_model import Crowd

_FASTER, _SLOWER = 0.25, 5.0  # time constants [s] of the estimate's rise and fall
_WALKS = 0.5  # least speed [m/s] that lowers the estimate


class Pace:
    """Estimates the desired speed of each person that one ego perceives, by person id.

    Args:
        typical: Desired speed [m/s] that is assumed at first.
        time_step: Time [s] between two looks.
    """

    def __init__(self, typical: float, time_step: float) -> None:
        self._typical = typical
        self._up, self._down = (1.0 - math.exp(-time_step / t) for t in (_FASTER, _SLOWER))
        self._known = np.zeros(0)

    def learn(self, crowd: Crowd, numbers: NDArray[np.int64]) -> Array:
        """Update and return the estimated desired speeds (n,) [m/s].

        Args:
            crowd: Perceived people (n,); not changed.
            numbers: Person ids (n,).
        """
        most = int(numbers.max(initial=-1)) + 1
        if most > len(self._known):
            more = np.full(2 * most - len(self._known), self._typical)
            self._known = np.concatenate([self._known, more])
        wanted = self._known[numbers]
        beyond = np.hypot(crowd.velocity[:, 0], crowd.velocity[:, 1]) - wanted
        share = np.where(beyond > 0.0, self._up, self._down * (wanted + beyond > _WALKS))
        wanted += share * beyond
        self._known[numbers] = wanted
        return wanted
