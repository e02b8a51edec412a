"""What is wrong with a scenario or a request is said in one line, and nothing is left behind."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import giveway

CAR = '<trip id="car" depart="0" from="A0B0" to="C0D0"/>'
Scenario = Callable[..., Path]
Refuse = Callable[..., str]


@pytest.fixture
def refused(tmp_path: Path) -> Refuse:
    """The one line about a run that must fail, leaving nothing behind."""

    def run(config: Path, **settings: Any) -> str:
        out = tmp_path / "out"
        with pytest.raises(giveway.GivewayError) as failure:
            giveway.run({"scenario": str(config), **settings}, results=out, pictures=False)
        assert "\n" not in str(failure.value)
        assert not out.exists()
        return str(failure.value)

    return run


def ego(name: str) -> dict[str, Any]:
    return {"ego": {"take_over": (name,)}}


def test_on_the_command_line_it_is_one_line_too(
    scenario: Scenario, type_here: Callable[..., Any], tmp_path: Path
) -> None:
    config = scenario(CAR)
    (config.parent / "all.rou.xml").unlink()
    here = tmp_path / "here"
    here.mkdir()
    done = type_here("run", config, "--ego", "car", "--out", "out", cwd=here)
    assert done.returncode == 2
    (line,) = done.stderr.strip().splitlines()
    assert line.startswith("error: ")
    assert "small.sumocfg" in line
    assert "all.rou.xml" in line
    assert not list(here.iterdir())


def test_a_missing_network(scenario: Scenario, refused: Refuse, tmp_path: Path) -> None:
    assert "gone.net.xml" in refused(scenario(CAR, net=tmp_path / "gone.net.xml"), **ego("car"))


def test_a_route_file_that_is_cut_off(scenario: Scenario, refused: Refuse) -> None:
    config = scenario(CAR)
    (config.parent / "all.rou.xml").write_text(f"<routes>{CAR}<vehicle id=")
    assert "all.rou.xml" in refused(config, **ego("car"))


def test_a_scenario_that_does_not_exist(refused: Refuse, tmp_path: Path) -> None:
    assert "nowhere.sumocfg" in refused(tmp_path / "nowhere.sumocfg", **ego("car"))


def test_no_ego_at_all(scenario: Scenario, refused: Refuse) -> None:
    line = refused(scenario(CAR))
    assert all(word in line for word in ("small.sumocfg", "--ego ID", "--ego-route", "--no-ego"))


def test_an_ego_that_never_departs(scenario: Scenario, refused: Refuse) -> None:
    line = refused(scenario(CAR), **ego("caar"))
    assert "small.sumocfg" in line
    assert "did you mean 'car'?" in line
    late = '<trip id="late" depart="500" from="A0B0" to="C0D0"/>'
    line = refused(scenario(CAR + late, end=20), **ego("late"))
    assert "--ego late" in line
    assert "20 s" in line


def test_an_ego_that_departs_after_the_end(scenario: Scenario, refused: Refuse) -> None:
    config = scenario(CAR, end=20)
    line = refused(config, ego={"route": ("A0B0", "B0C0"), "depart_time": 30.0})
    assert "--ego-depart-time 30" in line
    assert "20 s" in line


@pytest.mark.parametrize(
    ("route", "named"),
    [
        ("A0B0,nowhere", "'nowhere'"),
        ("A0B0,C2C3", "'C2C3'"),
        ("A0B0,B0C0,B0A0", "'B0C0'"),
    ],
)
def test_a_route_that_does_not_exist_or_connect(
    scenario: Scenario, refused: Refuse, route: str, named: str
) -> None:
    assert named in refused(scenario(CAR), ego={"route": route})


@pytest.mark.parametrize(
    ("zone", "named"),
    [
        ("9000,9000 9100,9000 9100,9100", "outside of the network"),
        ("0,0 1,1", "three corners"),
        ("-5", "metres round each ego"),
        ("0,0 10,10 10,0 0,10", "not a polygon"),
        ("here", "'everywhere'"),
    ],
)
def test_a_zone_that_is_none(scenario: Scenario, refused: Refuse, zone: str, named: str) -> None:
    line = refused(scenario(CAR), crowd={"zone": zone}, **ego("car"))
    assert named in line
    assert f"--zone '{zone}'" in line


def test_a_vehicle_that_drives_where_nobody_walks(scenario: Scenario, refused: Refuse) -> None:
    config = scenario(
        '<vType id="s" vClass="ship"/><vehicle id="boat" type="s" depart="0">'
        '<route edges="A0B0"/></vehicle>',
        '<ignore-route-errors value="true"/>',
    )
    line = refused(config, **ego("boat"))
    assert "boat" in line
    assert "ship" in line


@pytest.mark.parametrize("model", ["jupedsim", "nonInteracting"])
def test_another_pedestrian_model_is_replaced_with_a_note(
    scenario: Scenario, type_here: Callable[..., Any], tmp_path: Path, model: str
) -> None:
    person = '<person id="p" depart="0"><walk edges="A0B0" arrivalPos="60"/></person>'
    config = scenario(CAR + person, f'<pedestrian.model value="{model}"/>')
    words = ("--ego", "car", "--zone", "everywhere", "--time-limit", 5, "--no-pictures")
    done = type_here("run", config, *words, "--out", tmp_path / "out", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert model in done.stdout
    assert "striping" in done.stdout


def test_a_scenario_without_anything_for_pedestrians(
    type_here: Callable[..., Any],
    scenario: Scenario,
    call_sumo: Callable[..., str],
    tmp_path: Path,
) -> None:
    net = tmp_path / "bare.net.xml"
    call_sumo("netgenerate", "--grid", "--grid.number", 3, "-o", net, cwd=tmp_path)
    walk = '<walk edges="A0B0 B0C0" departPos="50" arrivalPos="30"/>'
    person = f'<person id="p" depart="0">{walk}</person>'
    config = scenario('<trip id="car" depart="0" from="A0B0" to="B0C0"/>' + person, net=net)
    words = ("--ego", "car", "--zone", "everywhere", "--time-limit", 100, "--no-pictures")
    done = type_here("run", config, *words, "--out", tmp_path / "out", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "neither sidewalks nor walkingareas" in " ".join(done.stdout.split())


def test_a_disconnected_walk_is_walked_all_the_same_with_a_note(
    type_here: Callable[..., Any], scenario: Scenario, tmp_path: Path
) -> None:
    # SUMO's own walkers jump over the gap; ours go straight.
    walk = '<walk edges="A0B0 A1B1" departPos="70" arrivalPos="70"/>'
    config = scenario(f'<person id="p" depart="0">{walk}</person>', end=150, step=1)
    out = tmp_path / "out"
    words = ("--no-ego", "--zone", "everywhere", "--no-pictures", "--out", out)
    done = type_here("run", config, *words, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "where the network has no walkway" in " ".join(done.stdout.split())
    ledger = json.loads((out / "manifest.json").read_text())["pedestrians"]
    assert ledger["taken_over"] == ledger["arrived"] == 1


def test_a_disconnected_route_during_the_run_keeps_the_rows(
    type_here: Callable[..., Any], scenario: Scenario, tmp_path: Path
) -> None:
    late = '<vehicle id="late" depart="220"><route edges="A0B0 C2C3"/></vehicle>'
    cars = '<flow id="f" begin="0" end="300" period="5" from="A0B0" to="C0D0"/>'
    config = scenario(cars + late, end=400, step=1)
    out = tmp_path / "out"
    words = ("--no-ego", "--zone", "none", "--no-pictures", "-q", "--out", out)
    done = type_here("run", config, *words, cwd=tmp_path)
    (line,) = done.stderr.strip().splitlines()
    assert done.returncode == 1
    assert "small.sumocfg" in line
    assert "'late'" in line
    assert len((out / "trajectories.csv").read_text().splitlines()) > 100
