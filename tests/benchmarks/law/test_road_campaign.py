"""Drives where roads meet: a campaign ends with a table, and goes on where it was ended."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

SCRIPT = Path(__file__).parents[3] / "benchmarks" / "law" / "road_campaign.py"


def campaign(folder: Path) -> str:
    words = [sys.executable, SCRIPT, "--place", "drop", "--seeds", "1", "--out", folder]
    return subprocess.run(words, check=True, capture_output=True, text=True, timeout=120).stdout


def test_a_drive_that_is_done_is_not_done_again(tmp_path: Path) -> None:
    table = campaign(tmp_path)
    assert "| drop | mpc | 1 | 0 | 0 | 0 |" in table
    assert table.splitlines()[-1].startswith("| all |  | 2 | 0 |")
    results = tmp_path / "drives.jsonl"
    drives = results.read_bytes()
    assert drives.count(b"\n") == 2
    assert campaign(tmp_path) == table
    assert results.read_bytes() == drives
