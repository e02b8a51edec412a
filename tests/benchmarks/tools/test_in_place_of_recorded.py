"""Drives in place of all recorded vehicles, by the recording that is bundled."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import in_place_of_recorded

from sumo_scenarios import find

if TYPE_CHECKING:
    from pathlib import Path

    import pytest

YARD = find("recorded").folder


def test_the_sums_of_all_drives_are_printed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    words = [str(YARD), "--dataset", str(YARD / "yard.toml"), "--out", str(tmp_path)]
    some = ["--controllers", "pid-tuned", "--set", "crowd.model=vci"]
    monkeypatch.setattr(sys, "argv", ["tool", *words, *some])
    in_place_of_recorded.main()
    head, _, recorded, own = capsys.readouterr().out.splitlines()
    assert head.startswith("| driver | drives | time [s] | people within 4 m |")
    assert recorded.startswith("| recorded driver | 1 | 15.0 | 7 |")
    assert own.startswith("| pid-tuned | 1 | ")
    config = (tmp_path / "pid-tuned" / "yard-1" / "config.toml").read_text()
    assert 'model = "vci"' in config
