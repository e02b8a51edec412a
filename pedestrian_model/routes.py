"""Finds the next point of a route: way-points passed, lines crossed, signals waited at.

A way-point is passed within a radius. A way-point with a passage is a line across the route. A
person who crosses the line within its half-width has passed it. Until then the person walks to the
nearest point of the line, so that a crowd walks through side by side instead of through one point.
A person who is pushed back through a line passes it once more, and is not caught at the corner that
it leads round. All of this is giveway's own.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pedestrian_model._check import as_floats, check_shape, check_values
from pedestrian_model._jit import inlined
from pedestrian_model.errors import CrowdError

#: Signal of a way-point without one, if walls do not hold people on the way to it.
OFF_WALKWAYS = -2
_BACK = 0.5  # distance [m] before a line, beyond its radius, from which on it is passed once more


class Routes(NamedTuple):
    """The routes of a crowd, as in ``Crowd``."""

    waypoints: NDArray[np.float64]  # way-points (total, 2) [m]
    passage: NDArray[np.float64]  # passages (total, 3): unit direction, half-width [m]; or 0
    signal: NDArray[np.int64]  # indices (total,) into ``closed``; -1 without a signal, or -2
    start: NDArray[np.int64]  # offsets (n + 1,) into ``waypoints``


class Line(NamedTuple):
    """A way-point and its passage."""

    x: float  # coordinates of the way-point [m]
    y: float
    d_x: float  # unit direction of the passage
    d_y: float
    half: float  # half-width [m] of the passage; 0 for a point


@inlined
def aim(x: float, y: float, p: Line, R: float) -> tuple[float, float]:
    """Return the point of a line nearest to (x, y) [m], at least R from its ends if possible."""
    if p.half <= 0.0:
        return p.x, p.y
    room = max(p.half - R, 0.0)
    lateral = min(max(p.d_x * (y - p.y) - p.d_y * (x - p.x), -room), room)
    return p.x - lateral * p.d_y, p.y + lateral * p.d_x


@inlined
def is_passed(x: float, y: float, p: Line, radius: float) -> bool:
    """Return whether (x, y) is within ``radius`` of a way-point, or beyond its line."""
    dx, dy = x - p.x, y - p.y
    if dx * dx + dy * dy <= radius * radius:
        return True
    along, across = p.d_x * dx + p.d_y * dy, p.d_x * dy - p.d_y * dx
    return p.half > 0.0 and along >= 0.0 and abs(across) <= p.half


@inlined
def is_behind(x: float, y: float, p: Line, far: float) -> bool:
    """Return whether (x, y) is at least ``far`` [m] before a line, within its half-width."""
    dx, dy = x - p.x, y - p.y
    along, across = p.d_x * dx + p.d_y * dy, p.d_x * dy - p.d_y * dx
    return along < -far and abs(across) <= p.half


@inlined
def heading_for(
    x: float,
    y: float,
    at: int,
    ends: tuple[int, int],
    routes: Any,
    closed: NDArray[np.bool_],
    radii: tuple[float, float],
) -> tuple[int, bool, float, float]:
    """Return the next way-point of a person, whether to stop there, and the point to walk to.

    Args:
        x: Coordinate of the person [m].
        y: Coordinate of the person [m].
        at: Index of the next way-point so far.
        ends: Indices of the first and of the last way-point of the route.
        routes: Arrays of ``Routes``.
        closed: Marks (signals,) of closed signals.
        radii: Radius [m] of a way-point and of a body.
    """
    (first, last), (radius, R) = ends, radii
    w, q, signal = routes[0], routes[1], routes[2]
    stops = True
    if at > first:
        k = at - 1
        p = Line(w[k, 0], w[k, 1], q[k, 0], q[k, 1], q[k, 2])
        if is_behind(x, y, p, radius + _BACK) and not is_behind(w[at, 0], w[at, 1], p, 0.0):
            at = k
    p = Line(w[at, 0], w[at, 1], q[at, 0], q[at, 1], q[at, 2])
    while at < last and not (signal[at] >= 0 and closed[signal[at]]):
        if not is_passed(x, y, p, radius):
            stops = False
            break
        at += 1
        p = Line(w[at, 0], w[at, 1], q[at, 0], q[at, 1], q[at, 2])
    to_x, to_y = aim(x, y, p, R)
    return at, stops, to_x, to_y


def passage_rows(
    passages: Sequence[ArrayLike], routes: Sequence[NDArray[np.float64]]
) -> NDArray[np.float64]:
    """Return the passages (total, 3) of all way-points, with directions of length one."""
    _check_count(passages, "passages", routes)
    rows = [as_floats(rows, f"passages[{i}]", CrowdError) for i, rows in enumerate(passages)]
    for i, (row, route) in enumerate(zip(rows, routes, strict=True)):
        check_shape(row, (len(route), 3), f"passages[{i}]", CrowdError)
        check_values(row, f"passages[{i}]", CrowdError)
    out = np.concatenate(rows) if rows else np.empty((0, 3))
    length = np.sqrt((out[:, :2] ** 2).sum(axis=1))
    pointing = length > 0.0
    out[pointing, :2] /= length[pointing, None]
    out[~pointing] = 0.0
    return out


def signal_rows(
    signals: Sequence[ArrayLike], routes: Sequence[NDArray[np.float64]]
) -> NDArray[np.int64]:
    """Return the signals (total,) of all way-points."""
    _check_count(signals, "signals", routes)
    rows = [np.asarray(row) for row in signals]
    for i, (row, route) in enumerate(zip(rows, routes, strict=True)):
        check_shape(row, (len(route),), f"signals[{i}]", CrowdError)
        if row.dtype.kind not in "iu":
            raise CrowdError(f"signals[{i}] is {row.dtype}, expected integers")
    return np.concatenate(rows).astype(np.int64) if rows else np.empty(0, dtype=np.int64)


def _check_count(
    values: Sequence[ArrayLike], what: str, routes: Sequence[NDArray[np.float64]]
) -> None:
    if len(values) != len(routes):
        raise CrowdError(
            f"{what} has {len(values)} entries, expected one for each of {len(routes)}"
        )


def offsets(count: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the offsets (n + 1,) of n runs of these lengths."""
    return np.concatenate([np.zeros(1, dtype=np.int64), np.cumsum(count, dtype=np.int64)])
