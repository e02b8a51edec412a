"""Predicts people in a run by ``drift``."""

import numpy as np
from numpy.typing import NDArray

from pedestrian_model.crowd import Crowd
from pedestrian_model.drift.forest import fill_corrections
from pedestrian_model.drift.memory import Memory
from pedestrian_model.drift.motion import fill_positions, spread
from pedestrian_model.drift.trained import EXACT, Fit, fits
from pedestrian_model.parameters import VciParameters
from pedestrian_model.surroundings import OPEN_GROUND, Surroundings
from pedestrian_model.vci.prediction import Predictor

Array = NDArray[np.float64]
Ids = NDArray[np.int64]


class DriftPredictor(Predictor):
    """Constant velocity with the trained corrections, for people whose past is remembered.

    The prediction depends neither on vehicles nor on destinations, walls and signals. Only the
    desired velocities at its end are those of the routes, as with the other predictors.

    Args:
        parameters: Bodies and limits that the prediction assumes of people, without forces.
        time_step: Time step [s] of the prediction.
        horizon: Number N of steps.
        interval: Time [s] between two instants at which people are seen.
        fit: Fit of the trees, or None for the one of exact velocities.
    """

    def __init__(
        self,
        parameters: VciParameters,
        time_step: float,
        horizon: int,
        *,
        interval: float,
        fit: Fit | None = None,
    ) -> None:
        super().__init__(parameters, time_step, horizon, detour=False, longest_step=time_step)
        self._fit = fit or fits()[EXACT]
        self._past = Memory(interval)
        self._chosen = np.zeros(0, dtype=np.int64)
        self._stale = True
        self._ahead = np.empty((horizon, 0, 2))

    def remember(self, people: Crowd, person_ids: Ids) -> None:
        """Add what is seen at an instant; all of these people will be predicted.

        Args:
            people: People (n,) who are seen.
            person_ids: Id (n,) of each.
        """
        self._past.remember(people, person_ids)
        self.choose(person_ids)

    def choose(self, person_ids: Ids) -> None:
        """Predict only these people, who are the rows of the crowds that are given next."""
        self._chosen, self._stale = person_ids, True

    def given(self, crowd: Crowd) -> Array:
        """Return the predicted positions (N, n, 2) [m], which no vehicle changes."""
        if self._stale:
            heading, numbers = self._past.numbers(self._chosen)
            corrections = np.empty((len(crowd), 3, 2))
            fill_corrections(self._fit.trees, heading, numbers, corrections)
            self._ahead = np.empty((self.horizon, len(crowd), 2))
            fill_positions(
                crowd.position, crowd.velocity, heading, corrections, self.time_step, self._ahead
            )
            self._stale = False
        return self._ahead

    def predict(
        self,
        crowd: Crowd,
        vehicles_trajectory: Array,  # noqa: ARG002
        surroundings: Surroundings = OPEN_GROUND,
    ) -> Array:
        """Return the positions (N, n, 2) [m] of those who were chosen, at steps 1 ... N."""
        ahead, memory = self.given(crowd), self.arrays(crowd, surroundings)[-4:]
        memory[0][:], memory[2][:] = ahead[-1], crowd.waypoint_index
        return ahead

    def covariance(self, crowd: Crowd) -> Array:
        """Return the covariances (N, n, 2, 2) [m^2] of the predicted positions, in x and y."""
        speed: Array = np.hypot(crowd.velocity[:, 0], crowd.velocity[:, 1])
        times = self.time_step * np.arange(1.0, self.horizon + 1.0)
        along, across = np.moveaxis(
            spread(self._fit.deviation, speed, np.asarray(times)) ** 2, 2, 0
        )
        c, s = (crowd.velocity / np.where(speed > 0.0, speed, 1.0)[:, None]).T
        xx, yy = along * c * c + across * s * s, along * s * s + across * c * c
        xy = (along - across) * c * s
        out: Array = np.stack([np.stack([xx, xy], axis=-1), np.stack([xy, yy], axis=-1)], axis=-2)
        still = speed == 0.0
        out[:, still] = along[:, still, None, None] * np.eye(2)
        return out
