"""A look inside the model: forces apart, targets, and the vehicle influence anywhere."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from pedestrian_model._detour import detour
from pedestrian_model._jit import kernel
from pedestrian_model._routes import Routes, set_targets
from pedestrian_model._rows import FX, FY, PX, PY, SOFT, TX, TY, VFX, VFY, VX, VY, S
from pedestrian_model._step import FINE, first_insane, gather_forces
from pedestrian_model._vehicles import add_vehicle
from pedestrian_model._walls import add_walls

if TYPE_CHECKING:
    from numpy.typing import NDArray


@kernel
def forces_apart(
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
    vehicles: NDArray[np.float64],
    rows: NDArray[np.float64],
    index: NDArray[np.int64],
    buffer: NDArray[np.float64],
    back: NDArray[np.float64],
    constants: NDArray[Any],
    cell_list_from: int,
    out: NDArray[np.float64],
) -> int:
    """Fill ``out`` (5, n): pair force x, y, vehicle force x, y, signed distance to a contour."""
    n = position.shape[0]
    insane = first_insane(position, velocity)
    if n == 0 or insane != FINE:
        return insane
    gather_forces(
        position, velocity, vehicles, 0.0, rows, index, buffer, back, constants, cell_list_from
    )
    for k in range(n):
        i = index[0, k]
        out[0, i], out[1, i] = rows[FX, k], rows[FY, k]
        out[2, i], out[3, i], out[4, i] = rows[VFX, k], rows[VFY, k], rows[S, k]
    return FINE


@kernel
def targets(
    position: NDArray[np.float64],
    desired_speed: NDArray[np.float64],
    waypoints: NDArray[np.float64],
    passage: NDArray[np.float64],
    signal: NDArray[np.int64],
    waypoint_start: NDArray[np.int64],
    waypoint_index: NDArray[np.int64],
    vehicles: NDArray[np.float64],
    closed: NDArray[np.bool_],
    walls: NDArray[np.float64],
    wall_cells: NDArray[np.int64],
    rows: NDArray[np.float64],
    index: NDArray[np.int64],
    constants: NDArray[Any],
    out: NDArray[np.float64],
) -> None:
    """Fill ``out`` (n, 5): target x, y, its s_des^2, force of the walls x, y.

    Advances ``waypoint_index``: pass a copy.
    """
    c = constants[0]
    n = position.shape[0]
    for i in range(n):
        index[0, i] = i
        rows[PX, i], rows[PY, i] = position[i, 0], position[i, 1]
        rows[FX, i], rows[FY, i] = 0.0, 0.0
    add_walls(rows, n, FX, FY, walls, wall_cells, c)
    routes = Routes(waypoints, passage, signal, waypoint_start)
    set_targets(rows, index[0], desired_speed, routes, waypoint_index, closed, c)
    detour(rows, n, vehicles, c)
    for i in range(n):
        out[i, 0], out[i, 1], out[i, 2] = rows[TX, i], rows[TY, i], rows[SOFT, i]
        out[i, 3], out[i, 4] = rows[FX, i], rows[FY, i]


@kernel
def influence(
    points: NDArray[np.float64],
    velocities: NDArray[np.float64],
    vehicles: NDArray[np.float64],
    constants: NDArray[Any],
    rows: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """Fill ``out`` (k, 3) with the vehicles' force x, y and the signed distance at each point."""
    n = points.shape[0]
    for i in range(rows.shape[1]):
        rows[PX, i], rows[PY, i] = points[min(i, n - 1), 0], points[min(i, n - 1), 1]
        rows[VX, i], rows[VY, i] = velocities[min(i, n - 1), 0], velocities[min(i, n - 1), 1]
        rows[VFX, i], rows[VFY, i], rows[S, i] = 0.0, 0.0, np.inf
    for v in range(vehicles.shape[0]):
        add_vehicle(rows, 0, n, vehicles[v], 0.0, constants[0])
    for i in range(n):
        out[i, 0], out[i, 1], out[i, 2] = rows[VFX, i], rows[VFY, i], rows[S, i]
