"""The lane paths of background vehicles: the lanes ahead of each one, kept from step to step.

The lanes ahead of a vehicle change only when it comes to another lane or gets another route, while
its position along them changes in every step. Therefore vehicles with the same lanes ahead share
one polyline in a pool, and the kernels cut it at each vehicle's position.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.kernel import Array, inner, kernel
from giveway.geometry.passage import look
from giveway.geometry.path import points_at, stations_of
from giveway.sumo.vehicles import SumoVehicles

Indices = NDArray[np.int64]

# Length of a new lane path as a multiple of the sight needed now, for vehicles that accelerate
_REACH = 2.0
_LEAST_REACH = 100.0  # Smallest length [m] of a new lane path
_SAME_PLACE = 1e-9  # Distance [m] up to which two points of a polyline are one
_FORGET = 2  # Remembered vehicles per present vehicle, above which those that left are forgotten
_CAR = 4.5  # Length [m] of a car
_DIFFER = 0.05  # Distance [m] between two lines from which on they differ
# Distance [m] behind the end of a lane path, where a vehicle leaves the network, within which
# people count: half of a shoulder breadth and 0.03 m
_AT_END = 0.3
_CELL = 20.0  # Cell size [m] of the grid in which pedestrians are looked up


class _Known(NamedTuple):
    """The remembered lane path of one vehicle."""

    lane: str
    route: str
    reach: float  # length [m] of the lane path
    lane_path: int


class LanePathPool(NamedTuple):
    """The lane paths in one growing pool; path w is ``points[start[w]:start[w + 1]]``."""

    points: Array  # (total, 2) [m] vertices
    # (total,) [m] arc length from the beginning of the first lane; inf beyond that lane
    along: Array
    start: Indices  # (w + 1,) first row of each path
    first: Indices  # (w,) number of points of the first lane
    nominal: Array  # (w,) [m] length of the first lane in SUMO


_EMPTY: tuple[tuple[tuple[int, ...], type], ...] = (
    ((1, 2), np.float64),
    ((1,), np.float64),
    ((1,), np.int64),
    ((1,), np.int64),
    ((1,), np.float64),
)


class LanePaths:
    """The lane paths of the background vehicles.

    Args:
        vehicles: Vehicles of the running simulation.

    Attributes:
        pool: All lane paths so far, with room for more.
        lanes: Lanes of each lane path, in the order of the pool.
        middles: Lines (total, 2) [m] of the middles of cars' bodies, row by row beside
            ``pool.points``. They cut the inner side of bends.
        bent: Flags (w,) of the lane paths whose two lines differ.
    """

    pool: LanePathPool
    middles: Array
    bent: NDArray[np.bool_]
    lanes: list[tuple[str, ...]]

    def __init__(self, vehicles: SumoVehicles) -> None:
        self._vehicles = vehicles
        self._known: dict[str, _Known] = {}
        self._numbers: dict[tuple[str, ...], int] = {}
        self.lanes = []
        self.pool = LanePathPool(*(np.zeros(shape, kind) for shape, kind in _EMPTY))
        self.middles, self.bent = np.zeros((1, 2)), np.zeros(1, dtype=np.bool_)
        self._points = 0

    def of(self, names: Sequence[str], sights: Sequence[float]) -> tuple[Indices, Array]:
        """The number of each vehicle's lane path (-1 off any lane) and its position along it [m].

        Args:
            names: Ids of the vehicles.
            sights: Length [m] up to which each lane path has to be known.
        """
        numbers = np.empty(len(names), dtype=np.int64)
        positions = np.empty(len(names))
        for i, (name, sight) in enumerate(zip(names, sights, strict=True)):
            lane, route, positions[i] = self._vehicles.whereabouts(name)
            known = self._known.get(name)
            if known is None or known[:2] != (lane, route) or known.reach < sight:
                known = self._known[name] = self._find(name, lane, route, sight)
            numbers[i] = known.lane_path
        return numbers, positions

    def onwards(self, number: int, position: float) -> Array:
        """The rest (k, 2) [m] of a lane path, from SUMO's ``position`` [m] on its first lane."""
        pool = self.pool
        begin, end = pool.start[number], pool.start[number + 1]
        first = begin + pool.first[number]
        along, lane = pool.along[begin:first], pool.points[begin:first]
        driven = position / pool.nominal[number] * along[-1]
        here = [np.interp(driven, along, column) for column in lane.T]
        return np.concatenate([[here], lane[along > driven], pool.points[first:end]])

    def forget(self, present: Sequence[str]) -> None:
        """Forget the vehicles that have left, when they are many."""
        if len(self._known) > _FORGET * len(present):
            kept = self._known.keys() & set(present)
            self._known = {name: self._known[name] for name in kept}

    def _find(self, name: str, lane: str, route: str, sight: float) -> _Known:
        reach = max(_LEAST_REACH, _REACH * sight)
        if not lane:
            return _Known(lane, route, math.inf, -1)
        lanes = self._vehicles.lanes_ahead(name, lane, reach)
        if lanes not in self._numbers:
            self._append([self._vehicles.shape(each) for each in lanes], lane)
            self._numbers[lanes] = len(self._numbers)
            self.lanes.append(lanes)
        return _Known(lane, route, reach, self._numbers[lanes])

    def _append(self, shapes: list[Array], lane: str) -> None:
        """Add the lane path of lanes with these ``shapes``; ``lane`` is the id of the first one."""
        w, begin = len(self._numbers), self._points
        end = self._points = begin + sum(map(len, shapes))
        for name in ("points", "along"):
            self._reserve(name, end)
        for name in ("start", "first", "nominal"):
            self._reserve(name, w + 2)
        pool, first = self.pool, begin + len(shapes[0])
        pool.points[begin:end] = np.concatenate(shapes)
        pool.along[begin:end] = np.inf
        pool.along[begin] = 0.0
        pool.along[begin + 1 : first] = np.cumsum(np.hypot(*np.diff(shapes[0], axis=0).T))
        pool.start[w + 1] = end
        middles = _middles(pool.points[begin:end])
        self.middles = np.concatenate([self.middles[:begin], middles])
        differ = bool((np.abs(middles - pool.points[begin:end]) > _DIFFER).any())
        self.bent = np.append(self.bent[:w], differ)
        pool.first[w] = first - begin
        pool.nominal[w] = max(self._vehicles.lane_length(lane), 1e-9)

    def _reserve(self, name: str, rows: int) -> None:
        array = getattr(self.pool, name)
        if rows > len(array):
            more = np.zeros((max(rows, 2 * len(array)), *array.shape[1:]), array.dtype)
            more[: len(array)] = array
            self.pool = self.pool._replace(**{name: more})


def _middles(points: Array) -> Array:
    """Return the middle (k, 2) [m] of a car's body beside each point of a lane path."""
    kept = np.append(True, np.hypot(*np.diff(points, axis=0).T) > _SAME_PLACE)
    line = points[kept]
    if len(line) < 2:
        return points
    ways = np.diff(line[[0, 1, -2, -1]], axis=0)[[0, 2]]
    ways *= (_CAR / np.hypot(*ways.T))[:, None]  # the car is straight before and behind the line
    line = np.vstack([line[0] - ways[0], line, line[-1] + ways[1]])
    along = stations_of(line)
    at = along[1:-1][np.cumsum(kept) - 1]
    return (points_at(line, along, at - _CAR / 2) + points_at(line, along, at + _CAR / 2)) / 2


@inner
def path_from(
    front: Array,
    position: float,
    lane_path: int,
    pool: LanePathPool,
    sight: float,
    path: Array,
    stations: Array,
) -> int:
    """Fill ``path`` and ``stations`` from a front bumper to ``sight``; return the point count."""
    points, along, start, first, nominal = pool
    begin = start[lane_path]
    share = position / nominal[lane_path]
    driven = share * along[begin + first[lane_path] - 1]
    k = begin
    while k < begin + first[lane_path] and not along[k] > driven:
        k += 1
    path[0, 0], path[0, 1], stations[0] = front[0], front[1], 0.0
    x, y = front[0], front[1]
    count = 1
    while k < start[lane_path + 1] and stations[count - 1] <= sight:
        apart = np.hypot(points[k, 0] - x, points[k, 1] - y)
        x, y = points[k, 0], points[k, 1]
        if apart > _SAME_PLACE:
            step = np.hypot(x - path[count - 1, 0], y - path[count - 1, 1])
            path[count, 0], path[count, 1] = x, y
            stations[count] = stations[count - 1] + step
            count += 1
        k += 1
    return count


@kernel
def gaps_ahead(
    vehicles: tuple[Array, Array, Indices],
    pool: LanePathPool,
    sight: Array,
    half_width: Array,
    pedestrians: Array,
    grid: Indices,
    gaps: Array,
) -> None:
    """Fill each vehicle's distance [m] to the first pedestrian in sight; inf if there is none.

    Only pedestrians within the straight distance ``sight`` are examined; a grid finds them.

    Args:
        vehicles: Front bumpers (n, 2) [m], positions (n,) [m] on their lanes, and the numbers (n,)
            of their lane paths; -1 without one.
        pool: Lane paths.
        sight: Sight (n,) [m] of each vehicle.
        half_width: Half width (n,) [m] of the corridor of each vehicle.
        pedestrians: Positions (p, 2) [m] of the pedestrians.
        grid: Result of :func:`sort_pedestrians`.
        gaps: Distances (n,) [m] to be filled.
    """
    fronts, positions, numbers = vehicles
    longest = 2
    for i in range(len(numbers)):
        if numbers[i] >= 0:
            longest = max(longest, pool.start[numbers[i] + 1] - pool.start[numbers[i]] + 1)
    path, stations = np.empty((longest, 2)), np.empty(longest)
    for i in range(len(numbers)):
        gaps[i] = np.inf
        if numbers[i] < 0:
            continue
        x, y, far = fronts[i, 0], fronts[i, 1], sight[i]
        count = path_from(fronts[i], positions[i], numbers[i], pool, far, path, stations)
        if count < 2:
            continue
        for column in range(math.floor((x - far) / _CELL), math.floor((x + far) / _CELL) + 1):
            for row in range(math.floor((y - far) / _CELL), math.floor((y + far) / _CELL) + 1):
                b = bucket(column, row, len(pedestrians))
                for at in range(grid[b], grid[b + 1]):
                    j = grid[buckets(len(pedestrians)) + 1 + at]
                    d_x, d_y = pedestrians[j, 0] - x, pedestrians[j, 1] - y
                    if d_x * d_x + d_y * d_y <= far * far:
                        station, _ = look(
                            path[:count],
                            stations[:count],
                            (0, count - 2),
                            (pedestrians[j, 0], pedestrians[j, 1]),
                            0.0,
                            half_width[i],
                            0.0,
                        )
                        if station <= stations[count - 1] + _AT_END:
                            gaps[i] = min(gaps[i], station)


@inner
def buckets(pedestrians: int) -> int:
    """The number of buckets into which cells are hashed."""
    return max(1, pedestrians)


@inner
def bucket(column: int, row: int, pedestrians: int) -> int:
    """The bucket into which a cell is hashed."""
    return (column * 73856093 ^ row * 19349663) % buckets(pedestrians)


@kernel
def sort_pedestrians(pedestrians: Array) -> Indices:
    """The beginnings of the buckets, followed by the indices of all pedestrians in bucket order."""
    n, m = len(pedestrians), buckets(len(pedestrians))
    grid = np.zeros(m + 1 + n, dtype=np.int64)
    where = np.empty(n, dtype=np.int64)
    for j in range(n):
        column, row = math.floor(pedestrians[j, 0] / _CELL), math.floor(pedestrians[j, 1] / _CELL)
        where[j] = bucket(column, row, n)
        grid[where[j] + 1] += 1
    for b in range(m):
        grid[b + 1] += grid[b]
    filled = grid[:m].copy()
    for j in range(n):
        grid[m + 1 + filled[where[j]]] = j
        filled[where[j]] += 1
    return grid
