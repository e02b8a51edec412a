"""One step of the crowd: all forces from the old state, then all states are updated at once."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import borrowed, fma, inlined
from pedestrian_model.arrays import Arrays
from pedestrian_model.routes import Routes
from pedestrian_model.stepping import FINE, first_insane
from pedestrian_model.vci.buffers import (
    BLOCK,
    FX,
    FY,
    LARGEST_RING,
    MOST,
    NVX,
    NVY,
    NX,
    NY,
    PRIORITY,
    PX,
    PY,
    SOFT,
    TX,
    TY,
    V0,
    VFX,
    VFY,
    VX,
    VY,
    WX,
    WY,
    Scratch,
)
from pedestrian_model.vci.destination import set_targets
from pedestrian_model.vci.detour import detour
from pedestrian_model.vci.pairs.all_pairs import add_all_pairs
from pedestrian_model.vci.pairs.cell_list import add_near_pairs
from pedestrian_model.vci.vehicle_force import Traffic, add_near_vehicles, add_vehicles
from pedestrian_model.vci.wall_force import add_walls


class State(NamedTuple):
    """The arrays that a step changes, as in ``Crowd``."""

    position: NDArray[np.float64]  # positions (n, 2) [m]
    velocity: NDArray[np.float64]  # velocities (n, 2) [m/s]
    waypoint_index: NDArray[np.int64]  # indices (n,) of the next way-points


class Scene(NamedTuple):
    """The surroundings, routes and desired speeds of a crowd, which no step changes."""

    desired_speed: NDArray[np.float64]  # desired speeds (n,) [m/s]
    priority: NDArray[np.float64]  # priorities (n,), 0 to 1
    routes: Routes
    closed: NDArray[np.bool_]  # marks (signals,) of closed signals
    walls: NDArray[np.float64]  # lines of ``Walls``
    wall_cells: NDArray[np.int64]  # cells of ``Walls``


@inlined
def any_priority(priority: NDArray[np.float64]) -> bool:
    """Return whether anybody has priority."""
    most = 0.0
    for i in range(priority.shape[0]):
        most = max(most, priority[i])
    return most > 0.0


@inlined
def _fill_priority(
    rows: NDArray[np.float64], order: NDArray[np.int64], priority: NDArray[np.float64]
) -> None:
    """Copy the priorities into the rows, in the given order."""
    for k in range(priority.shape[0]):
        rows[PRIORITY, k] = priority[order[k]]


@inlined
def gather_forces(
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
    priority: NDArray[np.float64],
    traffic: Traffic,
    scratch: Scratch,
    constants: NDArray[Any],
    cell_list_from: int,
) -> None:
    """Fill the rows and their pair and vehicle forces from the state."""
    n = position.shape[0]
    rows, index, buffer = scratch
    if n >= cell_list_from or n > LARGEST_RING:
        grid = add_near_pairs(rows, index, buffer, position, velocity, constants)
        if traffic.relied_on:
            _fill_priority(rows, index[0], priority)
        add_near_vehicles(rows, index[2], grid, n, traffic, constants)
    else:
        add_all_pairs(rows, index, buffer, position, velocity, constants)
        if traffic.relied_on:
            _fill_priority(rows, index[0], priority)
        add_vehicles(rows, n, traffic, constants[0])


@inlined
def _integrate(rows: NDArray[np.float64], n: int, dt: float, c: Any) -> None:
    """Compute the next state of the first n rows: total force, limits, synchronous update.

    n is a multiple of the block. Results of dummies are never read.
    """
    m, k_des, F_2, inverse_F = c.m, c.k_des, c.F_2, c.inverse_F
    top, most, v_max = c.m * c.a_max, rows[MOST], c.v_max
    hold_x, hold_y = rows[WX], rows[WY]
    x, y, vx, vy = rows[PX], rows[PY], rows[VX], rows[VY]
    fx, fy, vfx, vfy = rows[FX], rows[FY], rows[VFX], rows[VFY]
    to_x, to_y, v0, s_des_2 = rows[TX], rows[TY], rows[V0], rows[SOFT]
    nx, ny, nvx, nvy = rows[NX], rows[NY], rows[NVX], rows[NVY]
    for k in range(n):
        # v_d = v0 (p - x)/sqrt(|p - x|^2 + s_des^2), f_d = k_des (v_d - v)
        dx, dy = to_x[k] - x[k], to_y[k] - y[k]
        pace = v0[k] / math.sqrt(fma(dx, dx, fma(dy, dy, s_des_2[k])))
        f_v = math.sqrt(fma(vfx[k], vfx[k], vfy[k] * vfy[k]))
        beta = min(1.0, max(0.0, (F_2 - f_v) * inverse_F))
        # Yang & Özgüner 2019: F = sum (f_r + f_c + f_n) + f_v + beta f_d
        drive = beta * k_des
        F_x = fx[k] + vfx[k] + drive * fma(pace, dx, -vx[k])
        F_y = fy[k] + vfy[k] + drive * fma(pace, dy, -vy[k])
        # The force is limited to m a_max. A wall or a closed signal raises the limit in the
        # direction in which it holds, and not beside it: neighbours would make people tremble.
        F = math.sqrt(fma(F_x, F_x, F_y * F_y))
        scale = top / F if top < F else 1.0
        held = most[k] > top
        along = F_x * hold_x[k] + F_y * hold_y[k] if held else 0.0
        room = math.sqrt(most[k] * most[k] - top * top) if held else 0.0
        bounded = min(max(along, -room), room)
        more = bounded - along * scale if abs(bounded) > abs(along) * scale else 0.0
        F_x = F_x * scale + more * hold_x[k] if held else F_x * scale
        F_y = F_y * scale + more * hold_y[k] if held else F_y * scale
        a_x, a_y = F_x / m, F_y / m
        # The speed at the end of the step is limited to v_max.
        end_x, end_y = fma(a_x, dt, vx[k]), fma(a_y, dt, vy[k])
        speed = math.sqrt(fma(end_x, end_x, end_y * end_y))
        slower = v_max / speed if speed > v_max else 1.0
        end_x, end_y = end_x * slower, end_y * slower
        a_x = (end_x - vx[k]) / dt if speed > v_max else a_x
        a_y = (end_y - vy[k]) / dt if speed > v_max else a_y
        nx[k] = fma(fma(0.5 * dt, a_x, vx[k]), dt, x[k])
        ny[k] = fma(fma(0.5 * dt, a_y, vy[k]), dt, y[k])
        nvx[k], nvy[k] = end_x, end_y


@inlined
def step_n(
    state: State,
    scene: Scene,
    vehicles: NDArray[np.float64],
    scratch: Scratch,
    law: tuple[NDArray[Any], float, int, int],
) -> int:
    """Advance the state in place by some steps, and return ``FINE`` or the first bad index.

    Args:
        state: State of the crowd, which is changed.
        scene: Surroundings, routes and desired speeds of the crowd.
        vehicles: Vehicles (m, 7).
        scratch: Memory of a step.
        law: Constants of the model, length dt [s] of a step, number of steps, and the crowd size
            from which neighbours are found by a cell list.
    """
    constants, dt, substeps, cell_list_from = law
    c = constants[0]
    position, velocity, waypoint_index = state
    desired_speed, priority, routes, closed, walls, wall_cells = scene
    rows, index = scratch.rows, scratch.sorting
    n = position.shape[0]
    insane = first_insane(position, velocity)
    if n == 0 or insane != FINE:
        return insane
    relied_on, order = any_priority(priority), index[0]
    for step in range(substeps):
        traffic = Traffic(vehicles, step * dt, relied_on)
        gather_forces(position, velocity, priority, traffic, scratch, constants, cell_list_from)
        ways = order[:n], waypoint_index, routes
        add_walls(rows, n, FX, FY, (walls, wall_cells), ways, c)
        set_targets(rows, order[:n], desired_speed, routes, waypoint_index, closed, c)
        detour(rows, n, vehicles, c)
        _integrate(rows, (n + BLOCK - 1) // BLOCK * BLOCK, dt, c)
        for k in range(n):
            i = order[k]
            position[i, 0], position[i, 1] = rows[NX, k], rows[NY, k]
            velocity[i, 0], velocity[i, 1] = rows[NVX, k], rows[NVY, k]
    return first_insane(position, velocity)


@inlined
def parts(arrays: Arrays) -> tuple[State, Scene, Scratch]:
    """Return by name the arrays that Python passes as one plain tuple."""
    a = borrowed(arrays)
    routes = Routes(a[5], a[6], a[7], a[8])
    scene = Scene(a[3], a[4], routes, a[9], a[10], a[11])
    return State(a[0], a[1], a[2]), scene, Scratch(a[12], a[13], a[14])
