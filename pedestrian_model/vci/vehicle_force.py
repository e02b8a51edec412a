"""The force of vehicles on pedestrians, by the distance to a contour that grows with speed.

The contour in the vehicle's frame (X forward) has a rear face, two sides, and a nose of two slanted
edges from the shoulders (X_s, +-h) to the tip (X_s + alpha_x |u|, 0). Below ``static_speed`` the
nose is flat and the contour is a rectangle. The form is that of TSAS 2020. The rectangle, and the
vehicle as a potential field that changes with its speed, are those of Yang & Özgüner 2019.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import fma, inlined, inner
from pedestrian_model._mathematics import cosine_sine, exponential
from pedestrian_model.arrays import FRONT, HEADING, REAR, SPEED, WIDTH, X, Y
from pedestrian_model.vci.buffers import BLOCK, PRIORITY, PX, PY, VFX, VFY, VX, VY, S
from pedestrian_model.vci.pairs.cell_list import Grid, Strips
from pedestrian_model.vci.priority import felt, place_of_full_force

#: Force [N] of a vehicle below which it is left out, if there are many vehicles.
LEAST_FORCE = 1e-9
_MANY = 5  # number of vehicles from which on small forces are left out

_ABSURD = 1e15  # extent [cells] that only a vehicle with values that are not finite has
_LEAST_EXPONENT = -700.0  # least exponent without underflow


class Contour(NamedTuple):
    """A contour in the vehicle's frame, X along the direction in which the nose points."""

    X_r: float  # X [m] of the rear face
    X_s: float  # X [m] of the shoulders
    tip: float  # X [m] of the tip of the nose
    h: float  # half width [m]
    edge: float  # length [m] of a slanted edge, from shoulder to tip
    N_x: float  # outward normal of the left slanted edge
    N_y: float


@inlined
def _contour(vehicle: NDArray[np.float64], c: Any) -> Contour:
    """Return the contour of a vehicle. Below the static speed it is a rectangle."""
    u, front, rear = vehicle[SPEED], vehicle[FRONT], vehicle[REAR]
    if u < 0.0:
        front, rear = rear, front
    nose, dx0 = c.alpha_x * abs(u), c.dx0
    if abs(u) < c.u_static:
        nose, dx0 = 0.0, 0.0
    X_s, h = front + c.le + dx0, vehicle[WIDTH] / 2.0 + c.le
    edge = math.sqrt(nose * nose + h * h)
    return Contour(-(rear + c.le), X_s, X_s + nose, h, edge, h / edge, nose / edge)


@inlined
def _influence(X: float, lateral: float, q: Contour) -> tuple[float, float, float]:
    """Return the signed distance [m] to the contour's influence point, and the outward unit vector.

    If the influence point is a corner or on the rear face, the unit vector points from it to the
    person. Otherwise it is the normal of the edge, which is also used inside of the contour and at
    a distance of zero.

    Args:
        X: Coordinate [m] of the person along the nose.
        lateral: Absolute lateral coordinate [m] of the person.
        q: Contour of the vehicle.
    """
    behind = q.X_r > X
    beyond = q.X_s <= X
    along = fma(X - q.X_s, q.N_y, -((lateral - q.h) * q.N_x))  # from the shoulder to the tip
    on_edge = (along >= 0.0) & (along <= q.edge)
    q_x = q.X_r if behind else (q.X_s if along < 0.0 else q.tip)
    q_y = min(lateral, q.h) if behind else (q.h if along < 0.0 else 0.0)
    to_x, to_y = X - q_x, lateral - q_y
    distance = math.sqrt(fma(to_x, to_x, to_y * to_y))
    inverse = 1.0 / distance
    from_point = (behind | (beyond & (not on_edge))) & (distance > 0.0)
    normal_x = q.N_x if beyond else 0.0
    normal_y = q.N_y if beyond else 1.0
    plane = fma(X - q.X_s, normal_x, (lateral - q.h) * normal_y)
    return (
        distance if from_point else plane,
        to_x * inverse if from_point else normal_x,
        to_y * inverse if from_point else normal_y,
    )


class _Vehicle(NamedTuple):
    """A vehicle at an instant, as its force needs it."""

    place: tuple[float, float]  # reference point [m]
    heading: tuple[float, float]  # cosine and sine of the heading
    nose: tuple[float, float]  # direction of the nose, which points backwards in reverse
    velocity: tuple[float, float]  # velocity [m/s] for the angle of its force
    contour: Contour


class Traffic(NamedTuple):
    """The vehicles among the people in one step."""

    vehicles: NDArray[np.float64]  # vehicles (m, 7)
    travelled: float  # time [s] for which they have driven straight on since
    relied_on: bool  # whether anybody has priority; if not, its row is not filled


class _Law(NamedTuple):
    """The constants of fexp(s - R; A, b) As(phi_v; l_v)."""

    R: float
    A: float
    b: float
    a_v: float
    b_v: float
    cap: float


@inlined
def _force(
    x: float, y: float, vx: float, vy: float, v: _Vehicle, law: _Law
) -> tuple[float, float, float, float]:
    """Return f_v [N] on one person, the signed distance [m] to the contour, and X [m].

    X is the coordinate of the person along the nose.
    """
    (x_v, y_v), (cos, sin), (nose_x, nose_y), (u_x, u_y) = v.place, v.heading, v.nose, v.velocity
    dx, dy = x - x_v, y - y_v
    across = fma(cos, dy, -(sin * dx))
    X = fma(nose_x, dx, nose_y * dy)
    s, e_x, e_y = _influence(X, abs(across), v.contour)
    e_y = e_y if across >= 0.0 else -e_y
    # As(phi_v; l_v) between the direction to the vehicle and the velocity relative to it
    w_x, w_y = vx - u_x, vy - u_y
    lengths = math.sqrt(fma(dx, dx, dy * dy) * fma(w_x, w_x, w_y * w_y))
    cosine = -fma(dx, w_x, dy * w_y) / lengths
    cosine = min(1.0, max(-1.0, cosine)) if lengths > 0.0 else 1.0  # 1 without relative motion
    anisotropy = 1.0 if s < law.R else fma(law.b_v, cosine, law.a_v)
    # fexp(s - R; A, b) As(phi_v; l_v) e
    exponent = max(min(-law.b * (s - law.R), law.cap), _LEAST_EXPONENT)
    f = law.A * exponential(exponent) * anisotropy
    f_x = f * fma(e_x, nose_x, -(e_y * sin))
    return f_x, f * fma(e_x, nose_y, e_y * cos), s, X


@inlined
def add_vehicle(
    rows: NDArray[np.float64],
    start: int,
    stop: int,
    vehicle: NDArray[np.float64],
    travelled: float,
    relied_on: bool,
    c: Any,
) -> None:
    """Add one vehicle's force f_v to the rows start ... stop - 1, and update their distances.

    Args:
        rows: Rows of the workspace, changed.
        start: First row.
        stop: Last row plus one, dummies included.
        vehicle: Columns (7,) of the vehicle.
        travelled: Time [s] for which the vehicle has driven straight on since.
        relied_on: Whether anybody has priority. If not, the row of priorities is not read.
        c: Constants of the model.
    """
    cos, sin = cosine_sine(vehicle[HEADING])
    u = vehicle[SPEED]
    u_x, u_y = u * cos, u * sin
    x_v, y_v = vehicle[X] + travelled * u_x, vehicle[Y] + travelled * u_y
    if abs(u) < c.u_angle:
        u_x, u_y = 0.0, 0.0
    # The contour is mirrored in reverse, with its nose backwards.
    nose = (-cos, -sin) if u < 0.0 else (cos, sin)
    v = _Vehicle((x_v, y_v), (cos, sin), nose, (u_x, u_y), _contour(vehicle, c))
    law = _Law(c.R, c.A, c.b, c.a_v, c.b_v, c.cap)
    x, y, vx, vy = (
        rows[PX, start:stop],
        rows[PY, start:stop],
        rows[VX, start:stop],
        rows[VY, start:stop],
    )
    f_x, f_y, s_min = rows[VFX, start:stop], rows[VFY, start:stop], rows[S, start:stop]
    if relied_on:
        priority = rows[PRIORITY, start:stop]
        full = place_of_full_force(vehicle[REAR] if u < 0.0 else vehicle[FRONT], u)
        for k in range(stop - start):
            one_x, one_y, s, ahead = _force(x[k], y[k], vx[k], vy[k], v, law)
            share = felt(ahead, full, priority[k])
            f_x[k] += share * one_x
            f_y[k] += share * one_y
            s_min[k] = min(s_min[k], s)
        return
    for k in range(stop - start):
        one_x, one_y, s, _ = _force(x[k], y[k], vx[k], vy[k], v, law)
        f_x[k] += one_x
        f_y[k] += one_y
        s_min[k] = min(s_min[k], s)


@inlined
def add_vehicles(rows: NDArray[np.float64], n: int, traffic: Traffic, c: Any) -> None:
    """Add the forces of all vehicles to the first n rows, up to whole blocks."""
    vehicles, travelled, relied_on = traffic
    padded = (n + BLOCK - 1) // BLOCK * BLOCK
    for v in range(vehicles.shape[0]):
        add_vehicle(rows, 0, padded, vehicles[v], travelled, relied_on, c)


@inner
def add_near_vehicles(
    rows: NDArray[np.float64],
    first: NDArray[np.int64],
    grid: Grid,
    n: int,
    traffic: Traffic,
    constants: NDArray[Any],
) -> None:
    """Add the forces of vehicles to the rows within their reach, sorted by the cells of ``grid``.

    People out of a vehicle's reach are left out strip by strip, by a box around its contour. With
    few vehicles nobody is left out, so that the size of a crowd does not change the last bits of
    the forces.
    """
    if traffic.vehicles.shape[0] < _MANY:
        add_vehicles(rows, n, traffic, constants[0])
    else:
        _add_to_strips(rows, first, Strips(grid, 0, grid.strips), traffic, constants)


@inlined
def add_vehicles_to_strips(
    rows: NDArray[np.float64],
    first: NDArray[np.int64],
    strips: Strips,
    traffic: Traffic,
    constants: NDArray[Any],
) -> None:
    """Add the forces of vehicles as ``add_near_vehicles`` does, to some strips only."""
    vehicles, travelled, relied_on = traffic
    if vehicles.shape[0] < _MANY:
        columns = strips.grid.columns
        start, stop = first[strips.begin * columns], first[strips.end * columns]
        for v in range(vehicles.shape[0]):
            add_vehicle(rows, start, stop, vehicles[v], travelled, relied_on, constants[0])
    else:
        _add_to_strips(rows, first, strips, traffic, constants)


@inlined
def _add_to_strips(
    rows: NDArray[np.float64],
    first: NDArray[np.int64],
    strips: Strips,
    traffic: Traffic,
    constants: NDArray[Any],
) -> None:
    """Add the forces of vehicles to the rows of some strips that are within their reach."""
    c = constants[0]
    grid, begin_strip, end_strip = strips
    vehicles, travelled, relied_on = traffic
    for v in range(vehicles.shape[0]):
        cos, sin = cosine_sine(vehicles[v, HEADING])
        u = vehicles[v, SPEED]
        contour = _contour(vehicles[v], c)
        middle, half = (contour.tip + contour.X_r) / 2.0, (contour.tip - contour.X_r) / 2.0
        middle = -middle if u < 0.0 else middle
        x = vehicles[v, X] + (travelled * u + middle) * cos - grid.x_0
        y = vehicles[v, Y] + (travelled * u + middle) * sin - grid.y_0
        half_x = abs(cos) * half + abs(sin) * contour.h + c.reach
        half_y = abs(sin) * half + abs(cos) * contour.h + c.reach
        left, right = (x - half_x) * grid.per_x, (x + half_x) * grid.per_x
        low, high = (y - half_y) * grid.per_y, (y + half_y) * grid.per_y
        if right < 0.0 or left >= grid.columns or high < 0.0 or low >= grid.strips:
            continue
        if not right - left + high - low < _ABSURD:  # a vehicle that is not finite reaches all
            all_from, all_to = first[begin_strip * grid.columns], first[end_strip * grid.columns]
            add_vehicle(rows, all_from, all_to, vehicles[v], travelled, relied_on, c)
            continue
        begin, end = max(int(left), 0), min(int(right), grid.columns - 1)
        for strip in range(max(int(low), begin_strip), min(int(high), end_strip - 1) + 1):
            base = strip * grid.columns
            start, stop = first[base + begin], first[base + end + 1]
            if start < stop:
                add_vehicle(rows, start, stop, vehicles[v], travelled, relied_on, c)
