"""On a map, cars and people are drawn at random, and the ego meets most crossings."""

from __future__ import annotations

import tomllib
from typing import TYPE_CHECKING
from xml.etree import ElementTree

import pytest

from giveway.errors import ScenarioError
from giveway.scenario_builder.city import Demand, map_traffic
from sumo_scenarios import find

if TYPE_CHECKING:
    from pathlib import Path

JUNCTION = find("junction").folder / "junction.net.xml"


def test_the_ego_is_the_car_that_passes_most_crossings() -> None:
    files = map_traffic(JUNCTION, "town", Demand(people=0.0, duration=120.0))
    (ego,) = tomllib.loads(files["town.giveway.toml"])["ego"]["take_over"]
    cars = {car.get("id"): car for car in ElementTree.fromstring(files["town.cars.rou.xml"])}
    assert float(cars[ego].get("depart", "nan")) >= 60.0
    assert "town.people.rou.xml" not in files


def test_people_alone_leave_no_vehicle_to_drive() -> None:
    files = map_traffic(JUNCTION, "town", Demand(vehicles=0.0, duration=60.0))
    assert "ego" not in tomllib.loads(files["town.giveway.toml"])
    assert len(ElementTree.fromstring(files["town.people.rou.xml"]).findall("person")) > 10


def test_a_network_without_ways_is_refused(tmp_path: Path) -> None:
    (tmp_path / "empty.net.xml").write_text("<net></net>")
    with pytest.raises(ScenarioError, match=r"randomTrips\.py finds no trips of cars"):
        map_traffic(tmp_path / "empty.net.xml", "town", Demand(people=0.0))
