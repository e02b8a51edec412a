"""Speeds that a scenario gives to single walks, read from its files."""

from __future__ import annotations

import gzip
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest

from giveway.sumo.persons.walk_speeds import WalkSpeeds

if TYPE_CHECKING:
    from pathlib import Path

PLANS = """<routes>
    <vType id="t"/>
    <person id="own" depart="0">
        <walk from="a" to="b" speed="0.7"/>
        <stop edge="b" duration="5"/>
        <walk edges="b c" duration="50"/>
    </person>
    <personFlow id="flow.1" begin="0" end="9" period="3">
        <walk from="a" to="b" speed="1.1"/>
    </personFlow>
    <person id="plain" depart="0"><walk from="a" to="b"/></person>
    <person id="trip" depart="0">
        <walk from="a" to="b" speed="0.7"/>
        <personTrip from="b" to="d"/>
    </person>
    <person id="odd" depart="0"><walk from="a" to="b" duration="0:01:00"/></person>
    <vehicle id="car" depart="0"/>
</routes>"""


def stage(end: str, length: float = 100.0) -> Any:
    return SimpleNamespace(edges=("a", end), length=length, destStop="")


@pytest.fixture(params=["plain", "gzipped"])
def speeds(request: pytest.FixtureRequest, tmp_path: Path) -> WalkSpeeds:
    file = tmp_path / "plans.rou.xml"
    data = PLANS.encode()
    file.write_bytes(gzip.compress(data) if request.param == "gzipped" else data)
    return WalkSpeeds([file])


def test_a_speed_is_the_walks(speeds: WalkSpeeds) -> None:
    assert speeds.speed("own", stage("b"), 3) == 0.7


def test_a_duration_is_spread_over_the_walks_length(speeds: WalkSpeeds) -> None:
    assert speeds.speed("own", stage("c", 75.0), 1) == 1.5


def test_a_flows_persons_have_its_speed(speeds: WalkSpeeds) -> None:
    assert speeds.speed("flow.1.0", stage("b"), 1) == 1.1
    assert speeds.speed("flow.1.12", stage("b"), 1) == 1.1


@pytest.mark.parametrize("name", ["plain", "nobody", "odd", "car", "flow"])
def test_who_has_none_is_given_none(speeds: WalkSpeeds, name: str) -> None:
    assert speeds.speed(name, stage("b"), 1) is None


def test_a_split_trip_is_not_taken_for_the_walk_before_it(speeds: WalkSpeeds) -> None:
    assert speeds.speed("trip", stage("b"), 2) == 0.7
    assert speeds.speed("trip", stage("x"), 2) is None  # the first of the trip's two walks
    assert speeds.speed("trip", stage("x"), 3) is None


def test_missing_or_broken_files_are_left_to_sumo(tmp_path: Path) -> None:
    broken = tmp_path / "broken.rou.xml"
    broken.write_text('<routes><person id="a"><walk speed="1"')
    assert WalkSpeeds([tmp_path / "missing.xml", broken]).speed("a", stage("b"), 1) is None
