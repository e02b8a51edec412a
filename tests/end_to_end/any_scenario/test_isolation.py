"""SUMO dies in the middle of a run: the rows are kept, and the report says where it died."""

from __future__ import annotations

import contextlib
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd
import pytest

if TYPE_CHECKING:
    from collections.abc import Callable

linux = pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="looks into /proc")


def child_of(parent: int) -> int | None:
    children = Path(f"/proc/{parent}/task/{parent}/children")
    found = children.read_text().split() if children.exists() else []
    return int(found[0]) if found else None


def written_in(journals: Path) -> int:
    """How much a running child has written so far [bytes]."""
    written = 0
    for file in journals.rglob("*"):
        with contextlib.suppress(FileNotFoundError):  # renamed by the child since it was listed
            written += file.stat().st_size if file.is_file() else 0
    return written


@linux
def test_a_segmentation_fault_costs_no_row(
    city: Callable[[float], Path], tmp_path: Path, unchanged: Callable[[Path], None]
) -> None:
    config = city(0.1)
    unchanged(config.parent)
    journals, out = tmp_path / "journals", tmp_path / "out"
    journals.mkdir()
    words = ("run", config, "--ego", "car10", "--zone", "everywhere", "--no-pictures", "-q")
    run = subprocess.Popen(
        [sys.executable, "-m", "giveway", *map(str, words), "--out", str(out)],
        stderr=subprocess.PIPE,
        text=True,
        cwd=tmp_path,
        env=os.environ | {"TMPDIR": str(journals)},
    )
    deadline = time.monotonic() + 120
    while written_in(journals) < 300_000:  # rows of some seconds of simulation
        assert run.poll() is None, run.stderr
        assert time.monotonic() < deadline
        time.sleep(0.05)
    child = child_of(run.pid)
    assert child is not None
    os.kill(child, signal.SIGSEGV)
    _, errors = run.communicate(timeout=180)
    assert run.returncode == 1
    (line,) = errors.strip().splitlines()
    report = re.fullmatch(
        rf"error: {re.escape(str(config))}: .*SIGSEGV .* ([\d.]+) s \(step (\d+)\).*"
        rf"giveway doctor.*; rows up to then are in {re.escape(str(out))}",
        line,
    )
    assert report, line
    ego = pd.read_csv(out / "ego.csv")
    assert len(ego) in (int(report[2]), int(report[2]) + 1)
    assert ego["time"].iloc[-1] == pytest.approx(float(report[1]), abs=0.11)
    people = pd.read_csv(out / "trajectories.csv")
    assert (people["type"] == "pedestrian").sum() > 1000
    manifest = json.loads((out / "manifest.json").read_text())
    assert manifest["ending"] == "crashed"
    assert not list(journals.glob("giveway-journal-*"))
