"""A look inside the model: each sub-force apart, and where everybody walks next.

The pair forces are linear in their strengths: the model's own kernels take them apart.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from pedestrian_model import OPEN_GROUND, Vehicles
from pedestrian_model._jit import kernel
from pedestrian_model._mathematics import cosine_sine
from pedestrian_model.routes import Routes
from pedestrian_model.stepping import FINE, divergence, first_insane, unknown_signal
from pedestrian_model.vci.buffers import FX, FY, PX, PY, SOFT, TX, TY, VFX, VFY, Scratch, Workspace
from pedestrian_model.vci.constants import pack
from pedestrian_model.vci.destination import set_targets
from pedestrian_model.vci.detour import detour
from pedestrian_model.vci.step import any_priority, gather_forces
from pedestrian_model.vci.vehicle_force import Traffic
from pedestrian_model.vci.wall_force import add_walls

cosine_sine = kernel(cosine_sine)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from pedestrian_model import Crowd, CrowdModel, Surroundings, VciParameters

    Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Forces:
    """The forces on each pedestrian [N], apart; all but ``beta`` (n,) are (n, 2)."""

    repulsion: Array  # sum of f_r
    collision: Array  # sum of f_c
    navigation: Array  # sum of f_n
    vehicle: Array  # f_v
    wall: Array  # f_w
    destination: Array  # f_d, without beta
    beta: Array  # in [0, 1], what the vehicles leave of f_d
    target: Array  # [m] where f_d pulls: a way-point, or a corner of a standing car

    @property
    def total(self) -> Array:
        """The total force before the limits (Yang & Özgüner 2019, equation of motion)."""
        others = self.repulsion + self.collision + self.navigation
        return others + self.wall + self.vehicle + self.beta[:, None] * self.destination


def forces_apart(
    model: CrowdModel, crowd: Crowd, vehicles: Vehicles, surroundings: Surroundings = OPEN_GROUND
) -> Forces:
    """Each sub-force in the present state.

    Raises:
        DivergenceError: if a pedestrian's state is not finite.
        SurroundingsError: if a way-point's signal is not one of the surroundings.
    """
    if crowd.signals > surroundings.closed.shape[0]:
        raise unknown_signal(crowd, surroundings)
    p = model.parameters
    strengths = ("repulsion_strength", "collision_stiffness", "navigation_strength")
    none = replace(p, **dict.fromkeys(strengths, 0.0))
    apart = [
        _gather(model, crowd, vehicles, replace(none, **{name: getattr(p, name)}))
        for name in strengths
    ]
    f_v = apart[0][2:4].T.copy()
    target, s_des_2, f_w = _targets(model, crowd, vehicles, surroundings)
    away = target - crowd.position
    distance = np.sqrt((away**2).sum(axis=1) + s_des_2)
    v_d = (crowd.desired_speed / distance)[:, None] * away
    size = np.sqrt((f_v**2).sum(axis=1))
    slope = (p.influence_high - size) / (p.influence_high - p.influence_low)
    return Forces(
        *(one[:2].T.copy() for one in apart),
        vehicle=f_v,
        wall=f_w,
        destination=p.destination_gain * (v_d - crowd.velocity),
        beta=np.clip(slope, 0.0, 1.0),
        target=target,
    )


def target_of(crowd: Crowd) -> Array:
    """(n, 2) [m] the current way-point of each pedestrian."""
    return crowd.waypoints[crowd.waypoint_start[:-1] + crowd.waypoint_index]


def constant_speed(vehicles: Vehicles, time_step: float, horizon: int) -> Array:
    """The poses (N, m, 7) at 0 ... N - 1 steps ahead, straight on at constant speed."""
    poses = np.repeat(vehicles.array[None], horizon, axis=0)
    time = (time_step * np.arange(horizon))[:, None]
    direction = np.array([cosine_sine(heading) for heading in vehicles.heading]).reshape(-1, 2)
    poses[:, :, :2] += time[:, :, None] * (vehicles.speed[:, None] * direction)
    return poses


def _gather(
    model: CrowdModel, crowd: Crowd, vehicles: Vehicles, parameters: VciParameters
) -> Array:
    """(4, n): pair force x, y, vehicle force x, y."""
    work, out = Workspace(), np.zeros((4, len(crowd)))
    work.reserve(len(crowd))
    constants = pack(parameters)
    bad = _fill_forces(
        *crowd.state[:2],
        crowd.priority,
        vehicles.array,
        work.arrays,
        constants,
        model.cell_list_from,
        out,
    )
    if bad != FINE:
        raise divergence(bad, crowd, vehicles)
    return out


def _targets(
    model: CrowdModel, crowd: Crowd, vehicles: Vehicles, surroundings: Surroundings
) -> tuple[Array, Array, Array]:
    """Where each walks next (n, 2) [m], s_des^2 there (n,) [m^2], f_w (n, 2) [N]."""
    work, out = Workspace(), np.zeros((len(crowd), 5))
    work.reserve(len(crowd))
    _fill_targets(
        crowd.position,
        crowd.desired_speed,
        crowd.routes,
        crowd.waypoint_index.copy(),
        vehicles.array,
        surroundings.arrays,
        work.arrays,
        pack(model.parameters),
        out,
    )
    return out[:, :2].copy(), out[:, 2].copy(), out[:, 3:].copy()


@kernel
def _fill_forces(
    position: Array,
    velocity: Array,
    priority: Array,
    vehicles: Array,
    scratch: tuple[NDArray[Any], ...],
    constants: NDArray[Any],
    cell_list_from: int,
    out: Array,
) -> int:
    n = position.shape[0]
    insane = first_insane(position, velocity)
    if n == 0 or insane != FINE:
        return insane
    memory = Scratch(*scratch)
    traffic = Traffic(vehicles, 0.0, any_priority(priority))
    gather_forces(position, velocity, priority, traffic, memory, constants, cell_list_from)
    rows, order = memory.rows, memory.sorting[0]
    for k in range(n):
        i = order[k]
        out[0, i], out[1, i], out[2, i], out[3, i] = (
            rows[FX, k],
            rows[FY, k],
            rows[VFX, k],
            rows[VFY, k],
        )
    return FINE


@kernel
def _fill_targets(
    position: Array,
    desired_speed: Array,
    routes: tuple[NDArray[Any], ...],
    waypoint_index: NDArray[np.int64],
    vehicles: Array,
    surroundings: tuple[NDArray[Any], ...],
    scratch: tuple[NDArray[Any], ...],
    constants: NDArray[Any],
    out: Array,
) -> None:
    c, n = constants[0], position.shape[0]
    rows, index, _ = scratch
    closed, walls, wall_cells = surroundings
    for i in range(n):
        index[0, i] = i
        rows[PX, i], rows[PY, i] = position[i, 0], position[i, 1]
        rows[FX, i], rows[FY, i] = 0.0, 0.0
    ways = index[0, :n], waypoint_index, Routes(*routes)
    add_walls(rows, n, FX, FY, (walls, wall_cells), ways, c)
    set_targets(rows, index[0, :n], desired_speed, Routes(*routes), waypoint_index, closed, c)
    detour(rows, n, vehicles, c)
    for i in range(n):
        out[i, 0], out[i, 1], out[i, 2] = rows[TX, i], rows[TY, i], rows[SOFT, i]
        out[i, 3], out[i, 4] = rows[FX, i], rows[FY, i]
