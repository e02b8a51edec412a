"""Drives with a scenario's own cars: the ledger is printed, and what is done is not done again."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from sumo_scenarios import find

SCRIPT = Path(__file__).parents[3] / "benchmarks" / "law" / "foreign_law.py"


def campaign(folder: Path) -> str:
    scenario = find("street").config_file
    words = [sys.executable, SCRIPT, scenario, "--drives", "1", "--window", "60", "--out", folder]
    return subprocess.run(words, check=True, capture_output=True, text=True, timeout=120).stdout


def test_a_car_that_has_driven_does_not_drive_again(tmp_path: Path) -> None:
    table = campaign(tmp_path)
    header, _, sums, *_ = table.splitlines()
    assert header.startswith("| drives | arrived | encounters | failures to yield |")
    assert sums.startswith("| 1 | ")
    results = tmp_path / "drives.jsonl"
    drives = results.read_bytes()
    assert drives.count(b"\n") == 1
    assert b"failed" not in drives
    assert campaign(tmp_path) == table
    assert results.read_bytes() == drives
