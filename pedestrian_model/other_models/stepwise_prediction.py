"""Predicts the crowd with any model, step by step, for given vehicle poses."""

import numpy as np
from numpy.typing import NDArray

from pedestrian_model.crowd import Crowd
from pedestrian_model.errors import ParameterError, PlugInError
from pedestrian_model.parameters import VciParameters
from pedestrian_model.protocol import PedestrianModel
from pedestrian_model.surroundings import OPEN_GROUND, Surroundings
from pedestrian_model.vci.buffers import Workspace
from pedestrian_model.vci.prediction import fill_desired_velocities
from pedestrian_model.vehicles import Vehicles


class StepwisePredictor:
    """Predicts N steps of the crowd by N calls of a model.

    Args:
        model: Pedestrian model that only this predictor uses. A model with a memory is reset before
            each prediction.
        horizon: Number N of the model's steps.

    Raises:
        ParameterError: if the horizon is not positive.
    """

    def __init__(self, model: PedestrianModel, horizon: int) -> None:
        if horizon < 1:
            raise ParameterError(f"horizon = {horizon} steps, expected at least 1")
        self.horizon = int(horizon)
        self._model = model
        self._reset = getattr(model, "reset", None)
        self._ahead = Crowd.empty()
        self._vehicles = Vehicles.empty()
        self._workspace = Workspace()

    @property
    def parameters(self) -> VciParameters:
        """The bodies and limits of the people."""
        return self._model.parameters

    @property
    def time_step(self) -> float:
        """The time step [s]."""
        return self._model.time_step

    def predict(
        self,
        crowd: Crowd,
        vehicles_trajectory: NDArray[np.float64],
        surroundings: Surroundings = OPEN_GROUND,
    ) -> NDArray[np.float64]:
        """Return the positions (N, n, 2) [m] after 1 ... N steps, without changing ``crowd``.

        Args:
            crowd: Present state.
            vehicles_trajectory: Vehicles (N, m, 7) at steps 0 ... N - 1, see ``Vehicles``.
            surroundings: Walls and signals. Signals closed now stay closed over the horizon.

        Raises:
            DivergenceError: if a pedestrian's state is or becomes not finite.
            PlugInError: the answer of another package's model cannot be used.
            SurroundingsError: if a way-point's signal is not one of the surroundings.
        """
        if self._reset is not None:
            self._reset()
        if self._vehicles.array.shape != vehicles_trajectory.shape[1:]:
            self._vehicles = Vehicles(vehicles_trajectory[0].copy())
        ahead = self._ahead = crowd.copy()
        out = np.empty((self.horizon, len(crowd), 2))
        for k in range(self.horizon):
            self._vehicles.array[:] = vehicles_trajectory[k]
            try:
                self._model.advance(ahead, self._vehicles, surroundings)
            except PlugInError as error:  # without the person, whose row is that of a selection
                raise PlugInError(f"{error} (predicting {k + 1} steps ahead)") from error
            out[k] = ahead.position
        return out

    def desired_velocities(
        self, crowd: Crowd, surroundings: Surroundings = OPEN_GROUND
    ) -> NDArray[np.float64]:
        """Return the desired velocities (n, 3) at the end of the latest prediction of ``crowd``."""
        wishes, ahead = np.empty((len(crowd), 3)), self._ahead
        fill_desired_velocities(
            (
                *ahead.state,
                *ahead.fixed_arrays,
                *surroundings.arrays,
                *self._workspace.arrays,
                *ahead.state,
                ahead.velocity,
            ),
            wishes,
        )
        return wishes
