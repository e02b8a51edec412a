"""The closest vehicle in front of the ego.

:mod:`giveway.ego.perception.corridor` defines what is in front.
"""

from math import inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from controller.driving_constants import STANDING
from giveway.geometry.kernel import Array, kernel
from giveway.geometry.passage import BEHIND, SIGHT, look, window
from giveway.geometry.path import body_pose, project, segment_at

_ONCOMING = -0.8  # cosine of the angle to the ego's path, below which a vehicle is oncoming
_PARALLEL = 0.95  # cosine of this angle (18 degrees), above which a vehicle drives the same way
_FOLLOWED = 0.5  # cosine of this angle (60 degrees), above which a vehicle ahead is followed
_OUTLINE = 1.0  # largest spacing [m] of the examined points of a vehicle's outline
_FINEST_OUTLINE = 0.1  # least spacing [m] of these points


class Leader(NamedTuple):
    """The closest vehicle in front."""

    station: float  # station [m] of its closest point; inf without a vehicle
    speed: float  # speed [m/s] along the ego's path, at least 0


class Followed(NamedTuple):
    """The closest vehicle in front that drives the same way, or that stands."""

    station: float = inf  # station [m] of its closest point; inf without a vehicle
    speed: float = 0.0  # speed [m/s] along the ego's path, at least 0
    row: int = -1  # its row among the vehicles; -1 without one


NO_LEADER = Leader(inf, 0.0)
NOT_FOLLOWING = Followed()
NOBODY_BESIDE: NDArray[np.bool_] = np.empty(0, dtype=np.bool_)


@kernel
def outline_in_front(
    vertices: Array,
    stations: Array,
    first: int,
    last: int,
    vehicle: Array,
    front: float,
    half_width: float,
) -> float:
    """Station [m] of the closest point of a vehicle's outline in front; inf if none is."""
    cos, sin = np.cos(vehicle[2]), np.sin(vehicle[2])
    rear, length, half = -vehicle[5], vehicle[4] + vehicle[5], vehicle[6] / 2.0
    apart = max(
        _FINEST_OUTLINE, min(_OUTLINE, half_width)
    )  # no larger than the corridor, so that no vehicle is missed
    along = max(1, int(np.ceil(length / apart)))
    closest = np.inf
    for i in range(along + 1):
        to_x = rear + length * i / along
        across = max(1, int(np.ceil(2.0 * half / apart))) if i in (0, along) else 1
        for j in range(across + 1):
            to_y = -half + 2.0 * half * j / across
            x = vehicle[0] + cos * to_x - sin * to_y
            y = vehicle[1] + sin * to_x + cos * to_y
            station, _ = look(vertices, stations, (first, last), (x, y), front, half_width, 0.0)
            closest = min(closest, station)
    return closest


@kernel
def vehicles_in_front(
    path: tuple[Array, Array, Array],
    poses: Array,
    own: int,
    motion: tuple[float, float, float],
    corridor: tuple[float, int],
    beside: NDArray[np.bool_],
    ahead: Array,
) -> tuple[float, float, tuple[float, float, int]]:
    """The closest vehicle now (station, speed along the path); fills ``ahead`` for 1 ... N.

    The last of the results is the closest one that drives the same way or stands: its station, its
    speed along the path and its row.

    A vehicle in the corridor is predicted to follow the path at its present speed. So a vehicle
    ahead in a bend stays ahead. Any other vehicle is predicted to go straight on for ``straight``
    steps. So a vehicle from the side arrives. If N is larger than ``straight``, vehicles beside the
    path that drive the same way or oncoming are predicted to keep their lane, and vehicles from the
    side beyond the path's end are ignored. Vehicles marked in ``beside`` keep the lane that leads
    them past the path. A vehicle in the corridor behind the front bumper stays behind.

    Args:
        path: Vertices, stations and headings of the ego's path.
        poses: Poses of all vehicles, (N, m, 7).
        own: Row of the ego.
        motion: Station of its front bumper [m], its travel in a step [m], and the step [s].
        corridor: Half of its width [m], and the steps ``straight``.
        beside: Marks (k,) of those of the last k vehicles that pass beside the path.
        ahead: Stations (N,) [m] of the closest vehicle at steps 1 ... N, filled.
    """
    (vertices, stations, headings), (front, advance, time_step) = path, motion
    half_width, straight = corridor
    N = ahead.shape[0]
    known = poses.shape[1] - beside.shape[0]
    end = stations[-1] if straight < N else np.inf
    first, last = window(stations, front, BEHIND)
    ahead[:] = np.inf
    nearest, its_speed = np.inf, 0.0
    followed, pace, row = np.inf, 0.0, -1
    x_0, y_0, _ = body_pose(vertices, stations, headings, front, 0.0)
    for j in range(poses.shape[1]):
        vehicle = poses[0, j]
        size = vehicle[4] + vehicle[5] + vehicle[6]
        away = np.hypot(vehicle[0] - x_0, vehicle[1] - y_0)
        if j == own or away > SIGHT + size:
            continue
        station = outline_in_front(vertices, stations, first, last, vehicle, front, half_width)
        if station < np.inf:
            i = segment_at(stations, station)
            same_way = np.cos(vehicle[2] - headings[i])
            along = max(0.0, vehicle[3] * same_way)
            if station < nearest:
                nearest, its_speed = station, along
            if station < followed and (same_way > _FOLLOWED or vehicle[3] < STANDING):
                followed, pace, row = station, along, j
            for k in range(N):
                ahead[k] = min(ahead[k], station + (k + 1) * time_step * along)
            continue
        if j >= known and beside[j - known]:
            continue
        if straight < N:
            nearest_to_it, _ = project(vertices, stations, vehicle[0], vehicle[1])
            i = segment_at(stations, nearest_to_it)
            aligned = np.cos(vehicle[2] - headings[i])
            if aligned < _ONCOMING or aligned > _PARALLEL:
                continue  # it keeps a lane beside the ego's, which bends as the ego's does
        reach = min(N, straight) * (advance + abs(vehicle[3]) * time_step) + size + half_width
        if away > reach:
            continue  # it cannot meet the ego within the horizon
        rear = front - reach
        begin = segment_at(stations, rear)
        if outline_in_front(vertices, stations, begin, last, vehicle, rear, half_width) < np.inf:
            continue
        for k in range(1, min(N, straight, poses.shape[0] - 1) + 1):
            at = front + k * advance
            station = outline_in_front(vertices, stations, first, last, poses[k, j], at, half_width)
            if station <= end:
                ahead[k - 1] = min(ahead[k - 1], station)
    return nearest, its_speed, (followed, pace, row)
