"""A road with heights: the vehicle FMU is told its grade, and the ego's table has it."""

from __future__ import annotations

import importlib.util
import json
import math
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import pytest

import giveway
from giveway.errors import VehicleError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

UP = ("ab", "bc", "cd")
DOWN = ("dc", "cb", "ba")
RAMP = math.atan(0.05)  # [rad] from x = 60 m to x = 160 m
PROFILE = """
[fmu]
self_check = false
[inputs.force]
variable = "force"
[outputs.speed]
variable = "speed"
[outputs.position]
variable = "position"
[initial.speed]
variable = "v0"
"""
GRADE = '[inputs.grade]\nvariable = "grade"\n'
PERCENT = '[inputs.grade]\nvariable = "steepness"\n'


@pytest.fixture(scope="module")
def hill(tmp_path_factory: pytest.TempPathFactory, call_sumo: Callable[..., str]) -> Path:
    """60 m on the level, 100 m with 5 %, 60 m on the level; both ways."""
    folder = tmp_path_factory.mktemp("hill")
    nodes = [("a", 0, 0), ("b", 60, 0), ("c", 160, 5), ("d", 220, 5)]
    (folder / "n.nod.xml").write_text(
        "<nodes>"
        + "".join(f'<node id="{n}" x="{x}" y="0" z="{z}"/>' for n, x, z in nodes)
        + "</nodes>"
    )
    edges = "".join(f'<edge id="{e}" from="{e[0]}" to="{e[1]}"/>' for e in (*UP, *DOWN))
    (folder / "e.edg.xml").write_text(f"<edges>{edges}</edges>")
    net = folder / "hill.net.xml"
    call_sumo("netconvert", "-n", "n.nod.xml", "-e", "e.edg.xml", "-o", net, cwd=folder)
    return net


@pytest.fixture(scope="module")
def driven(zoo: Any, hill: Path, tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Any]:
    """Drive a car that feels the road over the hill, without anybody on it; equal ones once."""
    if importlib.util.find_spec("pythonfmu3") is None:
        pytest.skip("pip install pythonfmu3")

    config = hill.with_name("hill.sumocfg")
    config.write_text(
        '<configuration><net-file value="hill.net.xml"/><end value="200"/>'
        '<step-length value="0.1"/></configuration>'
    )

    @cache
    def drive(more: str = GRADE, route: tuple[str, ...] = UP) -> Any:
        folder = tmp_path_factory.mktemp("driven")
        profile = folder / "car.toml"
        profile.write_text(PROFILE + more, encoding="utf-8")
        result = giveway.run(
            {
                "scenario": str(config),
                "controller": "pid-paper",
                "vehicle": {"fmu": str(zoo.hill_car()), "profile": str(profile)},
                "ego": {"route": route, "initial_speed": 4.0},
                "crowd": {"zone": "none", "pedestrians": 0},
                "sumo.baseline": False,
            },
            results=folder / "run",
            pictures=False,
        )
        return result, folder / "run"

    return drive


def test_uphill_is_slower_and_downhill_is_faster(driven):
    drives = driven(), driven(route=DOWN)
    up, down = (pd.read_csv(folder / "ego.csv") for _, folder in drives)
    on_ramp = up["x"].between(70.0, 155.0)
    assert up["road_grade"][on_ramp].to_numpy() == pytest.approx(RAMP, abs=1e-4)
    assert up["road_grade"][up["x"] < 59.0].to_numpy() == pytest.approx(0.0, abs=1e-6)
    assert up["road_grade"][up["x"] > 170.0].to_numpy() == pytest.approx(0.0, abs=1e-6)
    assert down["road_grade"][down["x"].between(65.0, 150.0)].to_numpy() == pytest.approx(
        -RAMP, abs=1e-4
    )
    level = up["speed"].iloc[200]
    assert up["speed"].min() < level - 0.1 < level + 0.1 < down["speed"][down["x"] < 155.0].max()
    assert up["speed"].idxmin() > on_ramp.idxmax()


def test_the_fmu_is_told_the_grade_of_its_step(driven):
    ego = driven()[0].egos[0]
    track, outputs = ego.track, {o.name: o.values for o in ego.outputs}
    grade = outputs["road_grade"]
    rate = (track.force - 100.0 * track.speed) / 1000.0 - 9.81 * np.sin(grade)
    assert track.speed[1:] == pytest.approx(track.speed[:-1] + 0.05 * rate[:-1], abs=1e-9)


def test_per_cent_are_the_tangent(driven):
    speeds = [result.egos[0].track.speed for result, _ in (driven(), driven(PERCENT))]
    assert speeds[1] == pytest.approx(speeds[0], abs=1e-9)


def test_an_fmu_without_a_grade_input_drives_level_with_a_remark(driven):
    (result, _), (told, _) = driven(""), driven()
    blind, feeling = result.egos[0].track.speed, told.egos[0].track.speed
    assert np.ptp(blind[200:]) < 0.03  # on the level, too
    assert feeling[200:].min() < blind.min() - 0.05
    assert any("up to 5.0 % steep" in remark for remark in result.remarks)
    assert not any("steep" in remark for remark in told.remarks)


def test_the_column_has_a_meaning(driven):
    package = json.loads((driven()[1] / "datapackage.json").read_text(encoding="utf-8"))
    (ego,) = (r for r in package["resources"] if r["path"] == "ego.csv")
    (field,) = (f for f in ego["schema"]["fields"] if f["name"] == "road_grade")
    assert field["unit"] == "rad"


def test_a_level_net_has_no_such_column():
    result = giveway.run({"controller": "pid-paper", "time_limit": 0.5})
    assert result.egos[0].outputs == ()


def test_an_unit_that_is_no_grade_is_refused(driven):
    with pytest.raises(VehicleError, match="'grade' is in 'N', a force, and not an angle"):
        driven(GRADE + 'unit = "N"\n')
