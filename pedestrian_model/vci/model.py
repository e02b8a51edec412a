"""The VCI model with a time step: Newton's law under the sum of the sub-forces."""

from typing import TYPE_CHECKING, Final

import numpy as np

from pedestrian_model.arrays import Arrays
from pedestrian_model.crowd import Crowd
from pedestrian_model.errors import ParameterError
from pedestrian_model.parameters import SIM, VciParameters
from pedestrian_model.stepping import FINE, LONGEST_STEP, divergence, substeps, unknown_signal
from pedestrian_model.surroundings import OPEN_GROUND, Surroundings
from pedestrian_model.vci.buffers import Workspace
from pedestrian_model.vci.constants import pack
from pedestrian_model.vci.rollout import roll_out
from pedestrian_model.vehicles import Vehicles

if TYPE_CHECKING:
    from pedestrian_model.vci.threads import CrowdThreads

#: Crowd size from which on neighbours are found by a cell list (benchmarks/speed/bench_crowd.py).
CELL_LIST_FROM = 100
#: Crowd size from which on several threads step a crowd.
THREADS_FROM = 1000
#: Largest number of threads that is accepted.
MOST_THREADS = 256
_DOUBLE = 2.0 * LONGEST_STEP + 1e-9  # longest step [s] that ``pack`` makes as steady as the crowd's
_NOWHERE: Final = np.empty((1, 0, 2))  # output (1, 0, 2) of one step without recorded positions


def require_steady(
    parameters: VciParameters, time_step: float, longest: float = LONGEST_STEP
) -> None:
    """Make sure that people's speeds do not oscillate with the step of the integration.

    A person alone under the destination force has v' = (k_des/m)(v_d - v). One step of forward
    Euler gives v_d - v_(n+1) = (1 - z)(v_d - v_n), z = k_des dt/m (Hairer & Wanner 1996, "Solving
    Ordinary Differential Equations II", section IV.2). For z <= 1 the speed settles. For 1 < z < 2
    it overshoots in every step. Beyond 2 it grows until a_max and v_max limit it. Near the last
    destination v_d = -v0 x/s_des. The step, in which x is integrated as well, has the trace
    2 - z - z W/2 and the determinant 1 - z + z W/2 with W = v0 dt/s_des. For z <= 1 it is stable
    without a negative eigenvalue exactly if W < 2.

    A predictor's step of up to two of the crowd's has a larger mass (``pack``), so that the speed
    settles in it if it settles in the crowd's.

    Args:
        parameters: Parameters of the model.
        time_step: Time step [s], which is divided into sub-steps.
        longest: Longest sub-step [s].

    Raises:
        ParameterError: speeds would oscillate.
    """
    dt = time_step / substeps(time_step, longest)
    p, step = parameters, dt if dt > _DOUBLE else min(dt, LONGEST_STEP)
    steady = p.mass / step
    if p.destination_gain > steady:
        raise ParameterError(
            f"destination_gain = {p.destination_gain:g} N s/m: people's speeds swing from step to "
            f"step, k_des dt/m = {p.destination_gain / steady:.2g} > 1; expected at most m/dt = "
            f"{steady:g} N s/m for {p.mass:g} kg and steps of {step:.4g} s"
        )
    nearest = 0.5 * p.max_speed * dt
    if p.destination_smoothing <= nearest:
        raise ParameterError(
            f"destination_smoothing = {p.destination_smoothing:g} m: people swing about their "
            f"destinations; expected more than v_max dt/2 = {nearest:g} m for {p.max_speed:g} m/s "
            f"and steps of {dt:.4g} s"
        )


class CrowdModel:
    """The VCI model with a time step. It keeps no state but scratch memory.

    Args:
        parameters: Parameters of the model.
        time_step: Time step [s]. Above 0.05 s it is divided into equal sub-steps, during which the
            vehicles drive straight on at constant speed.
        cell_list_from: Crowd size from which on neighbours are found by a cell list. Beyond 332
            people they always are, because all pairs no longer fit into the buffer.
        detour: Whether people walk around a standing car (ours). If not, they walk into its side
            and stay there, as by the published forces alone.
        creep: Whether the angle of a vehicle's force treats the vehicle as moving below the static
            speed as well. If not, it stands, as for its contour.
        threads: Number of threads that step a crowd of ``THREADS_FROM`` or more. The result is the
            same, bit by bit.

    Raises:
        ParameterError: if the time step is not positive and finite, or makes speeds oscillate, or
            there are less than one or more than ``MOST_THREADS`` threads.
    """

    def __init__(
        self,
        parameters: VciParameters = SIM,
        time_step: float = 0.05,
        *,
        cell_list_from: int = CELL_LIST_FROM,
        detour: bool = True,
        creep: bool = True,
        threads: int = 1,
    ) -> None:
        require_steady(parameters, time_step)
        if not 1 <= threads <= MOST_THREADS:
            raise ParameterError(f"threads = {threads}, expected 1 to {MOST_THREADS}")
        self.parameters = parameters
        self.time_step = float(time_step)
        self.cell_list_from = int(cell_list_from)
        self._substeps = substeps(self.time_step)
        self._dt = self.time_step / self._substeps
        self._constants = pack(parameters, detour=detour, creep=creep)
        self._workspace = Workspace()
        self._latest: tuple[Crowd | None, Surroundings, Arrays] = None, OPEN_GROUND, ()
        self._team = _team(threads) if threads > 1 else None

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
        n = crowd.position.shape[0]
        if n > self._workspace.capacity:
            self._workspace.reserve(n)
        people = self._latest[2]
        if crowd is not self._latest[0] or surroundings is not self._latest[1]:
            state, memory = crowd.state, self._workspace.arrays
            people = (*state, *crowd.fixed_arrays, *surroundings.arrays, *memory)
            people += (*state, crowd.velocity)  # the rollout changes the crowd itself
            self._latest = crowd, surroundings, people
        time = (self._dt, self._substeps)
        if self._team is not None and n >= max(THREADS_FROM, self.cell_list_from):
            bad = self._team.advance(
                people[:-4], self._workspace, vehicles.array, self._constants, *time
            )
        else:
            law = (self._constants, *time, self.cell_list_from, 0.0)
            bad = roll_out(people, vehicles.array[None], law, _NOWHERE)
        if bad != FINE:
            raise divergence(bad, crowd, vehicles)


def _team(threads: int) -> "CrowdThreads":
    """Return the threads; the import is here so that one thread does not load their kernels."""
    from pedestrian_model.vci.threads import CrowdThreads

    return CrowdThreads(threads)
