"""The detour around a standing car: one of its corners becomes the next target.

Without a detour, a person who walks into the side of a standing car is pushed straight back and
never gets past it: a local minimum of the force field. All of this file is giveway's own.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import inlined, inner
from pedestrian_model._mathematics import cosine_sine
from pedestrian_model.arrays import FRONT, HEADING, REAR, SPEED, WIDTH, X, Y
from pedestrian_model.vci.buffers import NVX, NX, NY, PX, PY, TX, TY

_TOUCH = 1e-9  # tolerance [m], so that a path along the obstacle's edge does not cross it
_TOGETHER = 32  # number of rows that are examined together
_ENTRY, _CORNER_X, _CORNER_Y = NVX, NX, NY  # rows that are free until the step is integrated
_CLEAR = 2.0  # entry parameter of a segment that does not cross the box


class _Box(NamedTuple):
    """A rectangle (low, high) x (-half, half) in a vehicle's frame [m]."""

    low: float
    high: float
    half: float


@inlined
def _grown(box: _Box, by: float) -> _Box:
    """Return the box with ``by`` [m] more on each side."""
    return _Box(box.low - by, box.high + by, box.half + by)


@inlined
def _entry(x: float, y: float, dx: float, dy: float, box: _Box) -> float:
    """Return the parameter in [0, 1] at which a segment enters the open box, or 2.

    The segment leads from (x, y) to (x + dx, y + dy).
    """
    enter, leave = 0.0, 1.0
    low, high, h = box
    for axis in range(2):
        p, d, a, b = (x, dx, low, high) if axis == 0 else (y, dy, -h, h)
        if d == 0.0:
            if p <= a or p >= b:
                return _CLEAR
        else:
            first, second = (a - p) / d, (b - p) / d
            enter = max(enter, min(first, second))
            leave = min(leave, max(first, second))
    return enter if enter < leave else _CLEAR


@inlined
def _outside(x: float, y: float, box: _Box) -> float:
    """Return the distance (maximum norm) of a point from the box, which is negative inside."""
    return max(max(box.low - x, x - box.high), abs(y) - box.half)


@inlined
def _length(dx: float, dy: float) -> float:
    """Return the Euclidean length, without libm's hypot."""
    return math.sqrt(dx * dx + dy * dy)


@inlined
def _corner(k: int, box: _Box) -> tuple[float, float]:
    """Return corner k of a box, 0 ... 3, counter-clockwise from (high, half)."""
    return (box.high if k == 0 or k == 3 else box.low), (box.half if k < 2 else -box.half)


@inner
def _way_round(
    place: tuple[float, float], target: tuple[float, float], box: _Box, margin: float, radius: float
) -> tuple[float, float]:
    """Return the first corner of the shortest path around a box from a place to a target.

    All coordinates are in the vehicle's frame. The corners are those of the box grown by
    ``margin``. For a person who stands closer, or whose target is closer, the obstacle is a box
    grown by less. A corner within ``radius`` counts as passed.
    """
    (x, y), (x_p, y_p) = place, target
    closest = min(_outside(x, y, box), _outside(x_p, y_p, box))
    seen, corners = _grown(box, min(margin, closest) - _TOUCH), _grown(box, margin)
    best, best_x, best_y = math.inf, x_p, y_p
    for turn in (1, 3):  # counter-clockwise, clockwise
        for first in range(4):
            c_x, c_y = _corner(first, corners)
            if _entry(x, y, c_x - x, c_y - y, seen) < _CLEAR:
                continue
            length = _length(c_x - x, c_y - y)
            near = length < radius
            next_x, next_y = c_x, c_y
            corner = first
            for legs in range(4):
                if _entry(c_x, c_y, x_p - c_x, y_p - c_y, seen) == _CLEAR:
                    length += _length(x_p - c_x, y_p - c_y)
                    if near and legs == 0:
                        next_x, next_y = x_p, y_p
                    break
                corner = (corner + turn) % 4
                d_x, d_y = _corner(corner, corners)
                length += _length(d_x - c_x, d_y - c_y)
                c_x, c_y = d_x, d_y
                if near and legs == 0:
                    next_x, next_y = c_x, c_y
            if length < best:
                best, best_x, best_y = length, next_x, next_y
    return best_x, best_y


@inlined
def _look_ahead(
    rows: NDArray[np.float64], start: int, stop: int, vehicle: NDArray[np.float64], c: Any
) -> None:
    """Set the corners around a vehicle for the rows start ... stop - 1, if it is the first hit."""
    reach = vehicle[FRONT] + vehicle[REAR] + vehicle[WIDTH] + 2.0 * c.detour
    v_x, v_y = vehicle[X], vehicle[Y]
    cos, sin = cosine_sine(vehicle[HEADING])
    box = _Box(-vehicle[REAR], vehicle[FRONT], vehicle[WIDTH] / 2.0)
    for k in range(start, stop):
        x, y, x_p, y_p = rows[PX, k], rows[PY, k], rows[TX, k], rows[TY, k]
        if min(x, x_p) > v_x + reach or max(x, x_p) < v_x - reach:
            continue
        if min(y, y_p) > v_y + reach or max(y, y_p) < v_y - reach:
            continue
        at_x, at_y = cos * (x - v_x) + sin * (y - v_y), cos * (y - v_y) - sin * (x - v_x)
        to_x = cos * (x_p - v_x) + sin * (y_p - v_y)
        to_y = cos * (y_p - v_y) - sin * (x_p - v_x)
        room = min(_outside(at_x, at_y, box), _outside(to_x, to_y, box))
        if room <= 0.0:
            continue  # without a detour if the person or the target is inside the car
        seen = _grown(box, min(room, c.detour) - _TOUCH)
        entry = _entry(at_x, at_y, to_x - at_x, to_y - at_y, seen)
        if entry < rows[_ENTRY, k]:
            q_x, q_y = _way_round((at_x, at_y), (to_x, to_y), box, c.detour, c.r_waypoint)
            rows[_ENTRY, k] = entry
            rows[_CORNER_X, k] = v_x + cos * q_x - sin * q_y
            rows[_CORNER_Y, k] = v_y + sin * q_x + cos * q_y


@inlined
def detour(rows: NDArray[np.float64], n: int, vehicles: NDArray[np.float64], c: Any) -> None:
    """Replace the targets behind a standing vehicle by corners of its grown rectangle.

    Rows are examined in groups. If they are sorted by cell, a group consists of neighbours, and
    most vehicles are far from all of them.
    """
    standing = False
    for v in range(vehicles.shape[0]):
        standing |= abs(vehicles[v, SPEED]) < c.u_detour
    if not standing:
        return
    for start in range(0, n, _TOGETHER):
        stop = min(start + _TOGETHER, n)
        x_0, x_1, y_0, y_1 = math.inf, -math.inf, math.inf, -math.inf
        for k in range(start, stop):
            x_0, x_1 = min(x_0, rows[PX, k], rows[TX, k]), max(x_1, rows[PX, k], rows[TX, k])
            y_0, y_1 = min(y_0, rows[PY, k], rows[TY, k]), max(y_1, rows[PY, k], rows[TY, k])
            rows[_ENTRY, k] = _CLEAR
        for v in range(vehicles.shape[0]):
            if abs(vehicles[v, SPEED]) >= c.u_detour:
                continue
            reach = vehicles[v, FRONT] + vehicles[v, REAR] + vehicles[v, WIDTH] + 2.0 * c.detour
            v_x, v_y = vehicles[v, X], vehicles[v, Y]
            if x_0 > v_x + reach or x_1 < v_x - reach or y_0 > v_y + reach or y_1 < v_y - reach:
                continue
            _look_ahead(rows, start, stop, vehicles[v], c)
        for k in range(start, stop):
            if rows[_ENTRY, k] < _CLEAR:
                rows[TX, k], rows[TY, k] = rows[_CORNER_X, k], rows[_CORNER_Y, k]
