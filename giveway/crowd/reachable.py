"""Checks that added pedestrians start on walkable ground and near an ego's path."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import shapely
import shapely.affinity

from giveway.config.tables.crowd import ENCOUNTERS, CrowdConfig
from giveway.config.tables.flows import FlowConfig
from giveway.crowd.ways import corners, middle_of
from giveway.geometry.kernel import Array
from giveway.geometry.path import points_at
from giveway.walkways import WalkNetwork, beside

_NEAR = 25.0  # distance [m] to the ego's path, beyond which people do not matter to it
_NO_WALKWAY = 30.0  # distance [m] to a pedestrian lane, beyond which there is no walkway


def spawn_remark(config: CrowdConfig, ways: Sequence[Array], net_file: Path) -> str:
    """Return a remark on a spawn area whose pedestrians meet no ego, or an empty text.

    Args:
        config: Configuration of the crowd.
        ways: Path (k, 2) [m] of each ego, from its departure to its goal.
        net_file: File of the network, which is read only for a remark.
    """
    if config.sampler == ENCOUNTERS:
        return ""  # these people start where they meet the ego
    start = shapely.box(*config.spawn_area)
    middle = (start.centroid.x, start.centroid.y)
    walked = start.union(shapely.affinity.translate(start, *config.walk)).convex_hull
    apart = [float(walked.distance(shapely.LineString(way))) for way in ways]
    nearest = int(np.argmin(apart))
    if apart[nearest] <= _NEAR:
        return ""
    network = WalkNetwork.read(net_file)
    place = network.nearest_place(*middle)
    text = f"--spawn-area {','.join(f'{number:g}' for number in config.spawn_area)}: "
    if place is None or start.distance(shapely.Point(place)) > _NO_WALKWAY:
        text += "there is no walkway, and "
    text += f"its pedestrians come no nearer than {apart[nearest]:.0f} m to the ego's way"
    return f"{text}; the nearest place beside it: {beside(ways[nearest], network, middle).flags}"


def flow_remark(flows: Sequence[FlowConfig], ways: Sequence[Array]) -> str:
    """Return a remark on flows whose people meet no ego, or an empty text.

    Args:
        flows: Flows of people.
        ways: Path (k, 2) [m] of each ego, from its departure to its goal.
    """
    if not flows:
        return ""
    driven = shapely.MultiLineString(list(ways))
    apart = [
        float(shapely.LineString([start, *through, end]).distance(driven))
        for flow in flows
        for through in [[middle_of(place) for place in flow.via]]
        for start in corners(flow.start)
        for end in corners(flow.to)
    ]
    if min(apart) <= _NEAR:
        return ""
    return (
        f"flow '{flows[0].name}': people of flows come no nearer than {min(apart):.0f} m to the "
        "ego's way; their 'from' and 'to' are in the network's coordinates [m]"
    )


def way_of(vertices: Array, stations: Array, first: float, last: float) -> Array:
    """Return the part (k, 2) [m] of a path between two stations [m]."""
    inside = (stations > first) & (stations < last)
    at = np.concatenate([[first], stations[inside], [max(last, first + 1e-3)]])
    return points_at(vertices, stations, at)
