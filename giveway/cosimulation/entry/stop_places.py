"""The stops of a vehicle that is taken over, as stations of the ego's path."""

import math
from collections.abc import Mapping, Sequence

from giveway.ego.rules.route import Stop
from giveway.geometry.path import EgoPath
from giveway.sumo.network.lane_path import LanePath
from giveway.sumo.network.lanes import Lanes
from giveway.sumo.vehicles import PlannedStop, VehicleState

SERVING: tuple[str, ...] = ("bus", "coach", "tram")
"""SUMO's vehicle classes whose egos serve their stops by default."""

_PASSED = 1.0  # Distance [m] behind the vehicle at which a stop is over


def placed(stops: Sequence[PlannedStop], state: VehicleState) -> dict[int, int]:
    """The edge index of each stop on the rest of a vehicle's route, by the stop's number.

    Args:
        stops: Planned stops in the order in which the vehicle comes to them.
        state: State of the vehicle.
    """
    places = {}
    at, behind = 0, state.lane_position - _PASSED
    for number, stop in enumerate(stops):
        edge = stop.lane.rpartition("_")[0]
        while at < len(state.edges) and (state.edges[at] != edge or stop.end < behind):
            at, behind = at + 1, -math.inf
        if at == len(state.edges):
            break
        if not stop.beside:
            places[number] = at
            behind = stop.end
    return places


def lanes_of(places: Mapping[int, int], stops: Sequence[PlannedStop]) -> dict[int, int]:
    """The lane on which each edge with a stop is left, by the edge's index."""
    return {at: int(stops[number].lane.rpartition("_")[2]) for number, at in places.items()}


def on_path(
    places: Mapping[int, int],
    stops: Sequence[PlannedStop],
    path: EgoPath,
    lane_path: LanePath,
    lanes: Lanes,
) -> list[Stop]:
    """The stops as stations of the ego's path.

    Args:
        places: Edge index of each served stop, as :func:`placed` returns it.
        stops: All stops of the vehicle.
        path: Path of the ego.
        lane_path: Lanes that the path was made of.
        lanes: Lanes of the network.
    """
    found = []
    for number, at in places.items():
        stop = stops[number]
        ends = [
            path.locate(*lanes.point(stop.lane, along), near=lane_path.edges[at] + along)[0]
            for along in (stop.start, stop.end)
        ]
        until = stop.until if stop.until >= 0.0 else -math.inf
        found.append(Stop(min(ends), max(ends), max(0.0, stop.duration), until))
    return found
