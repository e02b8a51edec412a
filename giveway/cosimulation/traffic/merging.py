"""The vehicles that merge with an ego: their lanes lead onto a lane of the ego's route."""

from collections.abc import Sequence

import numpy as np

from giveway.cosimulation.traffic.lane_paths import LanePaths
from giveway.ego.ego import Ego
from giveway.ego.rules.merge_points import MergePoint, MergingVehicle
from giveway.sumo.background import BackgroundVehicles
from giveway.sumo.network.lanes import Lanes
from giveway.sumo.vehicles import SumoVehicles

_NEAR = 150.0  # Distance [m] from an ego up to which other vehicles are considered


class Merging:
    """Finds the vehicles that merge with egos, once after each SUMO step.

    Args:
        vehicles: Vehicles of the running simulation.
        lanes: Lanes of its network.
    """

    def __init__(self, vehicles: SumoVehicles, lanes: Lanes) -> None:
        self._vehicles = vehicles
        self._lanes = lanes
        self._lane_paths = LanePaths(vehicles)

    def of(
        self, background: BackgroundVehicles, ego: Ego, egos: Sequence[Ego]
    ) -> dict[MergePoint, dict[str, MergingVehicle]]:
        """The vehicles that an ego merges with, at each merge point in sight.

        Args:
            background: Background vehicles now.
            ego: Ego with these merge points.
            egos: Egos on the road now.
        """
        places = ego.rules.near_merges(ego.front)
        if not places:
            return {}
        near = self._near(background, ego, [other for other in egos if other is not ego])
        return self._rivals(places, near)

    @staticmethod
    def _near(
        background: BackgroundVehicles, ego: Ego, others: Sequence[Ego]
    ) -> list[tuple[str, float, float]]:
        """The id, speed [m/s] and length [m] of each vehicle near an ego."""
        x, y, _ = ego.pose
        rows = np.flatnonzero(np.hypot(background.x - x, background.y - y) <= _NEAR)
        near = [
            (background.ids[i], float(background.speed[i]), float(background.length[i]))
            for i in rows
        ]
        return near + [(other.id, other.vehicle.speed, other.shape.length) for other in others]

    def _rivals(
        self, places: Sequence[MergePoint], near: Sequence[tuple[str, float, float]]
    ) -> dict[MergePoint, dict[str, MergingVehicle]]:
        """The vehicles whose lanes lead onto the lane that begins at each merge point."""
        merging_vehicles: dict[MergePoint, dict[str, MergingVehicle]] = {
            place: {} for place in places
        }
        names = [name for name, _, _ in near]
        numbers, positions = self._lane_paths.of(names, [_NEAR] * len(names))
        self._lane_paths.forget(names)
        for (name, speed, length), number, at in zip(near, numbers, positions, strict=True):
            if number < 0:
                continue
            lanes = self._lane_paths.lanes[number]
            share = float(at) / self._vehicles.lane_length(lanes[0])
            for place in places:
                k = lanes.index(place.lane) if place.lane in lanes else -1
                if k < 0 or (place.over and (k == 0 or lanes[k - 1] not in place.over)):
                    continue
                before = sum(map(self._lanes.length, lanes[:k]))
                position = share * self._lanes.length(lanes[0]) - before
                merging_vehicles[place][name] = MergingVehicle(position, speed, length)
        return merging_vehicles
