"""Left alone, the scenario is SUMO's own to the byte; and it is never touched."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import pytest

import giveway
from giveway.run_data.progress import Ending
from sumo_scenarios import find

if TYPE_CHECKING:
    from pathlib import Path


Drive = Callable[..., tuple[Any, Any]]  # the result of a run, and what was seen on the way
Give = Callable[..., Any]  # a completed process
_HEADER = re.compile(rb"<!-- generated on .*?-->", re.DOTALL)
ALONE = (
    "--no-ego",
    "--zone",
    "none",
    "--pedestrians",
    "0",
    "--sumo-outputs",
    "fcd",
    "--no-pictures",
    "-q",
)
OWN_SEED = ("--sumo-seed", "scenario")


def content(file: Path) -> bytes:
    """An output without its header, which holds the date and the command."""
    text, headers = _HEADER.subn(b"", file.read_bytes(), count=1)
    assert headers == 1, file
    return text


@pytest.mark.parametrize(
    ("name", "until"), [("city", 150), ("demonstration", 54_150), ("street", 60), ("junction", 60)]
)
def test_without_control_the_traffic_is_sumos_own_to_the_byte(
    type_here: Give,
    call_sumo: Callable[..., str],
    city: Callable[[float], Path],
    demonstration: Path,
    tmp_path: Path,
    name: str,
    until: int,
) -> None:
    made = {"city": city(0.1), "demonstration": demonstration}
    config = made[name] if name in made else find(name).config_file
    end = ("--sumo-options", f"--end {until}")
    done = type_here("run", config, *ALONE, *OWN_SEED, *end, "--out", "ours", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    fcd = tmp_path / "plain.xml"
    plain = ("sumo", "-c", config, "--end", until, "--fcd-output", fcd, "--no-step-log")
    redirected = ("--tripinfo-output", tmp_path / "t.xml") if name == "city" else ()
    copy = tmp_path / "copy"
    if name == "city":  # plain SUMO writes beside the scenario
        shutil.copytree(config.parent, copy)
        plain = ("sumo", "-c", copy / config.name, *plain[3:])
    call_sumo(*plain, *redirected, cwd=tmp_path)
    assert content(tmp_path / "ours" / "sumo" / "fcd.xml") == content(fcd)
    assert fcd.stat().st_size > 30_000
    if name == "city":  # its own outputs are the same, too
        edges = tmp_path / "ours" / "sumo" / "edges.xml"
        assert content(edges) == content(copy / "edges.xml")
        trips = tmp_path / "ours" / "sumo" / "trips.out.xml"
        assert content(trips) == content(tmp_path / "t.xml")


def test_a_scenario_in_a_read_only_folder_runs_unchanged(
    town: Path, tmp_path: Path, unchanged: Callable[[Path], None], type_here: Give
) -> None:
    folder = tmp_path / "read only"
    shutil.copytree(town, folder)
    unchanged(folder)
    folder.chmod(0o555)
    out = tmp_path / "out"
    words = (
        "--ego",
        "car10",
        "--zone",
        "everywhere",
        "--walls",
        "--time-limit",
        5,
        "--sumo-outputs",
        "fcd",
    )
    try:
        done = type_here("run", folder / "city_1.sumocfg", *words, "--out", out, cwd=tmp_path)
    finally:
        folder.chmod(0o755)
    assert done.returncode == 0, done.stderr
    names = {"edges.xml", "trips.out.xml", "fcd.xml"}
    assert {file.name for file in (out / "sumo").iterdir()} == names
    if os.geteuid():
        assert not os.access(folder / "new", os.W_OK)


@pytest.mark.parametrize("name", ["city", "demonstration"])
def test_no_file_of_a_scenario_is_touched(
    city: Callable[[float], Path],
    demonstration: Path,
    unchanged: Callable[[Path], None],
    tmp_path: Path,
    name: str,
) -> None:
    config = city(0.05) if name == "city" else demonstration
    unchanged(config.parent)
    crowd = {"zone": "everywhere", "walls": name == "city"}
    giveway.run(
        {"scenario": str(config), "ego": {"none": True}, "crowd": crowd, "time_limit": 3.0},
        results=tmp_path / "out",
        pictures=False,
    )


@pytest.mark.parametrize(("step", "time_step"), [(1, 0.05), (0.1, 0.05), (0.05, 0.05)])
def test_begin_end_and_step_are_the_scenarios(
    drive: Drive, city: Callable[[float], Path], step: float, time_step: float
) -> None:
    config = {
        "ego": {"none": True},
        "crowd": {"zone": "none"},
        "sumo": {"options": ["--end", "100"]},
    }
    result, look = drive(city(step), **config)
    assert (result.time[0], result.time[-1]) == (90.0, pytest.approx(100.0))
    assert result.ending is Ending.SCENARIO_END
    assert look.times[1] - look.times[0] == pytest.approx(step)
    assert result.manifest["sumo"]["step_length"] == step
    assert result.manifest["time_step"] == pytest.approx(time_step)


def test_without_an_end_a_run_ends_when_everybody_has_arrived(
    drive: Drive, scenario: Callable[..., Path]
) -> None:
    config = scenario(
        """<trip id="car" depart="0" from="A0B0" to="B0C0"/>
        <person id="p" depart="3"><walk edges="A0B0" departPos="10" arrivalPos="50"/></person>""",
        end=-1,
    )
    for ego in ({"none": True}, {"take_over": ("car",)}):
        slowly = {"reference_speed": 4.0}
        result, look = drive(config, ego=ego, crowd={"zone": "everywhere"}, regulation=slowly)
        assert 15.0 < result.time[-1] < 150.0
        if ego == {"none": True}:
            assert result.ending is Ending.SCENARIO_END
            assert look.arrived == {"p": 1}


def test_settings_for_teleports_are_kept(drive: Drive, scenario: Callable[..., Path]) -> None:
    block = """<vehicle id="block" depart="0" departPos="60"><route edges="A0B0"/>
        <stop lane="A0B0_1" endPos="60" duration="500"/></vehicle>
        <vehicle id="stuck" depart="1" departPos="10" departLane="1"><route edges="A0B0 B0C0"/>
        <stop lane="A0B0_1" endPos="75" duration="1"/></vehicle>"""
    seen = {}
    for seconds in (5, 100):
        options = f'<time-to-teleport value="{seconds}"/><lanechange.duration value="99"/>'
        config = scenario(block, options, end=40)
        result, _ = drive(config, ego={"none": True}, crowd={"zone": "none"})
        seen[seconds] = result.sumo_messages
    assert "Teleporting vehicle 'stuck'" in seen[5]
    assert "Teleporting" not in seen[100]


def test_the_seed_is_the_scenarios_unless_asked_for(
    drive: Drive, city: Callable[[float], Path]
) -> None:
    plain = {"ego": {"none": True}, "crowd": {"zone": "none"}, "time_limit": 40.0}
    own, look = drive(city(0.1), **plain)
    same, again = drive(city(0.1), seed=99, **plain)
    _, changed = drive(city(0.1), sumo={"seed": 7}, **plain)
    assert own.manifest["sumo"]["seed"] == same.manifest["sumo"]["seed"]
    assert look.cars == again.cars
    assert look.cars != changed.cars
