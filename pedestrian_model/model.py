"""The crowd, stepped: Newton's law under the sum of the sub-forces."""

import math
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._ahead import walk_ahead
from pedestrian_model._constants import pack
from pedestrian_model._jit import inlined, kernel
from pedestrian_model._routes import Line, Routes, aim
from pedestrian_model._rows import Arrays, Workspace
from pedestrian_model._step import FINE
from pedestrian_model.crowd import Crowd
from pedestrian_model.errors import DivergenceError, ParameterError, SurroundingsError
from pedestrian_model.parameters import SIM, VciParameters
from pedestrian_model.surroundings import OPEN_GROUND, Surroundings
from pedestrian_model.vehicles import COLUMNS, Vehicles

if TYPE_CHECKING:
    from pedestrian_model._team import Team

#: The longest step the integration takes at once: k_col dt^2 / m = 0.31 is stable.
LONGEST_STEP = 0.05  # [s]
#: From so many pedestrians on, neighbours are found by a cell list (benchmarks/bench_crowd.py).
CELL_LIST_FROM = 100
#: From so many on, several threads step a crowd: with fewer, they would wait for each other more.
SHARED_FROM = 1000
#: More threads than this are taken for a mistake.
MOST_THREADS = 256
_NOWHERE: Final = np.empty((1, 0, 2))  # where nobody's position after a step is noted


def substeps(time_step: float, longest: float = LONGEST_STEP) -> int:
    """How many equal sub-steps of at most ``longest`` [s] make one step of ``time_step`` [s].

    Raises:
        ParameterError: if the time step is not positive and finite.
    """
    if not 0.0 < time_step < math.inf:
        raise ParameterError(f"time_step = {time_step} s, expected a finite number > 0 s")
    return max(1, math.ceil(time_step / longest - 1e-9))


def require_steady(
    parameters: VciParameters, time_step: float, longest: float = LONGEST_STEP
) -> None:
    """Make sure that the integration's step does not make people's speeds swing.

    Somebody alone under the destination force has v' = (k_des/m)(v_d - v), of which one step of
    forward Euler makes v_d - v_(n+1) = (1 - z)(v_d - v_n), z = k_des dt/m (Hairer & Wanner 1996,
    "Solving Ordinary Differential Equations II", section IV.2). For z <= 1 the speed settles, for
    1 < z < 2 it overshoots in every step, beyond 2 it swings until a_max and v_max hold it. Near
    the last destination v_d = -v0 x/s_des, and the step (x too is integrated) has
    the trace 2 - z - z W/2 and the determinant 1 - z + z W/2 with W = v0 dt/s_des: for z <= 1 it
    is stable and has no negative eigenvalue exactly if W < 2.

    Args:
        parameters: of the model.
        time_step: [s]; its sub-steps count.
        longest: [s] of these.

    Raises:
        ParameterError: they swing.
    """
    dt = time_step / substeps(time_step, longest)
    p = parameters
    steady = p.mass / dt
    if p.destination_gain > steady:
        raise ParameterError(
            f"destination_gain = {p.destination_gain:g} N s/m: people's speeds swing from step to "
            f"step, k_des dt/m = {p.destination_gain / steady:.2g} > 1; expected at most m/dt = "
            f"{steady:g} N s/m for {p.mass:g} kg and steps of {dt:.4g} s"
        )
    nearest = 0.5 * p.max_speed * dt
    if p.destination_smoothing <= nearest:
        raise ParameterError(
            f"destination_smoothing = {p.destination_smoothing:g} m: people swing about their "
            f"destinations; expected more than v_max dt/2 = {nearest:g} m for {p.max_speed:g} m/s "
            f"and steps of {dt:.4g} s"
        )


class CrowdModel:
    """The VCI model with a time step; it holds no state but scratch memory.

    Args:
        parameters: the numbers of the model.
        time_step: [s]; above 0.05 s it is divided into equal sub-steps, during which the vehicles
            drive straight on at constant speed.
        cell_list_from: the crowd size from which neighbours are found by a cell list (they always
            are beyond 332, where the ring no longer fits its buffer).
        detour: whether people see the way round a standing car (ours), or walk into its side and
            stay there, as by the published forces alone.
        creep: whether the angle of a vehicle's force takes it to move below the static speed
            too, or to stand, as its contour does.
        threads: how many step a crowd of ``SHARED_FROM`` or more; the result is the same, bit by
            bit.

    Raises:
        ParameterError: if the time step is not positive and finite, or makes speeds swing, or
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
            people = (*state, *crowd.wishes, *surroundings.arrays, *memory)
            people += (*state, crowd.velocity)  # the crowd is its own memory for the state ahead:
            self._latest = crowd, surroundings, people  # one kernel less to compile
        time = (self._dt, self._substeps)
        if self._team is not None and n >= max(SHARED_FROM, self.cell_list_from):
            bad = self._team.advance(
                people[:-4], self._workspace, vehicles.array, self._constants, *time
            )
        else:
            law = (self._constants, *time, self.cell_list_from, 0.0)
            bad = walk_ahead(people, vehicles.array[None], *law, _NOWHERE)
        if bad != FINE:
            raise divergence(bad, crowd, vehicles)


def _team(threads: int) -> "Team":
    """The threads; imported here, so that who has one only loads none of their kernels."""
    from pedestrian_model._team import Team

    return Team(threads)


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


def arrived(crowd: Crowd, radius: float) -> NDArray[np.bool_]:
    """Mask (n,): on the way to the last way-point and within ``radius`` [m] of it, or its line."""
    mask = np.empty(len(crowd), dtype=np.bool_)
    _fill_arrived(crowd.position, crowd.waypoint_index, crowd.routes, radius, mask)
    return mask


def any_arrived(crowd: Crowd, radius: float) -> bool:
    """Whether :func:`arrived` is true of anybody: at most steps of nobody, which is soon known."""
    return bool(_any_arrived(crowd.position, crowd.waypoint_index, crowd.routes, radius))


@kernel
def _fill_arrived(
    position: NDArray[np.float64],
    waypoint_index: NDArray[np.int64],
    routes: Arrays,
    radius: float,
    mask: NDArray[np.bool_],
) -> None:
    for i in range(len(mask)):
        mask[i] = _is_there(i, position, waypoint_index, Routes(*routes), radius)


@kernel
def _any_arrived(
    position: NDArray[np.float64],
    waypoint_index: NDArray[np.int64],
    routes: Arrays,
    radius: float,
) -> bool:
    for i in range(len(position)):
        if _is_there(i, position, waypoint_index, Routes(*routes), radius):
            return True
    return False


@inlined
def _is_there(
    i: int,
    position: NDArray[np.float64],
    waypoint_index: NDArray[np.int64],
    routes: Routes,
    radius: float,
) -> bool:
    """Whether i is on the way to the last way-point and within ``radius`` of it, or its line."""
    w, q, last = routes.waypoints, routes.passage, routes.start[i + 1] - 1
    if routes.start[i] + waypoint_index[i] != last:
        return False
    x, y = position[i, 0], position[i, 1]
    p = Line(w[last, 0], w[last, 1], q[last, 0], q[last, 1], q[last, 2])
    to_x, to_y = aim(x, y, p, 0.0)
    dx, dy = to_x - x, to_y - y
    return bool(dx * dx + dy * dy <= radius * radius)
