"""Where people wait for their light: along the kerb, and beside the roadway."""

from __future__ import annotations

import itertools
from collections import defaultdict
from typing import TYPE_CHECKING

import numpy as np

from pedestrian_model import Crowd, CrowdModel, Surroundings, Vehicles
from tests.giveway.walkways.conftest import kerb_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from giveway.walkways import WalkNetwork, WalkRoute


def waits_of(network: WalkNetwork) -> Iterator[tuple[WalkRoute, int]]:
    """Where people wait on the ways from one edge into another: the way, and which way-point."""
    edges = network._survey.edges
    for pair in itertools.permutations(edges, 2):
        x, y = edges[pair[0]].lane.shape.mean(axis=0)
        route = network.route(
            list(pair),
            position=(float(x), float(y)),
            lane=f"{pair[0]}_0",
            arrival_position=50.0,
            offset_side=0.0,
        )
        if route.gaps == 0:
            yield from ((route, wait) for wait in np.flatnonzero(route.signals >= 0))


def test_one_waits_along_the_kerb_whichever_way_one_comes(grid: WalkNetwork) -> None:
    waits = 0
    for route, wait in waits_of(grid):
        _, across = kerb_of(grid, route, wait)
        np.testing.assert_allclose(route.passages[wait, :2], across, atol=1e-6)
        waits += 1
    assert waits > 50


def test_who_waits_in_a_crowd_is_not_pushed_far_onto_the_roadway(grid: WalkNetwork) -> None:
    model, closed = CrowdModel(), Surroundings(closed=np.ones(len(grid.signals), dtype=bool))
    meeting = defaultdict(dict)  # those who come to the same place by different ways
    for route, wait in waits_of(grid):
        if wait > 0:
            before = tuple(route.waypoints[wait - 1].round(1))
            meeting[tuple(route.waypoints[wait].round(1))][before] = route, wait
    crowds = [list(comers.values()) for comers in meeting.values() if len(comers) > 1]
    assert len(crowds) > 20
    for comers in crowds:
        starts, ways = [], []
        for route, wait in comers:
            step = route.waypoints[wait] - route.waypoints[wait - 1]
            for behind in (0.5, 1.2, 1.9):  # three of them, one behind the other
                starts.append(route.waypoints[wait - 1] - behind * step / np.hypot(*step))
                whole = route.waypoints, route.passages, route.signals
                ways.append([array[wait:] for array in whole])
        waypoints, passages, signals = zip(*ways, strict=True)
        crowd = Crowd.create(
            starts,
            np.zeros((len(starts), 2)),
            1.4,
            waypoints,
            passages=passages,
            signals=signals,
        )
        kerb, across = kerb_of(grid, *comers[0])
        for _ in range(800):
            model.advance(crowd, Vehicles.empty(), closed)
        assert ((crowd.position - kerb) @ across < 0.6).all()  # 1.4 m on a line along their way
