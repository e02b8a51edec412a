"""Our ways against those that SUMO's own people walk."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import shapely

from giveway.walkways import WalkNetwork

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from giveway.walkways import WalkRoute

EVERY = 15  # steps: besides their beginning, walks are also looked at on the way
NAMES = ["grid", "spider", "random", "bundled city"]


@pytest.fixture
def city_or(built: Callable[[str], Any], bundled_city: Path) -> Callable[[str], WalkNetwork]:
    def network(name: str) -> WalkNetwork:
        if name == "bundled city":
            return WalkNetwork.read(bundled_city.parent / "fokr_bs_demo" / "fokr_bs.net.xml.gz")
        found: WalkNetwork = built(name).network
        return found

    return network


def taken_over(
    network: WalkNetwork, walks: list[dict[str, Any]], every: int
) -> Iterator[tuple[dict[str, Any], int, WalkRoute]]:
    """Each walk from its beginning, and from places on the way: our way from there."""
    for walk in walks:
        for i in range(0, len(walk["places"]), every):
            x, y, lane = walk["places"][i]
            route = network.route(
                remaining(network, walk, i),
                position=(x, y),
                lane=lane,
                arrival_position=walk["arrival"],
            )
            yield walk, i, route


def remaining(network: WalkNetwork, walk: dict[str, Any], i: int) -> list[str]:
    """The edges not yet left behind at the i-th place; in a junction the last one stays."""
    passed = [lane.rpartition("_")[0] for _, _, lane in walk["places"][: i + 1]]
    at = 0
    for edge in passed:
        if edge in walk["edges"][at:]:
            at = walk["edges"].index(edge, at)
    return walk["edges"][at:]


def same_crossings(network: WalkNetwork, walk: dict[str, Any], i: int, route: WalkRoute) -> bool:
    """Whether our way takes the crossings that SUMO's walker then took."""
    line = shapely.LineString([walk["places"][i][:2], *route.waypoints])
    theirs = {lane.rpartition("_")[0] for _, _, lane in walk["places"][i + 1 :]}
    middles = [
        shapely.LineString(network._survey.crossings[edge].shape).interpolate(0.5, normalized=True)
        for edge in theirs & network._survey.crossings.keys()
    ]
    return all(line.distance(middle) < 2.5 for middle in middles)


@pytest.mark.parametrize("name", NAMES)
def test_ways_are_connected_and_stay_where_people_walk(
    city_or: Callable[[str], WalkNetwork], sumo_walks: Callable[[str], Any], name: str
) -> None:
    network = city_or(name)
    room = network.walkable.buffer(0.1)
    shapely.prepare(room)
    looked_at = 0
    for walk, i, route in taken_over(network, sumo_walks(name)["walks"], EVERY):
        assert route.gaps == 0
        x, y, lane = walk["places"][i]
        # SUMO's people cut the corners of walkingareas, where they may be outside.
        start = [] if ":" in lane else [(x, y)]
        points = np.array([*start, *route.waypoints])
        if len(points) > 1:
            assert room.covers(shapely.LineString(points)), (lane, walk["edges"])
        looked_at += 1
    assert looked_at > 100


@pytest.mark.parametrize("name", NAMES)
def test_sumos_people_walk_where_ours_would(
    city_or: Callable[[str], WalkNetwork], sumo_walks: Callable[[str], Any], name: str
) -> None:
    network = city_or(name)
    apart: list[float] = []
    same = []
    for walk, i, route in taken_over(network, sumo_walks(name)["walks"], 10**9):
        same.append(same_crossings(network, walk, i, route))
        if same[-1]:
            line = shapely.LineString([walk["places"][i][:2], *route.waypoints])
            places = shapely.points([place[:2] for place in walk["places"]])
            apart += shapely.distance(line, places).tolist()
    # Where two ways are equally long SUMO's people also heed the lights.
    assert np.mean(same) > 0.6
    assert np.mean(apart) < 1.5
    assert np.mean(np.array(apart) > 4.0) < 0.01


@pytest.mark.parametrize("name", ["grid", "bundled city"])
def test_walkers_on_a_lane_are_nearest_to_that_lane(
    city_or: Callable[[str], WalkNetwork], sumo_walks: Callable[[str], Any], name: str
) -> None:
    network = city_or(name)
    for walk in sumo_walks(name)["walks"]:
        for x, y, lane in walk["places"][::EVERY]:
            if not lane.startswith(":"):
                nearest = network.nearest_lane(x, y)
                assert nearest is not None
                assert nearest.lane == lane
                length = network._survey.edges[nearest.edge].lane.length
                assert 0.0 <= nearest.position <= length + 1e-9
