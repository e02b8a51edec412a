"""Feet of places on footpaths: where SUMO would have a person, and where the way leads.

The city's streets are 100 m apart; A1B1 leads east from A1 at (0, 100) to B1 at (100, 100).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import libsumo
import pytest

from giveway.sumo.network.footpaths import FootPaths

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path


@pytest.fixture(scope="module")
def paths(city: Callable[[str], Path]) -> Iterator[FootPaths]:
    net = str(city("signals"))
    libsumo.start(["sumo", "-n", net, "--no-step-log", "true"])
    yield FootPaths(libsumo)
    libsumo.close()


@pytest.mark.parametrize(
    ("along", "beside", "apart"),
    [
        (40.0, 0.3, 0.0),  # on the footpath
        (40.0, 1.9, 0.0),  # beside it: SUMO lets a person walk back
        (40.0, -3.0, 1.0),  # too far: at most 1 m beside a lane of 2 m
        (-2.0, 0.3, 2.05),  # before its beginning
        (1.0, 1.75, 1.0),  # near an end SUMO keeps people on the lane
    ],
)
def test_a_foot_tells_how_far_sumo_moves_a_person(
    paths: FootPaths, along: float, beside: float, apart: float
) -> None:
    start, *_, end = libsumo.lane.getShape("A1B1_0")
    assert start[1] == end[1]  # it leads east
    foot = paths.foot("A1B1", start[0] + along, start[1] + beside)
    assert foot is not None
    assert foot.apart == pytest.approx(apart, abs=0.01)
    x, y = libsumo.simulation.convert2D("A1B1", foot.position, 0)
    place = start[0] + along, start[1] + beside
    assert math.dist((x, y + foot.lateral), place) == pytest.approx(foot.apart, abs=0.01)


def test_the_direction_follows_from_the_junctions(paths: FootPaths) -> None:
    assert paths.forward("A1B1", "B1C1") is True
    assert paths.forward("A1B1", "A1A2") is False
    assert paths.forward("A1B1", "B1A1") is None  # both ends touch
    assert paths.end_at("A1B1", "A1") == 0.0
    assert paths.end_at("A1B1", "B1") == libsumo.lane.getLength("A1B1_0")
    assert paths.end_at("A1B1", "C1") is None
    assert paths.along("A1B1", 40.0, (2.0, 5.0)) == pytest.approx(2.0)
    assert paths.along("B1A1", 40.0, (2.0, 5.0)) == pytest.approx(-2.0)


def test_walkingareas_join_the_edges_of_their_junction_over_crossings(paths: FootPaths) -> None:
    areas = [edge for edge in libsumo.edge.getIDList() if edge.startswith(":B1_w")]
    assert len(areas) == 4
    for area in areas:
        assert paths.joins(area, "A1B1")
        assert paths.joins(area, "B1C1")
        assert not paths.joins(area, "C1D1")
    assert paths.joins("no walkingarea", "A1B1")  # nothing is known


def test_gaps_and_bends(paths: FootPaths) -> None:
    width = 2 * (100.0 - libsumo.lane.getShape("A1B1_0")[-1][0])  # of the junction
    assert paths.gap("A1B1", "B1C1") == pytest.approx(width)
    assert paths.gap("A1B1", "no such edge") == math.inf
    assert paths.is_straight("A1B1", 40.0, 2.0)
    assert not paths.is_straight("A1B1", 1.0, 2.0)
    assert not paths.is_straight("no such edge", 1.0, 2.0)
