"""A run whose process dies: the report, the rows, the exit code, on real processes."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest

from giveway.processes.heartbeat import Heartbeat

MANY = 600
LONG = ["--pedestrians", str(MANY), "--spawn-area", "20,-200,120,-10", "--no-pictures"]
LONG += ["--regulation-reference-speed", "0.1", "--time-limit", "120"]


def start(folder: Path, *words: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "giveway", "run", *words, "--out", "r"],
        cwd=folder,
        env=os.environ | {"TMPDIR": str(folder)},  # the journal, to be watched
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def child_of(process: subprocess.Popen[str]) -> int:
    """The process id of the supervised child."""
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
    if not children.exists():
        pytest.skip("needs Linux's /proc to find the child")
    deadline = time.monotonic() + 60
    while not children.read_text().split():
        assert time.monotonic() < deadline
        time.sleep(0.05)
    return int(children.read_text().split()[0])


def wait_for_the_loop(folder: Path) -> None:
    """Until some steps have been done, however busy the machine is."""
    deadline = time.monotonic() + 200
    while True:
        assert time.monotonic() < deadline
        for journal in folder.glob("giveway-journal-*"):
            with contextlib.suppress(OSError):
                if Heartbeat(journal).read().step > 5:
                    return
        time.sleep(0.05)


def test_a_native_crash_keeps_the_rows_and_says_where_it_was(tmp_path: Path) -> None:
    process = start(tmp_path, *LONG)
    child = child_of(process)
    wait_for_the_loop(tmp_path)
    os.kill(child, signal.SIGSEGV)
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 1
    line = errors.strip().splitlines()[-1]
    assert "shared_space.sumocfg" in line
    assert "SIGSEGV" in line
    assert "rows up to then are in" in line
    manifest = json.loads((tmp_path / "r" / "manifest.json").read_text())
    assert manifest["ending"] == "crashed"
    ledger = manifest["pedestrians"]
    assert ledger["added"] == MANY == ledger["arrived"] + ledger["walking"]
    ego = pd.read_csv(tmp_path / "r" / "ego.csv")
    crowd = pd.read_csv(tmp_path / "r" / "trajectories.csv")
    assert len(ego) > 1
    assert (ego["time"].diff().dropna().round(6) == 0.05).all()
    assert set(crowd["time"]) == set(ego["time"])
    summary = json.loads((tmp_path / "r" / "summary.json").read_text())
    assert summary["ending"] == "crashed"


def test_a_crash_before_the_first_row_leaves_nothing_behind(tmp_path: Path) -> None:
    process = start(tmp_path, *LONG)
    child = child_of(process)
    os.kill(child, signal.SIGKILL)
    _, errors = process.communicate(timeout=60)
    assert process.returncode in {1, 128 + signal.SIGKILL}
    assert errors.startswith("error: ")
    assert not (tmp_path / "r").exists()


def test_former_results_survive_a_crash_before_the_first_row(
    type_here: Callable[..., subprocess.CompletedProcess[str]], tmp_path: Path
) -> None:
    first = type_here("run", "--pedestrians", 0, "--no-pictures", "--out", "r")
    assert first.returncode == 0
    before = {path.name: path.read_bytes() for path in (tmp_path / "r").iterdir()}
    process = start(tmp_path, *LONG, "--force")
    os.kill(child_of(process), signal.SIGKILL)
    process.communicate(timeout=60)
    assert {path.name: path.read_bytes() for path in (tmp_path / "r").iterdir()} == before
