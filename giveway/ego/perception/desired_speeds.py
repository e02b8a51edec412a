"""The speeds at which people want to walk, learnt from their speeds as seen.

Others and the ego slow people down, hardly anything makes them faster than they like to be: the
estimate rises to a faster pace soon, sinks to a slower one with patience, and whoever stands, or
nearly does, says nothing.
"""

import math

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.kernel import Array
from pedestrian_model import Crowd

_FASTER, _SLOWER = 0.25, 5.0  # [s] in which 63 % of a difference is learnt
_WALKS = 0.5  # [m/s] from which on a pace tells what is wanted


class Pace:
    """Learns the desired speed of people whom one ego sees, each by a number the person keeps.

    Args:
        typical: [m/s] what is taken to be wanted to begin with.
        time_step: [s] between two looks.
    """

    def __init__(self, typical: float, time_step: float) -> None:
        self._typical = typical
        self._up, self._down = (1.0 - math.exp(-time_step / t) for t in (_FASTER, _SLOWER))
        self._known = np.zeros(0)

    def learn(self, crowd: Crowd, numbers: NDArray[np.int64]) -> Array:
        """(n,) [m/s] the desired speeds, by now.

        Args:
            crowd: n people as they are seen; not changed.
            numbers: (n,) who they are.
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
