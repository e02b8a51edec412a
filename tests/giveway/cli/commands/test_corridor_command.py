"""``giveway data corridor`` as a user types it."""

from __future__ import annotations

import pandas as pd
import pytest

from giveway.cli import main


def giveway(*words: object) -> int:
    with pytest.raises(SystemExit) as end:
        main([str(word) for word in words])
    return int(end.value.code or 0)


def test_corridor_prints_the_table_and_writes_the_diagram(
    recorded_corridor, tmp_path, capsys
) -> None:
    folder, description = recorded_corridor("walk-200-200")
    out = tmp_path / "out"
    words = ("data", "corridor", folder, "--dataset", description, "--preset", "MIXED")
    assert giveway(*words, "--out", out) == 0
    said = capsys.readouterr().out
    for text in (
        "MADE, vci, MIXED: 60 people, 1 corridors",
        "flow, walk-200-200",
        "2 recorded people are ever free, and walk at 1.25 ± 0.00 m/s then",
        "Nobody 2026",
    ):
        assert text in " ".join(said.split())
    names = {"corridor.csv", "points.csv", "corridor.png", "corridor.svg"}
    assert {path.name for path in out.iterdir()} == names
    table = pd.read_csv(out / "corridor.csv")
    assert table["recorded"].tolist() == pytest.approx([1.25, 2.03], abs=0.02)
    assert set(pd.read_csv(out / "points.csv")["who"]) == {"recorded", "simulated"}
    assert giveway(*words, "--out", out) == 2
    assert "--force" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--model", "vcx"), "--model vcx: unknown model"),
        (("--preset", "NO"), "preset 'NO': expected one of"),
        (
            ("--crowd-desired-speed-mean", "5"),
            "desired-speed-mean = 5.0: should be at most",
        ),
    ],
)
def test_a_wrong_crowd_is_one_line(recorded_corridor, words, message, capsys) -> None:
    folder, description = recorded_corridor("walk-200-200")
    assert giveway("data", "corridor", folder, "--dataset", description, *words) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1


def test_a_data_set_without_corridor_is_one_line(recorded_crossing, capsys) -> None:
    folder, description = recorded_crossing
    assert giveway("data", "corridor", folder, "--dataset", description) == 2
    error = capsys.readouterr().err
    assert "--dataset MADE: [corridor] is missing; expected the walls" in error
    assert error.count("\n") == 1
