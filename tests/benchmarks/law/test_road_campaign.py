"""A campaign drives beside plain SUMO, is resumed, and has a row for a drive that dies."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest
import road_campaign
from road_campaign import Drive as Planned
from road_campaign import configurations, draw, drive_all, numbers, read

from sumo_scenarios import find


def test_a_drive_that_is_done_is_not_done_again(tmp_path, monkeypatch, capsys) -> None:
    words = ["road_campaign", "--roads", "1", "--place", "drop", "--out", str(tmp_path)]
    monkeypatch.setattr(sys, "argv", words)
    road_campaign.main()
    table = capsys.readouterr().out
    assert "1 drives, 0.4 km, 1 with nobody near; 0 died" in table
    results = tmp_path / "drives.jsonl"
    kept = results.read_bytes()
    (row,) = read(results).values()
    assert row["arrived"]
    assert row["sumo_arrived"]
    assert row["ratio"] == pytest.approx(row["time"] / row["sumo_time"])
    assert sum(row["lost"].values()) <= row["driving_time"]
    road_campaign.main()
    assert capsys.readouterr().out == table
    assert results.read_bytes() == kept


def test_a_drive_that_dies_has_a_row_that_says_so(tmp_path: Path) -> None:
    shutil.copytree(find("junction").config_file.parent, tmp_path / "mine")
    net = tmp_path / "mine" / "junction.net.xml"
    net.write_text(net.read_text().replace('via=":zebra_0_0"', 'via=":centre_17_0"'))  # SIGSEGV
    config = str(tmp_path / "mine" / "junction.sumocfg")
    deadly = Planned("mine", config, "westbound.0", 1, "mpc")
    nobody = Planned("junction", str(find("junction").config_file), "nobody", 1, "mpc")
    drive_all([deadly, nobody], tmp_path / "drives.jsonl", 1)
    rows = read(tmp_path / "drives.jsonl")
    assert "SIGSEGV" in rows[deadly.name]["failed"]
    assert rows[nobody.name]["failed"].startswith("--ego nobody: no such vehicle")


def test_a_folder_of_folders_is_its_scenarios(tmp_path: Path) -> None:
    for name in ("b/run.sumocfg", "a/second.sumocfg", "a/first.sumocfg", "c/d/x.sumo.cfg"):
        file = tmp_path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.touch()
    (tmp_path / "notes").mkdir()
    found = [(name, str(file.relative_to(tmp_path))) for name, file in configurations(tmp_path)]
    assert found == [("a", "a/first.sumocfg"), ("b", "b/run.sumocfg"), ("d", "c/d/x.sumo.cfg")]
    assert configurations(tmp_path / "b" / "run.sumocfg")[0][0] == "run"


def test_cars_are_drawn_without_repetition_until_all_have_driven() -> None:
    drawn = draw(["a", "b", "c"], 5, 7)
    assert sorted(drawn[:3]) == [("a", 7), ("b", 7), ("c", 7)]
    assert [seed for _, seed in drawn[3:]] == [8, 8]
    assert drawn == draw(["a", "b", "c"], 5, 7)
    assert numbers("1-3,7") == [1, 2, 3, 7]
