"""``giveway data scenario`` and ``giveway data compare`` as a user types them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pandas as pd
import pytest

from sumo_scenarios import find

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

YARD = find("recorded").folder


def test_a_scenario_is_written_run_and_compared(tmp_path: Path, type_here: Callable) -> None:
    write = ("data", "scenario", YARD, "--dataset", YARD / "yard.toml", "--out", "own")
    written = type_here(*write, "--vehicle", "1")
    assert written.returncode == 0, written.stderr
    assert "Run it: giveway run own/" in written.stdout
    assert "Please cite: nobody" in written.stdout
    assert "--force" in type_here(*write, "--vehicle", "1").stderr
    words = ("--controller", "pid-tuned", "--no-pictures", "--out", "run")
    done = type_here("run", "own/", *words)
    assert done.returncode == 0, done.stderr
    told = "Overlaps with people as recorded" in done.stdout
    assert told == bool(pd.read_csv(tmp_path / "run" / "summary.csv")["recorded_contacts"][0])
    compared = type_here("data", "compare", "run", "--out", "out")
    assert compared.returncode == 0, compared.stderr
    for text in ("In place of yard, vehicle 1", "recorded driver", "the person went first"):
        assert text in compared.stdout
    table = pd.read_csv(tmp_path / "out" / "compared.csv")
    assert table["driver"].tolist() == ["recorded driver", "run"]
    assert table["duration"].tolist() == pytest.approx([15.0, 16.0], abs=1.5)


def test_a_wrong_request_is_answered_in_one_line(type_here: Callable) -> None:
    write = ("data", "scenario", YARD, "--dataset", YARD / "yard.toml", "--out", "own")
    for words, said in (
        ((*write, "--vehicle", "2"), "--vehicle 2: no such id in 'yard'; expected one of 1"),
        ((*write, "--clip", "lawn"), "clip = 'lawn': not in "),
        ((*write[:3], "--out", "own"), "dataset: missing; expected one of citr, "),
        (("data", "compare", "nowhere"), "nowhere: no such folder; expected a results folder"),
    ):
        done = type_here(*words)
        assert done.returncode != 0
        assert said in done.stderr
        assert done.stderr.count("\n") == 1
