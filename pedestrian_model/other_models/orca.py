"""Optimal reciprocal collision avoidance, for one pedestrian among people, vehicles and a wall.

The method is that of van den Berg, Guy, Lin and Manocha, "Reciprocal n-body collision avoidance"
(Robotics Research, STAR 70, 2011). Two people who would collide within ``tau`` each make half of
the change of velocity that avoids the collision. This permits a half-plane of velocities. An
incremental linear programme finds the permitted velocity closest to the desired one. If none is
permitted, it finds the one with the smallest largest violation. A vehicle does not avoid people:
they make the whole change. It is covered by a row of circles. A wall is a half-plane that is always
kept.

A line is (point, direction). The permitted velocities are on its left.
"""

import math

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import inlined, inner
from pedestrian_model._mathematics import cosine_sine
from pedestrian_model.arrays import FRONT, HEADING, REAR, SPEED, WIDTH, X, Y

Array = NDArray[np.float64]

TAU = 3.0  # time [s] within which people avoid collisions (ours; the paper's scenes have 2 to 10)
_WALL_TAU = 0.5  # time [s] within which nobody may reach a wall (ours)
_NEIGHBOURS = 10  # largest number of people that are considered, the nearest ones
_SIGHT = 10.0  # largest distance [m] of people that are considered
_CIRCLES = 4  # number of circles that cover a vehicle
_VEHICLES = 8  # largest number of vehicles that are considered, the nearest ones
LINES = 1 + _CIRCLES * _VEHICLES + _NEIGHBOURS
_PARALLEL = 1e-9  # cross product of unit vectors below which two lines are parallel


@inlined
def _det(a_x: float, a_y: float, b_x: float, b_y: float) -> float:
    return a_x * b_y - a_y * b_x


@inlined
def _add_line(
    lines: Array,
    at: int,
    circle: tuple[float, float, float],
    relative_velocity: tuple[float, float],
    velocity: tuple[float, float],
    share: float,
    dt: float,
) -> None:
    """Write the line of the half-plane of velocities that avoid a circle.

    Args:
        lines: Lines (LINES, 4), changed.
        at: Row of the new line.
        circle: Centre x, y [m], relative to the person, and radius [m].
        relative_velocity: Velocity [m/s] of the person relative to the circle.
        velocity: Velocity [m/s] of the person.
        share: Share of the change of velocity that the person makes.
        dt: Time step [s].
    """
    (r_x, r_y, radius), (w_x, w_y), (v_x, v_y) = circle, relative_velocity, velocity
    apart, both = r_x * r_x + r_y * r_y, radius * radius
    meets = apart <= both
    per = 1.0 / dt if meets else 1.0 / TAU
    c_x, c_y = w_x - per * r_x, w_y - per * r_y  # from the centre of the circle that cuts off
    length_2 = c_x * c_x + c_y * c_y
    before = c_x * r_x + c_y * r_y
    if meets or (before < 0.0 and before * before > both * length_2):
        length = math.sqrt(length_2)
        n_x, n_y = 1.0, 0.0
        if length > 0.0:
            n_x, n_y = c_x / length, c_y / length
        elif apart > 0.0:
            away = math.sqrt(apart)
            n_x, n_y = -r_x / away, -r_y / away
        d_x, d_y = n_y, -n_x
        u = radius * per - length
        u_x, u_y = u * n_x, u * n_y
    else:
        leg = math.sqrt(apart - both)
        side = 1.0 if _det(r_x, r_y, c_x, c_y) > 0.0 else -1.0
        d_x = side * (r_x * leg - side * r_y * radius) / apart
        d_y = side * (side * r_x * radius + r_y * leg) / apart
        along = w_x * d_x + w_y * d_y
        u_x, u_y = along * d_x - w_x, along * d_y - w_y
    lines[at, 0], lines[at, 1] = v_x + share * u_x, v_y + share * u_y
    lines[at, 2], lines[at, 3] = d_x, d_y


@inlined
def _nearest(found: Array, count: int, most: int, distance: float, which: int) -> int:
    """Insert a neighbour into the sorted list ``found`` (distance, index); return its length."""
    if count == most and distance >= found[count - 1, 0]:
        return count
    place = count if count < most else count - 1
    while place > 0 and found[place - 1, 0] > distance:
        found[place, 0], found[place, 1] = found[place - 1, 0], found[place - 1, 1]
        place -= 1
    found[place, 0], found[place, 1] = distance, which
    return min(count + 1, most)


@inner
def orca_velocity(
    i: int,
    people: tuple[Array, Array],
    preferred: tuple[float, float],
    limits: tuple[float, float],
    obstacles: tuple[Array, tuple[float, float, float]],
    times: tuple[float, float],
    scratch: tuple[Array, Array, Array],
) -> tuple[float, float]:
    """Return the velocity [m/s] that pedestrian i takes.

    Args:
        i: Row of the pedestrian.
        people: Positions [m] and velocities [m/s] of all, (n, 2) each.
        preferred: Velocity [m/s] that the pedestrian prefers.
        limits: Largest speed [m/s] and radius of a body [m].
        obstacles: Vehicles (m, 7), and the nearest wall: distance [m] and normal.
        times: Time [s] since the vehicles were where they are said to be, and the step [s].
        scratch: Lines and projected lines, (LINES, 4) each, and neighbours found, (LINES, 2).
    """
    position, velocity = people
    fastest, radius = limits
    vehicles, wall = obstacles
    travelled, dt = times
    lines, projected, found = scratch
    x, y = position[i, 0], position[i, 1]
    v_x, v_y = velocity[i, 0], velocity[i, 1]
    n = 0
    if wall[0] < np.inf:
        most = -(wall[0] - radius) / _WALL_TAU  # least velocity [m/s] along the normal
        lines[0, 0], lines[0, 1] = most * wall[1], most * wall[2]
        lines[0, 2], lines[0, 3] = wall[2], -wall[1]
        n = 1
    hard = n
    count = 0
    for k in range(vehicles.shape[0]):
        reach = _SIGHT + vehicles[k, FRONT] + vehicles[k, REAR] + TAU * abs(vehicles[k, SPEED])
        away = math.sqrt((vehicles[k, X] - x) ** 2 + (vehicles[k, Y] - y) ** 2)
        if away < reach:
            count = _nearest(found, count, _VEHICLES, away, k)
    for near in range(count):
        vehicle = vehicles[int(found[near, 1])]
        c, s = cosine_sine(vehicle[HEADING])
        part = (vehicle[FRONT] + vehicle[REAR]) / _CIRCLES
        circle = 0.5 * math.sqrt(part * part + vehicle[WIDTH] * vehicle[WIDTH]) + radius
        for j in range(_CIRCLES):
            ahead = (j + 0.5) * part - vehicle[REAR] + travelled * vehicle[SPEED]
            r_x, r_y = vehicle[X] + ahead * c - x, vehicle[Y] + ahead * s - y
            w_x, w_y = v_x - vehicle[SPEED] * c, v_y - vehicle[SPEED] * s
            _add_line(lines, n, (r_x, r_y, circle), (w_x, w_y), (v_x, v_y), 1.0, dt)
            n += 1
    count = 0
    for j in range(position.shape[0]):
        away = math.sqrt((position[j, 0] - x) ** 2 + (position[j, 1] - y) ** 2)
        if j != i and away < _SIGHT:
            count = _nearest(found, count, _NEIGHBOURS, away, j)
    for near in range(count):
        j = int(found[near, 1])
        r_x, r_y = position[j, 0] - x, position[j, 1] - y
        if r_x == 0.0 and r_y == 0.0:  # two people in one place separate by their order
            r_x = math.copysign(1e-9, j - i)
        w_x, w_y = v_x - velocity[j, 0], v_y - velocity[j, 1]
        _add_line(lines, n, (r_x, r_y, 2.0 * radius), (w_x, w_y), (v_x, v_y), 0.5, dt)
        n += 1
    p_x, p_y = preferred
    pace = math.sqrt(p_x * p_x + p_y * p_y)
    if pace > fastest:
        p_x, p_y = p_x * fastest / pace, p_y * fastest / pace
    failed, o_x, o_y = _closest(lines, n, fastest, p_x, p_y, False)
    if failed < n:
        return _least_broken(lines, n, (hard, failed), fastest, (o_x, o_y), projected)
    return o_x, o_y


@inner
def _closest(
    lines: Array, n: int, fastest: float, p_x: float, p_y: float, furthest: bool
) -> tuple[int, float, float]:
    """Return the permitted velocity closest to p, or furthest along the unit vector p.

    Returns:
        n, or the first line with which no velocity is permitted; velocity x, y [m/s], in that case
        the permitted one before this line.
    """
    o_x, o_y = (fastest * p_x, fastest * p_y) if furthest else (p_x, p_y)
    for i in range(n):
        q_x, q_y, d_x, d_y = lines[i, 0], lines[i, 1], lines[i, 2], lines[i, 3]
        if _det(d_x, d_y, q_x - o_x, q_y - o_y) <= 0.0:
            continue
        middle = q_x * d_x + q_y * d_y
        inside = middle * middle + fastest * fastest - q_x * q_x - q_y * q_y
        if inside < 0.0:
            return i, o_x, o_y
        half = math.sqrt(inside)
        low, high = -middle - half, half - middle
        for j in range(i):
            across = _det(d_x, d_y, lines[j, 2], lines[j, 3])
            beyond = _det(lines[j, 2], lines[j, 3], q_x - lines[j, 0], q_y - lines[j, 1])
            if abs(across) <= _PARALLEL:
                if beyond < 0.0:
                    return i, o_x, o_y
                continue
            if across > 0.0:
                high = min(high, beyond / across)
            else:
                low = max(low, beyond / across)
            if low > high:
                return i, o_x, o_y
        t = d_x * (p_x - q_x) + d_y * (p_y - q_y)
        if furthest:
            t = high if p_x * d_x + p_y * d_y > 0.0 else low
        t = min(max(t, low), high)
        o_x, o_y = q_x + t * d_x, q_y + t * d_y
    return n, o_x, o_y


@inner
def _least_broken(
    lines: Array,
    n: int,
    hard_and_failed: tuple[int, int],
    fastest: float,
    best: tuple[float, float],
    projected: Array,
) -> tuple[float, float]:
    """Return the velocity with the smallest largest violation of the half-planes.

    The hard half-planes are kept.
    """
    (hard, first), (o_x, o_y) = hard_and_failed, best
    deepest = 0.0
    for i in range(first, n):
        q_x, q_y, d_x, d_y = lines[i, 0], lines[i, 1], lines[i, 2], lines[i, 3]
        if _det(d_x, d_y, q_x - o_x, q_y - o_y) <= deepest:
            continue
        projected[:hard] = lines[:hard]
        m = hard
        for j in range(hard, i):
            across = _det(d_x, d_y, lines[j, 2], lines[j, 3])
            if abs(across) <= _PARALLEL:
                if d_x * lines[j, 2] + d_y * lines[j, 3] > 0.0:
                    continue
                projected[m, 0] = 0.5 * (q_x + lines[j, 0])
                projected[m, 1] = 0.5 * (q_y + lines[j, 1])
            else:
                t = _det(lines[j, 2], lines[j, 3], q_x - lines[j, 0], q_y - lines[j, 1]) / across
                projected[m, 0], projected[m, 1] = q_x + t * d_x, q_y + t * d_y
            e_x, e_y = lines[j, 2] - d_x, lines[j, 3] - d_y
            length = math.sqrt(e_x * e_x + e_y * e_y)
            projected[m, 2], projected[m, 3] = e_x / length, e_y / length
            m += 1
        done, b_x, b_y = _closest(projected, m, fastest, -d_y, d_x, True)
        if done == m:
            o_x, o_y = b_x, b_y
        deepest = _det(d_x, d_y, q_x - o_x, q_y - o_y)
    return o_x, o_y
