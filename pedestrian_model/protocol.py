"""The protocols of pedestrian models and of predictors, which giveway uses."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from pedestrian_model.crowd import Crowd
from pedestrian_model.parameters import VciParameters
from pedestrian_model.surroundings import Surroundings
from pedestrian_model.vehicles import Vehicles


class PedestrianModel(Protocol):
    """A pedestrian model, which moves a crowd step by step."""

    @property
    def parameters(self) -> VciParameters:
        """The bodies and limits of its people; other parameters need not be used."""

    @property
    def time_step(self) -> float:
        """The time step [s]."""

    def advance(self, crowd: Crowd, vehicles: Vehicles, surroundings: Surroundings = ...) -> None:
        """Advance position, velocity and waypoint_index of ``crowd`` in place by one time step."""


class CrowdPredictor(Protocol):
    """A predictor of N steps of a crowd, for controllers that look ahead."""

    @property
    def parameters(self) -> VciParameters:
        """The bodies and limits of the people; other parameters need not be used."""

    @property
    def time_step(self) -> float:
        """The time step [s]."""

    @property
    def horizon(self) -> int:
        """The prediction horizon N [steps]."""

    def predict(
        self,
        crowd: Crowd,
        vehicles_trajectory: NDArray[np.float64],
        surroundings: Surroundings = ...,
    ) -> NDArray[np.float64]:
        """Return the positions (N, n, 2) [m] after 1 ... N steps, for vehicles (N, m, 7)."""

    def desired_velocities(
        self, crowd: Crowd, surroundings: Surroundings = ...
    ) -> NDArray[np.float64]:
        """Return the desired velocities (n, 3) at the end of the latest prediction.

        The columns are x, y [m/s], and the time [s] for which the velocity is kept.
        """
