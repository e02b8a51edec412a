"""Findings of the doctor on a city: vehicles, edges, and people that they meet."""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING, Any

import pytest

from giveway.doctor import Finding, examine_scenario

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


def about(findings: list[Finding], subject: str) -> Finding:
    (found,) = [finding for finding in findings if finding.subject == subject]
    return found


@pytest.fixture(scope="module")
def of_city(small_city: Path) -> list[Finding]:
    before = sorted(small_city.parent.iterdir())
    findings = examine_scenario(small_city)
    assert sorted(small_city.parent.iterdir()) == before
    return findings


def test_a_city_is_fit_to_drive_in(of_city: list[Finding]) -> None:
    assert {finding.level for finding in of_city} <= {"ok", "note"}
    assert "crossings" in about(of_city, "walkways").text
    assert about(of_city, "demand").text.startswith("30 vehicles and 0 flows, 60 persons")
    assert about(of_city, "traffic lights").text == "16 programs"
    assert about(of_city, "step length").text == "0.5 s, 10 control step(s) of 0.05 s"
    assert about(of_city, "time").text == "from 10 s to 80 s"


def test_it_names_vehicles_to_take_and_edges_to_drive(of_city: list[Finding]) -> None:
    ego = about(of_city, "ego")
    assert "cars" in ego.text
    assert ego.remedy.startswith("--ego=cars")
    assert "--ego-route=" in ego.remedy


def test_it_ranks_egos_routes_and_zones_by_the_people_they_meet(
    of_city: list[Finding], small_city: Path
) -> None:
    assert "counted from 10 to 80 s" in about(of_city, "people met").text
    for subject, flag in (
        ("best egos", "--ego=cars"),
        ("best routes", "--ego-route="),
        ("best zones", "--zone="),
    ):
        ranked = [finding for finding in of_city if finding.subject == subject]
        assert 1 <= len(ranked) <= 3
        for finding in ranked:
            words = shlex.split(finding.remedy)
            assert words[:3] == ["giveway", "run", str(small_city)]
            assert any(word.startswith(flag) for word in words)
    best = [finding for finding in of_city if finding.subject == "best egos"]
    people = [int(finding.text.split(" meets ")[1].partition(",")[0]) for finding in best]
    assert people == sorted(people, reverse=True)
    assert people[-1] > 0


def test_its_command_runs_and_the_ego_meets_people(
    of_city: list[Finding], type_here: Callable[..., Any], tmp_path: Path
) -> None:
    best = next(finding for finding in of_city if finding.subject == "best egos")
    words = shlex.split(best.remedy)[1:]
    out = ("--no-pictures", "--out", tmp_path / "out", "--time-limit", 15)
    done = type_here(*words, *out, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out" / "pedestrians.csv").read_text().count("\n") > 1


def test_where_they_do_not_the_commands_say_nothing_of_seeds(of_city: list[Finding]) -> None:
    assert not any("--sumo-seed" in finding.remedy for finding in of_city)
