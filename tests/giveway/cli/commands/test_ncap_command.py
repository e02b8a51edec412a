"""The command ``giveway ncap``, as a user types it: few cells, really driven."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd
import pytest

from giveway.cli.program import main
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.repeated_run import rerun

R152 = ["--protocol", "r152", "--speed", 20, "--jobs", 1]


def typed(monkeypatch, *arguments):
    monkeypatch.setattr("sys.argv", ["giveway", *map(str, arguments)])
    with pytest.raises(SystemExit) as ended:
        main()
    return ended.value.code


def test_a_car_that_brakes_is_green_and_each_cell_can_be_made_again(monkeypatch, tmp_path, capsys):
    monkeypatch.chdir(tmp_path)
    assert typed(monkeypatch, "ncap", "fmi2", *R152, "--out", "out") in {0, None}
    said = " ".join(capsys.readouterr().out.split())
    assert "UN R152, 01 series (draft values)" in said
    assert "20 50 % G" in said
    assert "largest deceleration [m/s²] without the person 20 open road G" in said
    table = pd.read_csv("out/ncap.csv")
    assert table["test"].tolist() == ["R152", "nobody"]
    hit, alone = table.to_dict("records")
    assert (hit["cell"], hit["colour"], hit["impact_speed"]) == ("c1-s1", "green", 0.0)
    assert hit["first_sight_time"] < hit["first_braking_time"]
    assert 5.0 < hit["hardest_braking"] < 10.0
    assert alone["hardest_braking"] < 0.01
    page = Path("out/ncap.html").read_text(encoding="utf-8")
    assert "no result of Euro NCAP" in page
    assert "<script" not in page
    assert hit["repeat"] == "giveway rerun out c1-s1"
    Path("out").rename("moved")
    again = rerun(StudyFolder.open("moved"), "c1-s1")  # raises an error if a number differs
    Path("moved").rename("out")
    assert again.summary["hardest_braking"] == pytest.approx(hit["hardest_braking"], abs=1e-3)
    before = {name: Path("out", name).read_bytes() for name in ("ncap.csv", "ncap.html")}
    again = ["ncap", "fmi2", *R152[:-1], 2, "--out", "out"]
    assert typed(monkeypatch, *again) == 2
    assert "go on with it by --resume" in capsys.readouterr().err
    assert typed(monkeypatch, *again, "--resume", "--json") in {0, None}
    told = json.loads(capsys.readouterr().out)
    assert (told["protocol"], told["points"]) == ("UN R152, 01 series (draft values)", None)
    assert typed(monkeypatch, *again, "--force") in {0, None}
    assert before == {name: Path("out", name).read_bytes() for name in before}


def test_a_native_crash_costs_one_cell_and_not_the_table(monkeypatch, tmp_path, capsys, zoo):
    car = zoo.car(behaviour="segfault", at=9.0)  # when the drive without a person has ended
    profile = ["--profile", car.with_suffix(".toml")]
    assert typed(monkeypatch, "ncap", car, *profile, *R152, "--out", tmp_path / "out") == 1
    assert "no result of 1 (c1-s1)" in " ".join(capsys.readouterr().out.split())
    hit, alone = pd.read_csv(tmp_path / "out" / "ncap.csv").to_dict("records")
    assert hit["colour"] == "failed"
    assert car.name in hit["failure"]
    assert alone["hardest_braking"] < 0.1


def test_a_car_whose_brakes_do_not_work_is_one_line(monkeypatch, tmp_path, capsys, zoo):
    car = zoo.car()
    profile = car.with_suffix(".toml").read_text(encoding="utf-8")
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(profile.replace("[inputs.force]", "[inputs.force]\ngain = -1.0"))
    flags = ["--profile", wrong, "--out", tmp_path / "out", "--quiet"]
    assert typed(monkeypatch, "ncap", car, *R152, *flags) == 2
    error = capsys.readouterr().err
    assert "no cell has a result" in error
    assert "turn the sign" in error
    assert len(error.splitlines()) == 1


@pytest.mark.parametrize(
    ("flags", "said"),
    [
        (["fmi2", "--year", "2024"], "--year 2024: no protocol of that year is bundled"),
        (["fmi2", "--protocol", "jncap"], "--protocol jncap: expected euroncap or r152"),
        (["fmi2", "--only", "CPTA"], "--only CPTA: not simulated in Euro NCAP 2026; expected one"),
        (["fmi2", "--only", "CPNCO", "--speed", "70"], "--speed 70: no speed of these tests"),
        (["nowhere.fmu", "--only", "CPNA"], "nowhere.fmu"),
        (["fmi2", "--controller", "mcp"], "controller = 'mcp': expected 'mpc'"),
        (
            ["fmi2", "--config", "crowd.toml"],
            "crowd = {'pedestrians': 3}: the protocol fixes",
        ),
        (["fmi2", "--out", "crowd.toml"], "crowd.toml"),
    ],
)
def test_what_cannot_be_tested_is_one_line_and_leaves_nothing(
    monkeypatch, tmp_path, capsys, flags, said
):
    monkeypatch.chdir(tmp_path)
    Path("crowd.toml").write_text("[crowd]\npedestrians = 3\n")
    assert typed(monkeypatch, "ncap", *flags) in {1, 2}
    error = capsys.readouterr().err
    assert said in error
    assert len(error.splitlines()) == 1
    assert [path.name for path in Path().iterdir()] == ["crowd.toml"]
