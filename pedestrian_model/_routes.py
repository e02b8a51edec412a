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

# [m^2] instead of s_des^2 towards a way-point at which nobody stops: 1 um, against 0/0 only
_NO_SLOWING = 1e-12


class Routes(NamedTuple):
    """The routes of a crowd, as in ``Crowd``."""

    waypoints: NDArray[np.float64]  # (total, 2) [m]
    passage: NDArray[np.float64]  # (total, 3) unit direction, half-width [m]; 0: none
    signal: NDArray[np.int64]  # (total,) index into ``closed``; -1: none
    start: NDArray[np.int64]  # (n + 1,) offsets


class _Line(NamedTuple):
    """A way-point and its passage: scalars, because passing arrays about costs a count of each."""

    x: float  # [m]
    y: float
    d_x: float  # unit direction
    d_y: float
    half: float  # [m] half-width, 0: a point only


@inlined
def _aim(x: float, y: float, p: _Line, R: float) -> tuple[float, float]:
    """The nearest point to (x, y) of a line, R inside its ends if it can be."""
    if p.half <= 0.0:
        return p.x, p.y
    room = max(p.half - R, 0.0)
    lateral = min(max(p.d_x * (y - p.y) - p.d_y * (x - p.x), -room), room)
    return p.x - lateral * p.d_y, p.y + lateral * p.d_x


@inlined
def _is_passed(x: float, y: float, p: _Line, radius: float) -> bool:
    """Whether (x, y) is within ``radius`` of the way-point, or beyond its line where that is."""
    dx, dy = x - p.x, y - p.y
    if dx * dx + dy * dy <= radius * radius:
        return True
    along, across = p.d_x * dx + p.d_y * dy, p.d_x * dy - p.d_y * dx
    return p.half > 0.0 and along >= 0.0 and abs(across) <= p.half


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
    w, q, signal, start = routes
    radius, R = c.r_waypoint, c.R
    for k in range(desired_speed.shape[0]):
        i = order[k]
        x, y = rows[PX, k], rows[PY, k]
        last = start[i + 1] - 1
        at = start[i] + waypoint_index[i]
        p = _Line(w[at, 0], w[at, 1], q[at, 0], q[at, 1], q[at, 2])
        soft = c.s_des_2
        while at < last and not (signal[at] >= 0 and closed[signal[at]]):
            if not _is_passed(x, y, p, radius):
                soft = _NO_SLOWING
                break
            waypoint_index[i] += 1
            at += 1
            p = _Line(w[at, 0], w[at, 1], q[at, 0], q[at, 1], q[at, 2])
        rows[TX, k], rows[TY, k] = _aim(x, y, p, R)
        rows[V0, k] = desired_speed[i]
        rows[SOFT, k] = soft


@kernel
def fill_arrived(
    position: NDArray[np.float64],
    waypoints: NDArray[np.float64],
    passage: NDArray[np.float64],
    start: NDArray[np.int64],
    waypoint_index: NDArray[np.int64],
    radius: float,
    mask: NDArray[np.bool_],
) -> None:
    """Who is on the way to the last way-point and within ``radius`` of it, or of its line."""
    w, q = waypoints, passage
    for i in range(len(mask)):
        last = start[i + 1] - 1
        x, y = position[i, 0], position[i, 1]
        p = _Line(w[last, 0], w[last, 1], q[last, 0], q[last, 1], q[last, 2])
        to_x, to_y = _aim(x, y, p, 0.0)
        dx, dy = to_x - x, to_y - y
        on_the_way = start[i] + waypoint_index[i] == last
        mask[i] = on_the_way and dx * dx + dy * dy <= radius * radius


@kernel
def select_routes(
    old: tuple[NDArray[Any], ...], mask: NDArray[np.bool_], new: tuple[NDArray[Any], ...]
) -> None:
    """Copy the routes of those in ``mask`` from ``old`` to ``new``, one after the other.

    Both are the arrays of :class:`Routes`; the offsets of the new ones are known.
    """
    routes = Routes(*old)
    waypoints, passage, signal, start = new
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
