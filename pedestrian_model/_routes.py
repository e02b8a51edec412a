"""Where a route leads next: way-points hit or lines crossed, signals waited at, the last kept.

A way-point is passed within a radius. With a passage it is a line as well, across the way: who
crosses the line within its half-width has passed, and who has not yet walks to the nearest point
of the line, so that a crowd goes through side by side instead of through one point. All ours.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from pedestrian_model._jit import inlined, kernel
from pedestrian_model._rows import PX, PY, SOFT, TX, TY, V0

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    #: ``Routes`` as the kernels take it from outside: numba recognises a plain tuple faster.
    RouteArrays = tuple[
        NDArray[np.float64], NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]
    ]

# [m^2] instead of s_des^2 towards a way-point at which nobody stops: 1 um, against 0/0 only
_NO_SLOWING = 1e-12


class Routes(NamedTuple):
    """The routes of a crowd, as in ``Crowd``."""

    waypoints: NDArray[np.float64]  # (total, 2) [m]
    passage: NDArray[np.float64]  # (total, 3) unit direction, half-width [m]; 0: none
    signal: NDArray[np.int64]  # (total,) index into ``closed``; -1: none
    start: NDArray[np.int64]  # (n + 1,) offsets


@inlined
def _aim(x: float, y: float, at: int, routes: Routes, R: float) -> tuple[float, float]:
    """The nearest point to (x, y) of the line of way-point ``at``, R inside its ends if it can."""
    x_p, y_p = routes.waypoints[at, 0], routes.waypoints[at, 1]
    half = routes.passage[at, 2]
    if half > 0.0:
        room = max(half - R, 0.0)
        d_x, d_y = routes.passage[at, 0], routes.passage[at, 1]
        lateral = min(max(d_x * (y - y_p) - d_y * (x - x_p), -room), room)
        x_p, y_p = x_p - lateral * d_y, y_p + lateral * d_x
    return x_p, y_p


@inlined
def _is_passed(x: float, y: float, at: int, routes: Routes, radius: float) -> bool:
    """Whether (x, y) is within ``radius`` of the way-point, or beyond its line where that is."""
    dx, dy = routes.waypoints[at, 0] - x, routes.waypoints[at, 1] - y
    if dx * dx + dy * dy <= radius * radius:
        return True
    half = routes.passage[at, 2]
    if half <= 0.0:
        return False
    d_x, d_y = routes.passage[at, 0], routes.passage[at, 1]
    return bool(d_x * dx + d_y * dy <= 0.0 and abs(d_x * dy - d_y * dx) <= half)


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
    fading everywhere, a route of many way-points is walked at two thirds of it).
    """
    for k in range(desired_speed.shape[0]):
        i = order[k]
        x, y = rows[PX, k], rows[PY, k]
        last = routes.start[i + 1] - 1
        at = routes.start[i] + waypoint_index[i]
        soft = c.s_des_2
        while at < last:
            signal = routes.signal[at]
            if signal >= 0 and closed[signal]:
                break
            if not _is_passed(x, y, at, routes, c.r_waypoint):
                soft = _NO_SLOWING
                break
            waypoint_index[i] += 1
            at += 1
        rows[TX, k], rows[TY, k] = _aim(x, y, at, routes, c.R)
        rows[V0, k] = desired_speed[i]
        rows[SOFT, k] = soft


@kernel
def fill_arrived(
    position: NDArray[np.float64],
    arrays: RouteArrays,
    waypoint_index: NDArray[np.int64],
    radius: float,
    mask: NDArray[np.bool_],
) -> None:
    """Who is on the way to the last way-point and within ``radius`` of it, or of its line."""
    routes = Routes(*arrays)
    for i in range(len(mask)):
        last = routes.start[i + 1] - 1
        x, y = position[i, 0], position[i, 1]
        to_x, to_y = _aim(x, y, last, routes, 0.0)
        dx, dy = to_x - x, to_y - y
        on_the_way = routes.start[i] + waypoint_index[i] == last
        mask[i] = on_the_way and dx * dx + dy * dy <= radius * radius


@kernel
def select_routes(
    arrays: RouteArrays,
    mask: NDArray[np.bool_],
    start: NDArray[np.int64],
    waypoints: NDArray[np.float64],
    passage: NDArray[np.float64],
    signal: NDArray[np.int64],
) -> None:
    """Copy the routes of those in ``mask`` to the last three, one after the other as ``start``."""
    routes = Routes(*arrays)
    kept = 0
    for i in range(len(mask)):
        if not mask[i]:
            continue
        shift = start[kept] - routes.start[i]
        for at in range(routes.start[i], routes.start[i + 1]):
            waypoints[at + shift, 0] = routes.waypoints[at, 0]
            waypoints[at + shift, 1] = routes.waypoints[at, 1]
            passage[at + shift, 0] = routes.passage[at, 0]
            passage[at + shift, 1] = routes.passage[at, 1]
            passage[at + shift, 2] = routes.passage[at, 2]
            signal[at + shift] = routes.signal[at]
        kept += 1
