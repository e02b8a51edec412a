"""The next target of each pedestrian, and the distance that is left."""

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import inlined, kernel
from pedestrian_model.arrays import Arrays
from pedestrian_model.crowd import Crowd
from pedestrian_model.routes import Line, Routes, aim, is_passed


def targets(crowd: Crowd, rows: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return the next way-points (k, 2) [m] of the pedestrians ``rows`` (k,).

    For a way-point with a line it is the nearest point of the line. A line crossed in the last step
    counts as passed, although ``waypoint_index`` advances only in the next step, unless a signal
    guards it. Detours around standing vehicles are ignored.
    """
    out = np.empty((len(rows), 2))
    _fill_targets(crowd.position, crowd.waypoint_index, crowd.routes, rows, out)
    return out


def remaining_distance(crowd: Crowd) -> NDArray[np.float64]:
    """Return the remaining length (n,) [m] of each route, straight from line to line."""
    out = np.empty(len(crowd))
    _fill_remaining(
        crowd.position,
        crowd.waypoints,
        crowd.waypoint_passage,
        crowd.waypoint_start,
        crowd.waypoint_index,
        out,
    )
    return out


@kernel
def _fill_remaining(
    position: NDArray[np.float64],
    waypoints: NDArray[np.float64],
    passage: NDArray[np.float64],
    start: NDArray[np.int64],
    waypoint_index: NDArray[np.int64],
    out: NDArray[np.float64],
) -> None:
    """Fill ``out`` (n,) [m] with the remaining lengths, through the nearest points of the lines."""
    w, q = waypoints, passage
    for i in range(len(out)):
        x, y = position[i, 0], position[i, 1]
        left = 0.0
        for at in range(start[i] + waypoint_index[i], start[i + 1]):
            p = Line(w[at, 0], w[at, 1], q[at, 0], q[at, 1], q[at, 2])
            to_x, to_y = aim(x, y, p, 0.0)
            left += np.hypot(to_x - x, to_y - y)
            x, y = to_x, to_y
        out[i] = left


@kernel
def _fill_targets(
    position: NDArray[np.float64],
    waypoint_index: NDArray[np.int64],
    routes: Arrays,
    rows: NDArray[np.int64],
    out: NDArray[np.float64],
) -> None:
    """Fill ``out`` (k, 2) [m] with the nearest points of the next way-points' lines."""
    w, q, signal, start = Routes(*routes)
    for k in range(len(rows)):
        i = rows[k]
        x, y = position[i, 0], position[i, 1]
        at, last = start[i] + waypoint_index[i], start[i + 1] - 1
        p = Line(w[at, 0], w[at, 1], q[at, 0], q[at, 1], q[at, 2])
        while at < last and signal[at] < 0 and is_passed(x, y, p, 0.0):
            at += 1
            p = Line(w[at, 0], w[at, 1], q[at, 0], q[at, 1], q[at, 2])
        out[k, 0], out[k, 1] = aim(x, y, p, 0.0)


def arrived(crowd: Crowd, radius: float) -> NDArray[np.bool_]:
    """Return marks (n,) of people within ``radius`` [m] of their last way-point or its line."""
    mask = np.empty(len(crowd), dtype=np.bool_)
    _fill_arrived(crowd.position, crowd.waypoint_index, crowd.routes, radius, mask)
    return mask


def any_arrived(crowd: Crowd, radius: float) -> bool:
    """Return whether anybody has arrived, see :func:`arrived`."""
    return bool(_any_arrived(crowd.position, crowd.waypoint_index, crowd.routes, radius))


@kernel
def _fill_arrived(
    position: NDArray[np.float64],
    waypoint_index: NDArray[np.int64],
    routes: Arrays,
    radius: float,
    mask: NDArray[np.bool_],
) -> None:
    for i in range(len(mask)):
        mask[i] = _is_there(i, position, waypoint_index, Routes(*routes), radius)


@kernel
def _any_arrived(
    position: NDArray[np.float64],
    waypoint_index: NDArray[np.int64],
    routes: Arrays,
    radius: float,
) -> bool:
    for i in range(len(position)):
        if _is_there(i, position, waypoint_index, Routes(*routes), radius):
            return True
    return False


@inlined
def _is_there(
    i: int,
    position: NDArray[np.float64],
    waypoint_index: NDArray[np.int64],
    routes: Routes,
    radius: float,
) -> bool:
    """Return whether pedestrian i is within ``radius`` of the last way-point or its line."""
    w, q, last = routes.waypoints, routes.passage, routes.start[i + 1] - 1
    if routes.start[i] + waypoint_index[i] != last:
        return False
    x, y = position[i, 0], position[i, 1]
    p = Line(w[last, 0], w[last, 1], q[last, 0], q[last, 1], q[last, 2])
    to_x, to_y = aim(x, y, p, 0.0)
    dx, dy = to_x - x, to_y - y
    return bool(dx * dx + dy * dy <= radius * radius)
