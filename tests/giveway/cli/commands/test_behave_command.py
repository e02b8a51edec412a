"""``giveway data behave`` as a user types it."""

from __future__ import annotations

import pandas as pd
import pytest

from giveway.cli import main


def giveway(*words: object) -> int:
    with pytest.raises(SystemExit) as end:
        main([str(word) for word in words])
    return int(end.value.code or 0)


def test_behave_prints_the_ratios_and_writes_tables_and_picture(
    recorded_crossing, tmp_path, capsys
):
    folder, description = recorded_crossing
    out = tmp_path / "out"
    words = ("data", "behave", folder, "--dataset", description)
    assert giveway(*words, "--out", out) == 0
    said = capsys.readouterr().out
    for text in ("MADE, vci, MIXED", "4 people near a vehicle, 1 clip", "mean of the six ratios"):
        assert text in said
    names = {"behaviour.csv", "people.csv", "behaviour.png", "behaviour.svg"}
    assert {path.name for path in out.iterdir()} == names
    table = pd.read_csv(out / "behaviour.csv")
    assert len(table) == 8
    assert table["recorded_count"][:7].min() > 0
    people = pd.read_csv(out / "people.csv")
    assert people["who"].value_counts().to_dict() == {"recorded": 4, "simulated": 4}
    recorded = people[people["who"] == "recorded"].set_index("person")
    assert recorded["close_passes"].to_dict() == {"a": 0, "b": 1, "c": 1, "d": 0}
    assert giveway(*words, "--out", out) == 2
    assert "--force" in capsys.readouterr().err
    before = {path.name: path.read_bytes() for path in out.iterdir()}
    assert giveway(*words, "--out", out, "--force", "--quiet") == 0
    assert capsys.readouterr().out == ""
    assert {path.name: path.read_bytes() for path in out.iterdir()} == before


@pytest.mark.parametrize("model", ["social-force", "gap-acceptance", "constant-velocity", "orca"])
def test_each_bundled_model_can_be_compared(recorded_crossing, model, capsys) -> None:
    folder, description = recorded_crossing
    assert giveway("data", "behave", folder, "--dataset", description, "--model", model) == 0
    assert f"MADE, {model}:" in capsys.readouterr().out


def test_an_unknown_model_is_refused(recorded_crossing, capsys) -> None:
    folder, description = recorded_crossing
    assert giveway("data", "behave", folder, "--dataset", description, "--model", "vcx") == 2
    error = capsys.readouterr().err
    assert "--model vcx: unknown model; did you mean 'vci'?" in error
    assert error.count("\n") == 1


def test_people_in_a_corridor_are_compared_there(recorded_corridor, tmp_path, capsys) -> None:
    folder, description = recorded_corridor("walk-200-200")
    out = tmp_path / "out"
    words = ("data", "behave", folder, "--dataset", description, "--preset", "MIXED")
    assert giveway(*words, "--out", out) == 0
    said = " ".join(capsys.readouterr().out.split())
    for text in (
        "MADE, vci, MIXED: 60 people in 1 corridors",
        "flow, walk-200-200",
        "people ever free: 2, at 1.25 ± 0.00 m/s; recordings left out: 0",
        "Nobody 2026",
    ):
        assert text in said
    names = {"corridor.csv", "corridor.png", "corridor.svg"}
    assert {path.name for path in out.iterdir()} == names
    table = pd.read_csv(out / "corridor.csv")
    assert table["recorded"].tolist() == pytest.approx([1.25, 2.03], abs=0.02)
    assert giveway(*words, "--out", out) == 2
    assert "--force" in capsys.readouterr().err


def test_a_name_of_no_corridor_is_one_line(recorded_corridor, capsys) -> None:
    folder, description = recorded_corridor("yard")
    assert giveway("data", "behave", folder, "--dataset", description) == 2
    error = capsys.readouterr().err
    assert "0 people in 0 corridors without vehicles, of 1 recordings" in error
    assert error.count("\n") == 1
