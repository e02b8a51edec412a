"""The vehicles that approach a crossing, seen by the people at its kerb."""

from collections.abc import Sequence
from functools import cache

import numpy as np

from giveway.cosimulation.traffic.lane_paths import LanePaths
from giveway.crowd.gap_acceptance import Approaches
from giveway.ego.ego import Ego
from giveway.ego.rules.path_crossings import PathCrossing, crossings_on
from giveway.errors import ScenarioError
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath
from giveway.sumo.background import NO_VEHICLES, BackgroundVehicles
from giveway.sumo.network.pedestrian_crossings import Crossing
from giveway.sumo.session import SumoSession

_SIGHT = 12.0  # time [s] before a vehicle's arrival from which on people see it; own choice
_NEAR = 25.0  # distance [m] from the middle of a crossing within which every vehicle is seen


class CrossingTraffic:
    """Finds the vehicles that approach crossings.

    Args:
        session: The running simulation.
    """

    def __init__(self, session: SumoSession) -> None:
        self._lane_paths = LanePaths(session.vehicles)
        self._yielding_to = cache(session.junctions.yielding_to)
        self._background, self._egos = NO_VEHICLES, list[Ego]()
        # Where each lane path, or the path of an ego, leads a body of some size over a crossing
        self._places: dict[tuple[str, object, VehicleShape], tuple[PathCrossing, ...]] = {}

    def read(self, background: BackgroundVehicles, egos: Sequence[Ego] = ()) -> None:
        """Take note of the vehicles now."""
        self._background, self._egos = background, list(egos)

    def on(self, crossing: Crossing) -> Approaches:
        """Return the vehicles that approach a crossing or are on it."""
        rows = self._of_background(crossing)
        for ego in self._egos:
            for place in self._on(crossing, ego.id, ego.shape, ego.path):
                rows.append(_row(place, ego.front, ego.vehicle.speed, yields=False))
        return Approaches(*np.array(rows, dtype=np.float64).reshape(-1, 6).T)

    def _of_background(self, crossing: Crossing) -> list[tuple[float, ...]]:
        others = self._background
        if not others.ids:
            return []
        x, y = crossing.ends.mean(axis=0)
        sight = _NEAR + _SIGHT * others.speed
        near = np.flatnonzero(np.hypot(others.x - x, others.y - y) <= sight).tolist()
        names = [others.ids[i] for i in near]
        numbers, positions = self._lane_paths.of(names, sight[near].tolist())
        lanes = self._yielding_to(crossing.lane)
        pool, rows = self._lane_paths.pool, list[tuple[float, ...]]()
        for i, number, position in zip(near, numbers.tolist(), positions.tolist(), strict=True):
            if number < 0:
                continue
            begin, end = pool.start[number], pool.start[number + 1]
            shape = VehicleShape(float(others.length[i]), float(others.width[i]))
            lane = float(pool.along[begin + pool.first[number] - 1])
            station = position / float(pool.nominal[number]) * lane
            for place in self._on(crossing, number, shape, pool.points[begin:end]):
                yields = not lanes.isdisjoint(self._lane_paths.lanes[number])
                rows.append(_row(place, station, float(others.speed[i]), yields=yields))
        self._lane_paths.forget(others.ids)
        return rows

    def _on(
        self, crossing: Crossing, path: object, shape: VehicleShape, points: EgoPath | Array
    ) -> tuple[PathCrossing, ...]:
        """Return where a path leads over a crossing, which is found once for each path."""
        key = crossing.lane, path, shape
        found = self._places.get(key)
        if found is None:
            try:
                way = points if isinstance(points, EgoPath) else EgoPath.through(points)
                found = tuple(
                    place._replace(exit=place.exit + shape.length)
                    for place in crossings_on(way, shape, (crossing,))
                )
            except ScenarioError:  # a path of one point, on a lane without length
                found = ()
            self._places[key] = found
        return found


def _row(place: PathCrossing, front: float, speed: float, *, yields: bool) -> tuple[float, ...]:
    entry, leave = place.entry - front, place.exit - front
    return entry, leave, speed, float(yields), place.low, place.high
