"""One step of the crowd, and N steps ahead: the compiled entry points."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from pedestrian_model._cells import add_near_pairs
from pedestrian_model._detour import detour
from pedestrian_model._jit import fma, inlined, kernel
from pedestrian_model._mathematics import cosine_sine
from pedestrian_model._ring import add_all_pairs
from pedestrian_model._routes import Routes, set_targets
from pedestrian_model._rows import (
    FX,
    FY,
    LARGEST_RING,
    NVX,
    NVY,
    NX,
    NY,
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
)
from pedestrian_model._vehicles import HEADING, SPEED, X, Y, add_near_vehicles, add_vehicles
from pedestrian_model._walls import add_walls

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

#: The result of a step that went well; otherwise the index of the offending pedestrian.
FINE = -1
_SANE = 1e12  # [m], [m/s] beyond, a state counts as diverged (and could not be sorted by cell)


@inlined
def first_insane(position: NDArray[np.float64], velocity: NDArray[np.float64]) -> int:
    """The first pedestrian whose state is not finite (or absurd), or ``FINE``."""
    for i in range(position.shape[0]):
        largest = abs(position[i, 0]) + abs(position[i, 1])
        if not largest + abs(velocity[i, 0]) + abs(velocity[i, 1]) <= _SANE:
            return i
    return FINE


@inlined
def gather_forces(
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
    vehicles: NDArray[np.float64],
    travelled: float,
    rows: NDArray[np.float64],
    index: NDArray[np.int64],
    buffer: NDArray[np.float64],
    back: NDArray[np.float64],
    constants: NDArray[Any],
    cell_list_from: int,
) -> None:
    """Fill the rows and their pair and vehicle forces from the state."""
    n = position.shape[0]
    if n >= cell_list_from or n > LARGEST_RING:
        grid = add_near_pairs(rows, index, buffer, position, velocity, constants)
        add_near_vehicles(rows, index[2], grid, n, vehicles, travelled, constants)
    else:
        add_all_pairs(rows, index, buffer, back, position, velocity, constants)
        add_vehicles(rows, n, vehicles, travelled, constants[0])


@inlined
def _integrate(rows: NDArray[np.float64], n: int, dt: float, c: Any) -> None:
    """The next state of the first n rows: total force, limits, synchronous update."""
    m, k_des, F_2, inverse_F = c.m, c.k_des, c.F_2, c.inverse_F
    most, v_max = c.m * c.a_max, c.v_max
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
        # at most m a_max
        F = math.sqrt(fma(F_x, F_x, F_y * F_y))
        scale = most / F if most < F else 1.0
        a_x, a_y = F_x * scale / m, F_y * scale / m
        # at most v_max at the end of the step
        end_x, end_y = fma(a_x, dt, vx[k]), fma(a_y, dt, vy[k])
        speed = math.sqrt(fma(end_x, end_x, end_y * end_y))
        slower = v_max / speed if speed > v_max else 1.0
        end_x, end_y = end_x * slower, end_y * slower
        a_x = (end_x - vx[k]) / dt if speed > v_max else a_x
        a_y = (end_y - vy[k]) / dt if speed > v_max else a_y
        nx[k] = fma(fma(0.5 * dt, a_x, vx[k]), dt, x[k])
        ny[k] = fma(fma(0.5 * dt, a_y, vy[k]), dt, y[k])
        nvx[k], nvy[k] = end_x, end_y


@kernel
def advance(
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
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
    buffer: NDArray[np.float64],
    back: NDArray[np.float64],
    constants: NDArray[Any],
    dt: float,
    substeps: int,
    cell_list_from: int,
) -> int:
    """Advance the state in place by ``substeps`` steps of dt; ``FINE`` or the first bad index."""
    c = constants[0]
    n = position.shape[0]
    insane = first_insane(position, velocity)
    if n == 0 or insane != FINE:
        return insane
    routes = Routes(waypoints, passage, signal, waypoint_start)
    for step in range(substeps):
        gather_forces(
            position,
            velocity,
            vehicles,
            step * dt,
            rows,
            index,
            buffer,
            back,
            constants,
            cell_list_from,
        )
        order = index[0]
        add_walls(rows, n, FX, FY, walls, wall_cells, c)
        set_targets(rows, order, desired_speed, routes, waypoint_index, closed, c)
        detour(rows, n, vehicles, c)
        _integrate(rows, n, dt, c)
        for k in range(n):
            i = order[k]
            position[i, 0], position[i, 1] = rows[NX, k], rows[NY, k]
            velocity[i, 0], velocity[i, 1] = rows[NVX, k], rows[NVY, k]
    return first_insane(position, velocity)


@kernel
def predict(
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
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
    state: NDArray[np.float64],
    reached: NDArray[np.int64],
    rows: NDArray[np.float64],
    index: NDArray[np.int64],
    buffer: NDArray[np.float64],
    back: NDArray[np.float64],
    constants: NDArray[Any],
    dt: float,
    substeps: int,
    cell_list_from: int,
    out: NDArray[np.float64],
) -> int:
    """Fill ``out`` (N, n, 2) with the positions of the next N steps; the state stays as it is.

    ``vehicles`` is (N, m, 7); ``state`` (2, n, 2) and ``reached`` (n,) are scratch.
    """
    n = position.shape[0]
    x, v = state[0], state[1]
    for i in range(n):
        x[i, 0], x[i, 1] = position[i, 0], position[i, 1]
        v[i, 0], v[i, 1] = velocity[i, 0], velocity[i, 1]
        reached[i] = waypoint_index[i]
    for k in range(out.shape[0]):
        insane = advance(
            x,
            v,
            desired_speed,
            waypoints,
            passage,
            signal,
            waypoint_start,
            reached,
            vehicles[k],
            closed,
            walls,
            wall_cells,
            rows,
            index,
            buffer,
            back,
            constants,
            dt,
            substeps,
            cell_list_from,
        )
        if insane != FINE:
            return insane
        for i in range(n):
            out[k, i, 0], out[k, i, 1] = x[i, 0], x[i, 1]
    return FINE


@kernel
def extrapolate(vehicles: NDArray[np.float64], time_step: float, out: NDArray[np.float64]) -> None:
    """Fill ``out`` (N, m, 7) with the poses at 0 ... N - 1 steps of straight, constant speed."""
    for v in range(vehicles.shape[0]):
        cos, sin = cosine_sine(vehicles[v, HEADING])
        u = vehicles[v, SPEED]
        for k in range(out.shape[0]):
            for column in range(7):
                out[k, v, column] = vehicles[v, column]
            out[k, v, X] += k * time_step * (u * cos)
            out[k, v, Y] += k * time_step * (u * sin)
