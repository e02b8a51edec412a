"""Where a route leads next: way-points hit or lines crossed, signals waited at, the last kept.

A way-point is passed within a radius. With a passage it is a line as well, across the way: who
crosses the line within its half-width has passed, and who has not yet walks to the nearest point
of the line, so that a crowd goes through side by side instead of through one point. All ours.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import inlined
from pedestrian_model._rows import PX, PY, SOFT, TX, TY, V0

# [m^2] instead of s_des^2 towards a way-point at which nobody stops: 1 um, against 0/0 only
_NO_SLOWING = 1e-12


class Routes(NamedTuple):
    """The routes of a crowd, as in ``Crowd``."""

    waypoints: NDArray[np.float64]  # (total, 2) [m]
    passage: NDArray[np.float64]  # (total, 3) unit direction, half-width [m]; 0: none
    signal: NDArray[np.int64]  # (total,) index into ``closed``; -1: none
    start: NDArray[np.int64]  # (n + 1,) offsets


class Line(NamedTuple):
    """A way-point and its passage: scalars, because passing arrays about costs a count of each."""

    x: float  # [m]
    y: float
    d_x: float  # unit direction
    d_y: float
    half: float  # [m] half-width, 0: a point only


@inlined
def aim(x: float, y: float, p: Line, R: float) -> tuple[float, float]:
    """The nearest point to (x, y) of a line, R inside its ends if it can be."""
    if p.half <= 0.0:
        return p.x, p.y
    room = max(p.half - R, 0.0)
    lateral = min(max(p.d_x * (y - p.y) - p.d_y * (x - p.x), -room), room)
    return p.x - lateral * p.d_y, p.y + lateral * p.d_x


@inlined
def is_passed(x: float, y: float, p: Line, radius: float) -> bool:
    """Whether (x, y) is within ``radius`` of the way-point, or beyond its line where that is."""
    dx, dy = x - p.x, y - p.y
    if dx * dx + dy * dy <= radius * radius:
        return True
    along, across = p.d_x * dx + p.d_y * dy, p.d_x * dy - p.d_y * dx
    return p.half > 0.0 and along >= 0.0 and abs(across) <= p.half


@inlined
def heading_for(
    x: float,
    y: float,
    at: int,
    last: int,
    routes: Any,
    closed: NDArray[np.bool_],
    radius: float,
    R: float,
) -> tuple[int, bool, float, float]:
    """Which way-point is next for somebody at (x, y), whether to stop there, and where it is.

    ``at`` was the next one so far, ``last`` ends the way; ``routes`` are the arrays of ``Routes``.
    """
    w, q, signal = routes[0], routes[1], routes[2]
    stops = True
    p = Line(w[at, 0], w[at, 1], q[at, 0], q[at, 1], q[at, 2])
    while at < last and not (signal[at] >= 0 and closed[signal[at]]):
        if not is_passed(x, y, p, radius):
            stops = False
            break
        at += 1
        p = Line(w[at, 0], w[at, 1], q[at, 0], q[at, 1], q[at, 2])
    to_x, to_y = aim(x, y, p, R)
    return at, stops, to_x, to_y


@inlined
def set_targets(
    rows: NDArray[np.float64],
    order: NDArray[np.int64],
    desired_speed: NDArray[np.float64],
    routes: Routes,
    waypoint_index: NDArray[np.int64],
    closed: NDArray[np.bool_],
    c: Any,
) -> None:
    """Pass the way-points reached (not the last, none that is closed); targets into the rows.

    The destination force fades towards a way-point at which somebody stops: the last, or one
    whose signal is closed. Towards all others people walk at their desired speed (ours: with the
    fading everywhere, way-points 2 m apart cost a quarter of it, 5 m apart an eighth).
    """
    n = desired_speed.shape[0]
    set_targets_of(n, rows, order, desired_speed, routes, waypoint_index, closed, c)


@inlined
def set_targets_of(
    n: int,
    rows: NDArray[np.float64],
    order: NDArray[np.int64],
    desired_speed: NDArray[np.float64],
    routes: Routes,
    waypoint_index: NDArray[np.int64],
    closed: NDArray[np.bool_],
    c: Any,
) -> None:
    """As ``set_targets``, for the first n rows."""
    start = routes.start
    for k in range(n):
        i = order[k]
        at, stops, to_x, to_y = heading_for(
            rows[PX, k],
            rows[PY, k],
            start[i] + waypoint_index[i],
            start[i + 1] - 1,
            routes,
            closed,
            c.r_waypoint,
            c.R,
        )
        waypoint_index[i] = at - start[i]
        rows[TX, k], rows[TY, k] = to_x, to_y
        rows[V0, k] = desired_speed[i]
        rows[SOFT, k] = c.s_des_2 if stops else _NO_SLOWING
