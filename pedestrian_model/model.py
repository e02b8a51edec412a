"""The crowd, stepped: Newton's law under the sum of the sub-forces."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from pedestrian_model import _step
from pedestrian_model._constants import pack
from pedestrian_model._rows import Workspace
from pedestrian_model.errors import DivergenceError, ParameterError, SurroundingsError
from pedestrian_model.parameters import SIM
from pedestrian_model.surroundings import OPEN_GROUND
from pedestrian_model.vehicles import COLUMNS

if TYPE_CHECKING:
    from pedestrian_model.crowd import Crowd
    from pedestrian_model.parameters import VciParameters
    from pedestrian_model.surroundings import Surroundings
    from pedestrian_model.vehicles import Vehicles

#: The longest step the integration takes at once: k_col dt^2 / m = 0.31 is stable.
LONGEST_STEP = 0.05  # [s]
#: From so many pedestrians on, neighbours are found by a cell list (benchmarks/bench_crowd.py).
CELL_LIST_FROM = 100


def substeps(time_step: float) -> int:
    """How many equal sub-steps of at most ``LONGEST_STEP`` make one step of ``time_step`` [s].

    Raises:
        ParameterError: if the time step is not positive and finite.
    """
    if not 0.0 < time_step < math.inf:
        raise ParameterError(f"time_step = {time_step} s, expected a finite number > 0 s")
    return max(1, math.ceil(time_step / LONGEST_STEP - 1e-9))


class CrowdModel:
    """The VCI model with a time step; it holds no state but scratch memory.

    Args:
        parameters: the numbers of the model.
        time_step: [s]; above 0.05 s it is divided into equal sub-steps, during which the vehicles
            drive straight on at constant speed.
        cell_list_from: the crowd size from which neighbours are found by a cell list (they always
            are beyond 332, where the ring no longer fits its buffer).

    Raises:
        ParameterError: if the time step is not positive and finite.
    """

    def __init__(
        self,
        parameters: VciParameters = SIM,
        time_step: float = 0.05,
        *,
        cell_list_from: int = CELL_LIST_FROM,
    ) -> None:
        self.parameters = parameters
        self.time_step = float(time_step)
        self.cell_list_from = int(cell_list_from)
        self._substeps = substeps(self.time_step)
        self._dt = self.time_step / self._substeps
        self._constants = pack(parameters)
        self._workspace = Workspace()

    def step(
        self, crowd: Crowd, vehicles: Vehicles, surroundings: Surroundings = OPEN_GROUND
    ) -> Crowd:
        """The crowd one time step later; all forces come from the old state.

        Raises:
            DivergenceError: if a pedestrian's state is or becomes not finite.
            SurroundingsError: if a way-point's signal is not one of the surroundings.
        """
        after = crowd.copy()
        self.advance(after, vehicles, surroundings)
        return after

    def advance(
        self, crowd: Crowd, vehicles: Vehicles, surroundings: Surroundings = OPEN_GROUND
    ) -> None:
        """Like ``step``, but changes position, velocity and waypoint_index of ``crowd`` in place.

        Bit-equal to ``step``, and allocates nothing unless the crowd has grown.

        Raises:
            DivergenceError: if a pedestrian's state is or becomes not finite.
            SurroundingsError: if a way-point's signal is not one of the surroundings.
        """
        if crowd.signals > surroundings.closed.shape[0]:
            raise unknown_signal(crowd, surroundings)
        if crowd.position.shape[0] > self._workspace.capacity:
            self._workspace.reserve(crowd.position.shape[0])
        bad = _step.advance(
            (*crowd.state, *crowd.wishes, *surroundings.arrays, *self._workspace.arrays),
            vehicles.array,
            self._constants,
            self._dt,
            self._substeps,
            self.cell_list_from,
        )
        if bad != _step.FINE:
            raise divergence(bad, crowd, vehicles)


def unknown_signal(crowd: Crowd, surroundings: Surroundings) -> SurroundingsError:
    """The error of a way-point whose signal is beyond ``surroundings.closed``."""
    at = int(np.argmax(crowd.waypoint_signal))
    i = int(np.searchsorted(crowd.waypoint_start, at, side="right")) - 1
    return SurroundingsError(
        f"pedestrian {i}: a way-point has signal {crowd.signals - 1}, but "
        f"surroundings.closed has {surroundings.closed.shape[0]}: give one for each signal"
    )


def divergence(i: int, crowd: Crowd, vehicles: Vehicles) -> DivergenceError:
    """The error of a state that is not finite, with the most likely cause."""
    bad = np.argwhere(~np.isfinite(vehicles.array))
    if bad.size:
        return DivergenceError(
            f"vehicle {bad[0, 0]}, column {COLUMNS[bad[0, 1]]} is not finite: "
            "check the vehicles given"
        )
    x, v = crowd.position[i], crowd.velocity[i]
    return DivergenceError(
        f"pedestrian {i}: the state is not finite (position {x} m, velocity {v} m/s); "
        "check its state before the step"
    )
