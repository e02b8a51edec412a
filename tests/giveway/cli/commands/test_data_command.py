"""``giveway data describe`` and ``giveway data measure`` as a user types them."""

from __future__ import annotations

import pandas as pd
import pytest

from giveway.cli import main


def giveway(*words: object) -> int:
    with pytest.raises(SystemExit) as end:
        main([str(word) for word in words])
    return int(end.value.code or 0)


def test_describe_prints_tables_and_citation_and_writes_csv(recorded_crossing, tmp_path, capsys):
    folder, description = recorded_crossing
    out = tmp_path / "out"
    assert giveway("data", "describe", folder, "--dataset", description, "--out", out) == 0
    said = capsys.readouterr().out
    for words in ("a straight street", "total", "person in a vehicle", "Please cite: Nobody 2026"):
        assert words in said
    assert pd.read_csv(out / "recordings.csv")["encounters"].tolist() == [4, 4]
    assert pd.read_csv(out / "defects.csv")["count"].tolist() == [1]


def test_measure_prints_the_summary_and_writes_all_tables(recorded_crossing, tmp_path, capsys):
    folder, description = recorded_crossing
    out = tmp_path / "out"
    words = ("data", "measure", folder, "--dataset", description)
    assert giveway(*words, "--out", out) == 0
    said = capsys.readouterr().out
    assert "Of 4 people near 1 of 1 vehicles" in said
    assert "closer than 0.5 m at more than 2 m/s" in said
    assert "50.0%" in said
    assert "mean, top [m/s]" in said
    tables = {name: pd.read_csv(out / f"{name}.csv") for name in ("vehicles", "people", "summary")}
    assert tables["vehicles"]["close"].tolist() == [2]
    assert tables["people"]["first"].fillna("").tolist() == ["", "", "", "person"]
    assert tables["summary"]["count"].tolist() == [2, 1, 0, 1, 1]
    assert giveway(*words, "--out", out) == 2
    assert "--force" in capsys.readouterr().err
    assert giveway(*words, "--out", out, "--force", "--quiet") == 0
    assert capsys.readouterr().out == ""


def test_one_vehicle_lists_its_people(recorded_crossing, capsys) -> None:
    folder, description = recorded_crossing
    words = ("data", "measure", folder, "--dataset", description, "--vehicle")
    assert giveway(*words, "car") == 0
    assert "People within 4 m" in capsys.readouterr().out
    assert giveway(*words, "bus") == 2
    error = capsys.readouterr().err
    assert "--vehicle bus: no such id; expected one of car, parked" in error
    assert error.count("\n") == 1


def test_a_folder_without_recordings_says_what_was_expected(tmp_path, capsys) -> None:
    assert giveway("data", "describe", tmp_path, "--dataset", "sind") == 2
    error = capsys.readouterr().err
    assert f"{tmp_path}: no recording found; expected files Ped_smoothed_tracks.csv" in error
    assert giveway("data", "describe", tmp_path) == 2
    assert "--dataset: missing; expected one of citr, deepscenario" in capsys.readouterr().err
