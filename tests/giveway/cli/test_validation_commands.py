"""``giveway validate`` and ``giveway calibrate`` as a user types them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
import pytest

from giveway.cli import main

if TYPE_CHECKING:
    from pathlib import Path

AS_CITR = ("--dataset", "citr")


@pytest.fixture
def dataset(tmp_path, write_clip, straight_walks) -> Path:
    x, v = straight_walks(200, [[-4, 1.6], [3, -2], [0, 4]], [[1, 0], [-1, 0.3], [1.2, 0.1]])
    cart = np.tile([0.0, 0.0, 0.1, 0.6], (200, 1))
    folder = tmp_path / "citr" / "trajectories_filtered"
    write_clip(folder / "vci_front", "front_interaction_01", x, v, cart)
    write_clip(folder / "p2p_uni", "unidirection_no_vehicle_01", x, v)
    write_clip(folder / "p2p_uni", "unidirection_no_vehicle_02", x[::-1], -v)
    return tmp_path / "citr"


def giveway(*words: object) -> int:
    with pytest.raises(SystemExit) as end:
        main([str(word) for word in words])
    return int(end.value.code or 0)


def test_validate_prints_both_tables_and_writes_csv_and_pictures(dataset, tmp_path, capsys):
    out = tmp_path / "out"
    assert giveway("validate", dataset, *AS_CITR, "--preset", "TABLE2", "--out", out) == 0
    said = capsys.readouterr().out
    assert "3 clips, 1 with a vehicle, 9 pedestrians" in said
    assert "VCI, people near a moving vehicle: at 0.73 s" in said
    for words in ("goalCV", "VCI without f_v", "within 3 m of a moving vehicle", "closest [m]"):
        assert words in said
    names = {"errors.csv", "contacts.csv", "prediction.csv"}
    names |= {f"{n}.{kind}" for n in ("growth", "tracks", "places") for kind in ("png", "svg")}
    assert {path.name for path in out.iterdir()} == names
    errors = pd.read_csv(out / "errors.csv")
    assert len(errors) == 2 * 3 * 2 * 5  # subsets, horizons, metrics, predictors
    assert errors["horizon"].unique().tolist() == [0.73, 2.0, 4.0]
    cv = errors.query("predictor == 'CV' and subset == 'all'")
    assert cv["mean"].abs().max() < 1e-5
    again = tmp_path / "again"
    giveway("validate", dataset, *AS_CITR, "--preset", "TABLE2", "--out", again, "--quiet")
    for name in ("errors.csv", "contacts.csv", "growth.png"):
        assert (again / name).read_bytes() == (out / name).read_bytes()


def test_results_are_not_replaced_unasked(dataset, tmp_path, capsys) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (out / "errors.csv").write_text("old\n")
    assert giveway("validate", dataset, *AS_CITR, "--out", out, "--quiet") == 2
    assert "replace them with --force" in capsys.readouterr().err
    assert giveway("validate", dataset, *AS_CITR, "--out", out, "--quiet", "--force") == 0
    (out / "thesis.tex").write_text("")
    assert giveway("validate", dataset, *AS_CITR, "--out", out, "--quiet", "--force") == 2
    assert "holds 'thesis.tex'" in capsys.readouterr().err


def test_a_wrong_folder_is_one_line(tmp_path, capsys) -> None:
    assert giveway("validate", tmp_path / "nowhere", *AS_CITR) == 2
    error = capsys.readouterr().err
    assert error.startswith("error: ")
    assert error.count("\n") == 1
    assert "no such folder" in error


def test_calibrate_refuses_an_unknown_parameter(dataset, tmp_path, capsys) -> None:
    out = tmp_path / "mine.toml"
    words = ("calibrate", dataset, *AS_CITR, "--parameters", "vehicle_force", "--out", out)
    assert giveway(*words) == 2
    assert "--parameters vehicle_force: cannot be fitted for behaviour" in capsys.readouterr().err
    assert giveway("calibrate", dataset, *AS_CITR, "--out", tmp_path / "mine.txt") == 2
    assert "expected the name of a preset file" in capsys.readouterr().err


MINE = """
name = "MINE"
frame_rate = {rate}
[vehicle]
front = 2.25
rear = {rear}
width = 1.8
"""


def test_clips_that_nobody_describes_are_refused(dataset, tmp_path, capsys) -> None:
    for command in (("validate", dataset), ("calibrate", dataset, "--out", tmp_path / "m.toml")):
        assert giveway(*command) == 2
        error = capsys.readouterr().err
        assert "--dataset: missing; expected one of citr, " in error
        assert error.count("\n") == 1


def test_a_frame_rate_that_is_not_the_clips_own_is_refused(dataset, tmp_path, capsys) -> None:
    mine = tmp_path / "mine.toml"
    mine.write_text(MINE.format(rate=23.976, rear=2.25))
    for name in ("dut", mine):
        assert giveway("validate", dataset, "--dataset", name, "--out", tmp_path / "o") == 2
        assert "belong to 30.0 frames per second, --dataset" in capsys.readouterr().err
    assert not (tmp_path / "o").exists()


def test_a_name_that_would_steer_the_terminal_is_shown_harmless(dataset, tmp_path, capsys) -> None:
    mine = tmp_path / "mine.toml"
    text = MINE.format(rate=29.97, rear=2).replace('"MINE"', '"\\u001b[31mRED"')
    mine.write_text(text)
    assert giveway("validate", dataset, "--dataset", mine, "--out", tmp_path / "o") == 0
    assert giveway("data", "describe", dataset, "--dataset", mine) == 0
    said = capsys.readouterr().out
    assert "?[31mRED: 3 clips" in said
    assert "\x1b" not in said


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("name = 'x'", "frame_rate is missing"),
        (MINE.format(rate=1e9, rear=2), "frame_rate = 1000000000.0: should be at most"),
        (MINE.format(rate=25, rear=-2), "vehicle.rear = -2: should be at least 0"),
        (MINE.format(rate=25, rear=2) + "heigth = 2\n", "vehicle.heigth: expected a table like"),
        ("vehicle = 3", "name is missing"),
        ("a =", "not valid TOML"),
    ],
)
def test_a_wrong_description_is_one_line(dataset, tmp_path, capsys, text, said) -> None:
    mine = tmp_path / "mine.toml"
    mine.write_text(text)
    assert giveway("validate", dataset, "--dataset", mine) == 2
    error = capsys.readouterr().err
    assert f"--dataset {mine}: {said}" in error
    assert error.count("\n") == 1
    assert giveway("validate", dataset, "--dataset", "citrus") == 2
    assert "--dataset citrus: expected one of citr, " in capsys.readouterr().err
