"""The protocol of whatever moves a crowd: all that giveway asks of a model of people."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from pedestrian_model.crowd import Crowd
from pedestrian_model.parameters import VciParameters
from pedestrian_model.surroundings import Surroundings
from pedestrian_model.vehicles import Vehicles


class PedestrianModel(Protocol):
    """Moves a crowd, step by step."""

    @property
    def parameters(self) -> VciParameters:
        """Bodies and limits of its people, whatever moves them."""

    @property
    def time_step(self) -> float:
        """The time step [s]."""

    def advance(self, crowd: Crowd, vehicles: Vehicles, surroundings: Surroundings = ...) -> None:
        """Change position, velocity and waypoint_index of ``crowd`` in place, a time step on."""


class CrowdPredictor(Protocol):
    """Predicts N steps of a crowd: what a controller that looks ahead asks of a model."""

    @property
    def parameters(self) -> VciParameters:
        """Bodies and limits of the people, whatever model they are believed to walk by."""

    @property
    def time_step(self) -> float:
        """The time step [s]."""

    @property
    def horizon(self) -> int:
        """N [steps]."""

    def predict(
        self,
        crowd: Crowd,
        vehicles_trajectory: NDArray[np.float64],
        surroundings: Surroundings = ...,
    ) -> NDArray[np.float64]:
        """The positions (N, n, 2) [m] after 1 ... N steps under (N, m, 7) vehicles."""

    def desired_velocities(
        self, crowd: Crowd, surroundings: Surroundings = ...
    ) -> NDArray[np.float64]:
        """(n, 3) velocities [m/s] wished for at the end of the latest, and for how long [s]."""
