"""Who of a large crowd can matter to an ego's plan."""

import numpy as np
from numpy.typing import NDArray

from giveway.ego.waiting import WaitingEgo
from pedestrian_model import Crowd

PREDICT_ALL = 150  # pedestrians; of a larger crowd only those that matter to the ego are predicted


class Relevance:
    """Tells who is near enough.

    Those who are left out act on the plan only through others, and move the pedestrians that the
    ego may meet by less than a micrometre within the horizon.

    Args:
        waiting: the ego before its departure.
        span: that it looks ahead [s].
        size: of its body and its corridor [m].
    """

    def __init__(self, waiting: WaitingEgo, span: float, size: float) -> None:
        config, predictor = waiting.config, waiting.predictor
        strongest = config.mpc.force_limit / config.vehicle.mass
        self._span = span
        self._beyond = strongest * span / 2.0 * span + config.regulation.safe_distance
        self._beyond += waiting.walking_speed_limit * span + size
        if predictor is not None:
            self._beyond += predictor.parameters.interaction_radius

    def of(self, crowd: Crowd, x: float, y: float, speed: float) -> NDArray[np.bool_]:
        """(n,) who can matter to a plan from (x, y) [m] at ``speed`` [m/s]."""
        reach = speed * self._span + self._beyond
        d_x, d_y = crowd.position[:, 0] - x, crowd.position[:, 1] - y
        within: NDArray[np.bool_] = d_x * d_x + d_y * d_y <= reach * reach
        return within
