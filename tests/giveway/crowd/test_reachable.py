"""A spawn area from which nobody comes near the ego is named, with a place from which people do."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
import shapely

import giveway
from giveway.config.tables.crowd import CrowdConfig
from giveway.config.tables.flows import read_flows
from giveway.crowd.reachable import flow_remark, spawn_remark, way_of
from giveway.walkways import WalkNetwork, beside

if TYPE_CHECKING:
    from pathlib import Path

WAY = np.array([[10.0, -1.6], [110.0, -1.6]])  # the southern street of the city


@pytest.fixture(scope="module")
def net_file(small_city: Path) -> Path:
    return small_city.with_name("net.net.xml.gz")


def remark(net_file: Path, area: tuple[float, ...], walk: tuple[float, float]) -> str:
    return spawn_remark(CrowdConfig(spawn_area=area, walk=walk), [WAY, WAY + 5.0], net_file)


def test_people_who_walk_over_the_ego_s_way_or_near_it_are_fine(net_file: Path) -> None:
    assert remark(net_file, (40.0, -50.0, 50.0, -40.0), (0.0, 60.0)) == ""
    assert remark(net_file, (40.0, -30.0, 50.0, -20.0), (0.0, 5.0)) == ""


def test_an_area_far_from_the_way_is_told_with_the_nearest_place(net_file: Path) -> None:
    text = remark(net_file, (200.0, 235.0, 210.0, 245.0), (0.0, 10.0))
    assert text.startswith("--spawn-area 200,235,210,245: its pedestrians come no nearer than 2")
    assert "the nearest place beside it: --spawn-area=" in text
    assert "no walkway" not in text


def test_an_area_where_nobody_can_walk_is_named(net_file: Path) -> None:
    text = remark(net_file, (50.0, -900.0, 60.0, -890.0), (0.0, 30.0))
    assert "there is no walkway, and its pedestrians come no nearer than 8" in text


@pytest.mark.parametrize("near", [None, (60.0, -900.0), (-500.0, 0.0), (500.0, 0.0)])
def test_the_place_beside_a_way_is_walkable_and_people_cross(
    net_file: Path, near: tuple[float, float] | None
) -> None:
    network = WalkNetwork.read(net_file)
    place = beside(WAY, network, near)
    start = shapely.box(*place.area)
    assert network.walkable.contains(start.centroid)
    x, y = start.centroid.x, start.centroid.y
    crossing = shapely.LineString([(x, y), (x + place.walk[0], y + place.walk[1])])
    assert crossing.crosses(shapely.LineString(WAY))
    if near == (60.0, -900.0):
        assert x == pytest.approx(60.0, abs=0.1)


def test_the_way_is_the_part_of_the_path_that_is_driven() -> None:
    vertices = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 20.0]])
    way = way_of(vertices, np.array([0.0, 10.0, 30.0]), 4.0, 15.0)
    assert way.tolist() == [[4.0, 0.0], [10.0, 0.0], [10.0, 5.0]]


def test_a_run_says_so_and_its_advice_brings_people_to_the_ego(small_city: Path) -> None:
    settings = {
        "scenario": str(small_city),
        "ego": {"route": ("B1C1", "C1D1"), "depart_time": 15.0},
        "crowd": {"pedestrians": 5, "zone": "none", "spawn_area": (0.0, 340.0, 9.0, 350.0)},
        "rules": {"traffic_lights": False},
        "controller": "pid-tuned",
        "time_limit": 14.0,
    }
    far = giveway.run(settings)
    (advice,) = [text for text in far.remarks if text.startswith("--spawn-area")]
    assert far.summary["minimum_clearance"] > 150.0
    words = dict(word.lstrip("-").split("=") for word in advice.split() if "=" in word)
    crowd = {"spawn_area": words["spawn-area"], "walk": words["walk"]}
    near = giveway.run({**settings, "crowd": {**settings["crowd"], **crowd}})
    assert [text for text in near.remarks if text.startswith("--spawn-area")] == []
    assert near.summary["minimum_clearance"] < 10.0


def test_flows_that_no_ego_meets_are_named_unless_one_does() -> None:
    far = {"from": [40.0, 90.0, 50.0, 95.0], "to": [[80.0, 60.0], [90.0, 60.0]], "rate": 100.0}
    across = {"from": [40.0, 20.0, 50.0, 25.0], "to": [45.0, -20.0], "rate": 100.0}
    back = {"from": [40.0, 90.0, 50.0, 95.0], "to": [45.0, 99.0], "rate": 1.0, "via": [[60.0, 5.0]]}
    text = flow_remark(read_flows([far]), [WAY])
    assert text.startswith("flow 'flow0': people of flows come no nearer than 62 m")
    assert flow_remark(read_flows([far, across]), [WAY]) == ""
    assert flow_remark(read_flows([back]), [WAY]) == ""  # by what it comes through
    assert flow_remark((), [WAY]) == ""
