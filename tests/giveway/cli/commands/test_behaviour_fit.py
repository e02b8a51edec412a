"""``giveway calibrate`` for behaviour, as a user types it."""

from __future__ import annotations

import tomllib

import pytest

from giveway.cli import main
from giveway.config.files.presets import parameters_of
from pedestrian_model import SIM


def giveway(*words: object) -> int:
    with pytest.raises(SystemExit) as end:
        main([str(word) for word in words])
    return int(end.value.code or 0)


def test_a_fit_is_told_and_can_be_walked_by(recorded_crossing, tmp_path, capsys) -> None:
    folder, description = recorded_crossing
    file = tmp_path / "mine.toml"
    words = ("calibrate", folder, "--dataset", description, "--out", file, "--evaluations", 10)
    assert giveway(*words, "--force") == 0
    said = capsys.readouterr().out
    for text in ("MADE", "close passes", "Weidmann", "max_acceleration", "mean of the six"):
        assert text in said
    origin = tomllib.loads(file.read_text())["provenance"]
    assert origin["made_by"] == "giveway calibrate"
    assert origin["evaluations"] == 14
    assert origin["datasets"] == ["MADE"]
    assert origin["citations"] == ["Nobody 2026"]
    assert parameters_of(str(file)).sway > 0.0
    assert parameters_of(str(file)).mass == SIM.mass
    assert [path.suffix for path in tmp_path.iterdir()].count(".journal") == 0
    first = file.read_bytes()
    assert giveway(*words, "--force", "--quiet") == 0
    assert file.read_bytes() == first
    compared = ("data", "behave", folder, "--dataset", description, "--preset", file)
    assert giveway(*compared) == 0


def test_a_fit_that_loses_the_car_is_refused(recorded_crossing, tmp_path, capsys) -> None:
    folder, description = recorded_crossing
    strong = tmp_path / "strong.toml"
    strong.write_text("base = 'SIM'\n[parameters]\nvehicle_strength = 20000\nvehicle_decay = 8\n")
    file = tmp_path / "mine.toml"
    words = ("calibrate", folder, "--dataset", description, "--out", file, "--evaluations", 1)
    words += ("--preset", strong, "--parameters", "vehicle_strength")
    assert giveway(*words, "--quiet") == 2
    error = capsys.readouterr().err
    assert f"{file}: not written, since the fit is worse than {strong}: A car at 3 m/s" in error
    assert error.count("\n") == 1
    assert not file.exists()
    assert giveway(*words, "--quiet", "--force") == 0
    assert file.exists()


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (("--aim", "displacement"), "--aim: no longer exists; leave it out: a fit is"),
        (("--held-out", "0.3"), "--held-out: no longer exists; leave it out: judge a fit on anot"),
        (("--dataset", "citr"), "--dataset: given 2 times for 3 folders; expected one for each"),
    ],
)
def test_what_cannot_be_fitted_is_one_line(recorded_crossing, tmp_path, capsys, more, said) -> None:
    folder, description = recorded_crossing
    words = ("calibrate", folder, folder, folder, "--dataset", description)
    assert giveway(*words, "--out", tmp_path / "mine.toml", *more) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1


def test_a_start_by_which_people_tremble_is_refused(recorded_crossing, tmp_path, capsys) -> None:
    folder, description = recorded_crossing
    shaky = tmp_path / "shaky.toml"
    shaky.write_text("base = 'SIM'\n[parameters]\ndestination_gain = 2000\n")
    words = ("calibrate", folder, "--dataset", description, "--preset", shaky)
    assert giveway(*words, "--out", tmp_path / "mine.toml") == 2
    error = capsys.readouterr().err
    assert f"--preset {shaky}: destination_gain = 2000" in error
    assert error.count("\n") == 1
