"""Arrivals: people who come in during a run."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from support.flows import NORTH, PLAZA, STREET, with_crowd

import giveway
import sumo_scenarios
from giveway.errors import ConfigError
from pedestrian_model import PLAIN_MODELS


def entrances(result: giveway.RunResult) -> dict[str, tuple[float, ...]]:
    """When and where everybody was seen first."""
    first = result.trajectories.query("type == 'pedestrian'").drop_duplicates("id")
    return {row.id: (row.time, row.x, row.y) for row in first.itertuples()}


@pytest.mark.parametrize("config", [PLAZA, STREET], ids=["open ground", "a street"])
def test_whoever_drives_meets_the_same_people_at_the_same_time(config: dict) -> None:
    record = {"near": 500.0}
    runs = [
        giveway.run({**config, "controller": name, "record": record})
        for name in ("mpc", "pid-tuned")
    ]
    known, others = (entrances(run) for run in runs)
    shorter = min(run.time[-1] for run in runs)
    common = {name for name, (time, *_) in known.items() if time < shorter}
    assert len(common) > 10
    assert any(known[name][0] > runs[0].time[0] for name in common)  # some came in later
    for name in common:
        assert known[name] == others[name]


@pytest.mark.parametrize("model", ["vci", *PLAIN_MODELS])
def test_they_come_whatever_moves_them(model: str) -> None:
    kinds = {"elderly": 0.3, "distracted": 0.3}
    crowd = {"model": model, "groups": 0.5, "people": kinds}
    result = giveway.run(with_crowd(PLAZA, **crowd))
    table = result.pedestrians
    assert result.ending == "completed"
    assert set(table["kind"]) == {"adult", "elderly", "distracted"}
    grouped = table[table["group"] != ""]
    assert 0.2 < len(grouped) / len(table) < 0.8
    assert grouped.groupby("group").size().between(2, 5).all()
    counts = result.manifest["pedestrians"]
    assert counts["added"] == len(table) == counts["arrived"] + counts["walking"]
    assert counts["arrived"] > 0


@pytest.fixture
def endless(tmp_path: Path) -> dict:
    """The plaza as a scenario without an end, in steps of 1 s, where nobody drives."""
    net = Path(sumo_scenarios.__file__).parent / "shared_space/shared_space.net.xml"
    config = tmp_path / "endless.sumocfg"
    config.write_text(f'<configuration><net-file value="{net}"/></configuration>')
    return {**PLAZA, "scenario": str(config), "ego": {"none": True, "route": ["plaza"]}}


def test_without_an_ego_the_run_ends_when_all_have_arrived(endless: dict) -> None:
    flow = {**NORTH, "begin": 5.0, "end": 15.0}
    result = giveway.run(with_crowd(endless, flow=[flow]))
    counts = result.manifest["pedestrians"]
    assert counts["walking"] == 0
    assert counts["added"] == counts["arrived"] == len(result.pedestrians) > 2
    assert result.pedestrians["first_seen"].min() >= 5.0
    assert result.pedestrians["first_seen"].max() <= 16.0
    assert 30.0 < result.time[-1] < 80.0
    walked = result.pedestrians["path_length"]
    assert walked.between(29.0, 40.0).all()  # from the line to the rectangle


def test_a_run_that_would_not_end_is_refused(endless: dict) -> None:
    with pytest.raises(ConfigError, match="flow 'north': its people keep coming"):
        giveway.run(endless)
    assert giveway.run({**endless, "time_limit": 3.0}).ending == "time limit"


def test_they_are_persons_of_sumo_for_its_own_outputs(tmp_path: Path) -> None:
    config = {**STREET, "sumo": {"outputs": ["fcd"]}, "time_limit": 12.0}
    result = giveway.run(config, results=tmp_path / "run", pictures=False)
    (fcd,) = (tmp_path / "run" / "sumo").rglob("*fcd*")
    seen = set(re.findall(r'<person id="(across\.\d+)"', fcd.read_text()))
    stayed = result.pedestrians.query("last_seen > first_seen + 2.0")["id"]  # two of SUMO's steps
    assert set(stayed) <= seen
    assert len(stayed) >= 5
