"""Where SUMO's own cars are going to drive: the lanes ahead of each, kept from step to step.

The lanes ahead of a car change when it comes to another lane or gets another route, which is
seldom, while how far it is along them changes all the time. So the lanes' polylines stand in one
pool, the same for all cars with the same lanes ahead, and the kernels cut them where each car is.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from giveway.geometry.kernel import kernel
from giveway.geometry.passage import look

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from giveway.sumo.vehicles import SumoVehicles

    Array = NDArray[np.float64]
    Indices = NDArray[np.int64]

_REACH = 2.0  # times what is to be seen now, so that a car that goes faster finds its lanes known
_LEAST_REACH = 100.0  # [m]
_SAME_PLACE = 1e-9  # [m] two points of a polyline this close are one
_FORGET = 2  # times as many cars known as there are: those that left are forgotten
_CELL = 20.0  # [m] of the grid in which people are looked up


class _Known(NamedTuple):
    """What is remembered of one car."""

    lane: str
    route: str
    reach: float  # [m] of its lanes are known
    way: int


class Ways(NamedTuple):
    """Polylines of lanes in one pool that grows; way w is ``points[start[w]:start[w + 1]]``."""

    points: Array  # (total, 2) [m]
    along: Array  # (total,) [m] from the first lane's beginning; only known on that lane
    start: Indices  # (w + 1,)
    first: Indices  # (w,) points of the first lane
    nominal: Array  # (w,) [m] SUMO's length of the first lane


_EMPTY: tuple[tuple[tuple[int, ...], type], ...] = (
    ((1, 2), np.float64),
    ((1,), np.float64),
    ((1,), np.int64),
    ((1,), np.int64),
    ((1,), np.float64),
)


class PathsAhead:
    """The lanes ahead of SUMO's cars.

    Args:
        vehicles: SUMO's.

    Attributes:
        ways: all so far, with room for more.
    """

    ways: Ways

    def __init__(self, vehicles: SumoVehicles) -> None:
        self._vehicles = vehicles
        self._known: dict[str, _Known] = {}
        self._numbers: dict[tuple[str, ...], int] = {}
        self.ways = Ways(*(np.zeros(shape, kind) for shape, kind in _EMPTY))
        self._points = 0

    def of(self, names: Sequence[str], sights: Sequence[float]) -> tuple[Indices, Array]:
        """For each car the number of its way, -1 if it is on no lane, and how far along it is [m].

        Args:
            names: of the cars.
            sights: how far the way has to be known [m].
        """
        numbers = np.empty(len(names), dtype=np.int64)
        positions = np.empty(len(names))
        for i, (name, sight) in enumerate(zip(names, sights, strict=True)):
            lane, route, positions[i] = self._vehicles.whereabouts(name)
            known = self._known.get(name)
            if known is None or known[:2] != (lane, route) or known.reach < sight:
                known = self._known[name] = self._find(name, lane, route, sight)
            numbers[i] = known.way
        return numbers, positions

    def forget(self, present: Sequence[str]) -> None:
        """Forget the cars that have left, once they are many."""
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
        return _Known(lane, route, reach, self._numbers[lanes])

    def _append(self, shapes: list[Array], lane: str) -> None:
        """A new way, of lanes of these ``shapes``; ``lane`` is the first."""
        w, begin = len(self._numbers), self._points
        end = self._points = begin + sum(map(len, shapes))
        for name in ("points", "along"):
            self._reserve(name, end)
        for name in ("start", "first", "nominal"):
            self._reserve(name, w + 2)
        ways, first = self.ways, begin + len(shapes[0])
        ways.points[begin:end] = np.concatenate(shapes)
        ways.along[begin:end] = np.inf
        ways.along[begin] = 0.0
        ways.along[begin + 1 : first] = np.cumsum(np.hypot(*np.diff(shapes[0], axis=0).T))
        ways.start[w + 1] = end
        ways.first[w] = first - begin
        ways.nominal[w] = max(self._vehicles.lane_length(lane), 1e-9)

    def _reserve(self, name: str, rows: int) -> None:
        array = getattr(self.ways, name)
        if rows > len(array):
            more = np.zeros((max(rows, 2 * len(array)), *array.shape[1:]), array.dtype)
            more[: len(array)] = array
            self.ways = self.ways._replace(**{name: more})


@kernel
def path_from(
    front: Array, position: float, way: int, ways: Ways, sight: float, path: Array, stations: Array
) -> int:
    """Fill ``path`` and ``stations`` from a car's front on until ``sight``; how many points."""
    points, along, start, first, nominal = ways
    begin = start[way]
    share = position / nominal[way]
    driven = share * along[begin + first[way] - 1]
    k = begin
    while k < begin + first[way] and not along[k] > driven:
        k += 1
    path[0, 0], path[0, 1], stations[0] = front[0], front[1], 0.0
    x, y = front[0], front[1]
    count = 1
    while k < start[way + 1] and stations[count - 1] <= sight:
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
    fronts: Array,
    positions: Array,
    numbers: Indices,
    ways: Ways,
    sight: Array,
    half_width: Array,
    people: Array,
    grid: Indices,
    gaps: Array,
) -> None:
    """Fill each car's distance [m] to the first of ``people`` within its sight; inf: nobody.

    Only those are looked at who are within sight as the crow flies, found in the cells about.
    """
    longest = 2
    for i in range(len(numbers)):
        if numbers[i] >= 0:
            longest = max(longest, ways.start[numbers[i] + 1] - ways.start[numbers[i]] + 1)
    path, stations = np.empty((longest, 2)), np.empty(longest)
    for i in range(len(numbers)):
        gaps[i] = np.inf
        if numbers[i] < 0:
            continue
        x, y, far = fronts[i, 0], fronts[i, 1], sight[i]
        count = path_from(fronts[i], positions[i], numbers[i], ways, far, path, stations)
        if count < 2:
            continue
        for column in range(math.floor((x - far) / _CELL), math.floor((x + far) / _CELL) + 1):
            for row in range(math.floor((y - far) / _CELL), math.floor((y + far) / _CELL) + 1):
                b = bucket(column, row, len(people))
                for at in range(grid[b], grid[b + 1]):
                    j = grid[buckets(len(people)) + 1 + at]
                    d_x, d_y = people[j, 0] - x, people[j, 1] - y
                    if d_x * d_x + d_y * d_y <= far * far:
                        station, _ = look(
                            path[:count],
                            stations[:count],
                            0,
                            count - 2,
                            people[j, 0],
                            people[j, 1],
                            0.0,
                            half_width[i],
                            0.0,
                        )
                        gaps[i] = min(gaps[i], station)


@kernel
def buckets(people: int) -> int:
    """How many the cells are hashed to."""
    return max(1, people)


@kernel
def bucket(column: int, row: int, people: int) -> int:
    """Which one a cell is hashed to."""
    return (column * 73856093 ^ row * 19349663) % buckets(people)


@kernel
def sort_people(people: Array) -> Indices:
    """Where each bucket begins, and after that everybody, bucket by bucket."""
    n, m = len(people), buckets(len(people))
    grid = np.zeros(m + 1 + n, dtype=np.int64)
    where = np.empty(n, dtype=np.int64)
    for j in range(n):
        column, row = math.floor(people[j, 0] / _CELL), math.floor(people[j, 1] / _CELL)
        where[j] = bucket(column, row, n)
        grid[where[j] + 1] += 1
    for b in range(m):
        grid[b + 1] += grid[b]
    filled = grid[:m].copy()
    for j in range(n):
        grid[m + 1 + filled[where[j]]] = j
        filled[where[j]] += 1
    return grid
