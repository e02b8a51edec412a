"""Predicts the crowd by applying the VCI model N times, for given vehicle poses."""

import math

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import borrowed, inlined, kernel
from pedestrian_model.arrays import Arrays
from pedestrian_model.crowd import Crowd
from pedestrian_model.errors import DivergenceError, ParameterError, VehicleError
from pedestrian_model.parameters import SIM, VciParameters
from pedestrian_model.routes import Line, aim
from pedestrian_model.stepping import FINE, LONGEST_STEP, substeps, unknown_signal
from pedestrian_model.surroundings import OPEN_GROUND, Surroundings
from pedestrian_model.vci.buffers import Workspace
from pedestrian_model.vci.constants import pack
from pedestrian_model.vci.model import CELL_LIST_FROM, require_steady
from pedestrian_model.vci.rollout import roll_out
from pedestrian_model.vci.step import Scene, parts

_NONE_GIVEN = np.empty((0, 0, 2))  # positions of a prediction by the model itself


class Predictor:
    """Predicts N steps of the crowd in one compiled call.

    Yang & Özgüner 2019, section "Motion Prediction".

    Args:
        parameters: Parameters of the model.
        time_step: Time step [s]. Above ``longest_step`` it is divided as in ``CrowdModel``.
        horizon: Number N of steps.
        cell_list_from: Crowd size from which on neighbours are found by a cell list.
        detour: Whether people walk around a standing car, as in ``CrowdModel``.
        creep: Whether the angle of a vehicle's force treats the vehicle as moving below the static
            speed as well, as in ``CrowdModel``.
        longest_step: Longest step [s] of the integration, by default that of the crowd. A longer
            step stands for several of these, see :func:`rollout_step`.

    Raises:
        ParameterError: if the time step or the horizon is not positive, or speeds would oscillate.
    """

    def __init__(
        self,
        parameters: VciParameters = SIM,
        time_step: float = 0.05,
        horizon: int = 15,
        *,
        cell_list_from: int = CELL_LIST_FROM,
        detour: bool = True,
        creep: bool = True,
        longest_step: float = LONGEST_STEP,
    ) -> None:
        if horizon < 1:
            raise ParameterError(f"horizon = {horizon} steps, expected at least 1")
        require_steady(parameters, time_step, longest_step)
        self.parameters = parameters
        self.time_step = float(time_step)
        self.horizon = int(horizon)
        self.cell_list_from = int(cell_list_from)
        self._substeps = substeps(self.time_step, longest_step)
        self._dt = self.time_step / self._substeps
        longer = max(0.0, self._dt - LONGEST_STEP)
        constants = pack(parameters, detour=detour, creep=creep, longer=longer)
        self.law = (constants, self._dt, self._substeps, self.cell_list_from, 0.5 * longer)
        self._workspace = Workspace()
        self._latest: tuple[Crowd | None, Surroundings, Arrays] = None, OPEN_GROUND, ()
        self._capacity = -1
        self._reserve(0)

    def _reserve(self, n: int) -> None:
        """Provide arrays for n people. The buffers behind them grow if needed and never shrink."""
        if n > self._workspace.capacity:
            self._workspace.reserve(n)
        if n > self._capacity:
            self._capacity = max(n, 2 * self._capacity)
            self._memory = np.empty((3 + self.horizon) * self._capacity * 2)
            self._all_reached = np.empty(self._capacity, dtype=np.int64)
        both = self._memory[: (3 + self.horizon) * n * 2].reshape(3 + self.horizon, n, 2)
        self._state, self._out = (both[0], both[1], self._all_reached[:n], both[2]), both[3:]

    def predict(
        self,
        crowd: Crowd,
        vehicles_trajectory: NDArray[np.float64],
        surroundings: Surroundings = OPEN_GROUND,
    ) -> NDArray[np.float64]:
        """Predict the crowd, without changing ``crowd``.

        Args:
            crowd: Present state.
            vehicles_trajectory: Vehicles (N, m, 7) at steps 0 ... N - 1, see ``Vehicles``.
            surroundings: Walls and signals. Signals closed now stay closed over the horizon.

        Returns:
            Positions (N, n, 2) [m] after 1 ... N steps, in a buffer that the next call overwrites.
            They are bit-equal to N times ``CrowdModel.step`` with the same vehicles, if the steps
            are not longer than those of the crowd.

        Raises:
            VehicleError: if the trajectory is not C-contiguous float64 of shape (N, m, 7).
            DivergenceError: if a pedestrian's state is or becomes not finite.
            SurroundingsError: if a way-point's signal is not one of the surroundings.
        """
        shape, flags = vehicles_trajectory.shape, vehicles_trajectory.flags
        if len(shape) != 3 or shape[0] != self.horizon or shape[2] != 7:
            raise VehicleError(
                f"vehicles_trajectory has shape {shape}, expected ({self.horizon}, any, 7)"
            )
        if not flags.c_contiguous or vehicles_trajectory.dtype != np.float64:
            raise VehicleError("vehicles_trajectory is expected to be C-contiguous float64")
        people = self.arrays(crowd, surroundings)
        bad = roll_out(people, vehicles_trajectory, self.law, self._out)
        if bad != FINE:
            raise self.divergence(crowd, bad)
        return self._out

    def arrays(self, crowd: Crowd, surroundings: Surroundings) -> Arrays:
        """Return the arrays that :func:`start` takes. The last four hold the predicted state.

        Raises:
            SurroundingsError: if a way-point's signal is not one of the surroundings.
        """
        if crowd.signals > surroundings.closed.shape[0]:
            raise unknown_signal(crowd, surroundings)
        if crowd is self._latest[0] and surroundings is self._latest[1]:
            return self._latest[2]
        if crowd.position.shape[0] != self._out.shape[1]:
            self._reserve(crowd.position.shape[0])
        scratch = self._workspace.arrays
        arrays = (*crowd.state, *crowd.fixed_arrays, *surroundings.arrays, *scratch, *self._state)
        self._latest = crowd, surroundings, arrays
        return arrays

    def given(self, crowd: Crowd) -> NDArray[np.float64]:  # noqa: ARG002
        """Return positions (N, n, 2) [m] that the model's steps do not change; here none, N = 0."""
        return _NONE_GIVEN

    def desired_velocities(
        self, crowd: Crowd, surroundings: Surroundings = OPEN_GROUND
    ) -> NDArray[np.float64]:
        """Return the desired velocities at the end of the latest prediction.

        Returns:
            Velocities x, y [m/s] and the time [s] for which each is kept, (n, 3); see
            :func:`desired_velocity`.
        """
        velocities = np.empty((len(crowd), 3))
        fill_desired_velocities(self.arrays(crowd, surroundings), velocities)
        return velocities

    @staticmethod
    def divergence(crowd: Crowd, bad: int) -> DivergenceError:
        """Return the error of a pedestrian whose predicted state is not finite."""
        return DivergenceError(
            f"pedestrian {bad}: the predicted state is not finite; check its present position "
            f"{crowd.position[bad]} m, velocity {crowd.velocity[bad]} m/s and the vehicles"
        )


@inlined
def desired_velocity(
    x: float, y: float, target: int, i: int, scene: Scene
) -> tuple[float, float, float]:
    """Return the desired velocity x, y [m/s] of a pedestrian, and the time [s] that it is kept.

    It leads to the next way-point, or to the nearest point of its passage. Pedestrians are assumed
    to go straight on beyond it, unless it is the last one or its signal is closed.

    Args:
        x: Coordinate [m] of the pedestrian.
        y: Coordinate [m] of the pedestrian.
        target: Index of the next way-point, counted from the pedestrian's first.
        i: Row of the pedestrian.
        scene: Surroundings and routes of the crowd.
    """
    w, q, signal, begin = scene.routes
    at = begin[i] + target
    passage = Line(w[at, 0], w[at, 1], q[at, 0], q[at, 1], q[at, 2])
    to_x, to_y = aim(x, y, passage, 0.0)
    to_x, to_y = to_x - x, to_y - y
    left, pace = math.sqrt(to_x * to_x + to_y * to_y), scene.desired_speed[i]
    if left <= 0.0 or pace <= 0.0:
        return 0.0, 0.0, math.inf
    ends = at == begin[i + 1] - 1 or (signal[at] >= 0 and scene.closed[signal[at]])
    return pace * to_x / left, pace * to_y / left, left / pace if ends else math.inf


@kernel
def fill_desired_velocities(arrays: Arrays, velocities: NDArray[np.float64]) -> None:
    """Fill ``velocities`` (n, 3) with the desired ones at the end of the latest prediction."""
    scene = parts(arrays[:-4])[1]
    x, _, at, _ = borrowed(arrays[-4:])
    for i in range(x.shape[0]):
        velocities[i, 0], velocities[i, 1], velocities[i, 2] = desired_velocity(
            x[i, 0], x[i, 1], at[i], i, scene
        )
