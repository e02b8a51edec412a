"""The crowd, stepped: Newton's law under the sum of the sub-forces."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from pedestrian_model import _inspect, _step
from pedestrian_model._constants import pack
from pedestrian_model._rows import Workspace
from pedestrian_model.errors import DivergenceError, ParameterError, SurroundingsError
from pedestrian_model.parameters import SIM
from pedestrian_model.surroundings import OPEN_GROUND
from pedestrian_model.vehicles import COLUMNS

if TYPE_CHECKING:
    from numpy.typing import NDArray

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


@dataclass(frozen=True, eq=False)
class Forces:
    """The forces on each pedestrian [N], apart; all but ``beta`` (n,) are (n, 2)."""

    repulsion: NDArray[np.float64]  # sum of f_r
    collision: NDArray[np.float64]  # sum of f_c
    navigation: NDArray[np.float64]  # sum of f_n
    vehicle: NDArray[np.float64]  # f_v
    wall: NDArray[np.float64]  # f_w
    destination: NDArray[np.float64]  # f_d, without beta
    beta: NDArray[np.float64]  # in [0, 1], what the vehicles leave of f_d
    target: NDArray[np.float64]  # [m] where f_d pulls: a way-point, or a corner of a standing car

    @property
    def total(self) -> NDArray[np.float64]:
        """The total force before the limits (Yang & Özgüner 2019, equation of motion)."""
        others = self.repulsion + self.collision + self.navigation
        return others + self.wall + self.vehicle + self.beta[:, None] * self.destination


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
        closed, walls, wall_cells = surroundings.arrays
        if crowd.signals > closed.shape[0]:
            raise unknown_signal(crowd, surroundings)
        work = self._workspace
        work.reserve(crowd.position.shape[0])
        bad = _step.advance(
            crowd.position,
            crowd.velocity,
            crowd.desired_speed,
            crowd.waypoints,
            crowd.waypoint_passage,
            crowd.waypoint_signal,
            crowd.waypoint_start,
            crowd.waypoint_index,
            vehicles.array,
            closed,
            walls,
            wall_cells,
            work.rows,
            work.index,
            work.buffer,
            work.back,
            self._constants,
            self._dt,
            self._substeps,
            self.cell_list_from,
        )
        if bad != _step.FINE:
            raise divergence(bad, crowd, vehicles)

    def forces(
        self, crowd: Crowd, vehicles: Vehicles, surroundings: Surroundings = OPEN_GROUND
    ) -> Forces:
        """Each sub-force in the present state, for pictures and tests.

        Raises:
            DivergenceError: if a pedestrian's state is not finite.
            SurroundingsError: if a way-point's signal is not one of the surroundings.
        """
        if crowd.signals > surroundings.closed.shape[0]:
            raise unknown_signal(crowd, surroundings)
        none = replace(
            self.parameters,
            repulsion_strength=0.0,
            collision_stiffness=0.0,
            navigation_strength=0.0,
        )
        p = self.parameters
        only = {
            "repulsion": replace(none, repulsion_strength=p.repulsion_strength),
            "collision": replace(none, collision_stiffness=p.collision_stiffness),
            "navigation": replace(none, navigation_strength=p.navigation_strength),
        }
        # The pair forces are linear in their strengths: the kernel itself takes them apart.
        apart = {name: self._gather(crowd, vehicles, one) for name, one in only.items()}
        f_v = apart["repulsion"][2:4].T.copy()
        target, s_des_2, f_w = self._targets(crowd, vehicles, surroundings)
        away = target - crowd.position
        distance = np.sqrt((away**2).sum(axis=1) + s_des_2)
        v_d = (crowd.desired_speed / distance)[:, None] * away
        size = np.sqrt((f_v**2).sum(axis=1))
        slope = (p.influence_high - size) / (p.influence_high - p.influence_low)
        return Forces(
            repulsion=apart["repulsion"][:2].T.copy(),
            collision=apart["collision"][:2].T.copy(),
            navigation=apart["navigation"][:2].T.copy(),
            vehicle=f_v,
            wall=f_w,
            destination=p.destination_gain * (v_d - crowd.velocity),
            beta=np.clip(slope, 0.0, 1.0),
            target=target,
        )

    def _gather(
        self, crowd: Crowd, vehicles: Vehicles, parameters: VciParameters
    ) -> NDArray[np.float64]:
        """(5, n): pair force x, y, vehicle force x, y, signed distance."""
        work, n = self._workspace, len(crowd)
        work.reserve(n)
        out = np.zeros((5, n))
        bad = _inspect.forces_apart(
            crowd.position,
            crowd.velocity,
            vehicles.array,
            work.rows,
            work.index,
            work.buffer,
            work.back,
            pack(parameters),
            self.cell_list_from,
            out,
        )
        if bad != _step.FINE:
            raise divergence(bad, crowd, vehicles)
        return out

    def _targets(
        self, crowd: Crowd, vehicles: Vehicles, surroundings: Surroundings
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Where each walks next (n, 2) [m], s_des^2 there (n,) [m^2], f_w (n, 2) [N]."""
        out = np.zeros((len(crowd), 5))
        closed, walls, wall_cells = surroundings.arrays
        _inspect.targets(
            crowd.position,
            crowd.desired_speed,
            crowd.waypoints,
            crowd.waypoint_passage,
            crowd.waypoint_signal,
            crowd.waypoint_start,
            crowd.waypoint_index.copy(),
            vehicles.array,
            closed,
            walls,
            wall_cells,
            self._workspace.rows,
            self._workspace.index,
            self._constants,
            out,
        )
        return out[:, :2].copy(), out[:, 2].copy(), out[:, 3:].copy()


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
