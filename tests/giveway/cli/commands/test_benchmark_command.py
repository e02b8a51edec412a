"""``giveway benchmark`` as a user types it: table, resumption, plug-ins, and what is refused."""

from __future__ import annotations

import json

import pandas as pd

FEW = ("--only", "scene=encounter, sparse", "--only", "people=MIXED", "--runs", "2")
PLUG_IN = """
from controller import Acceleration

class Mine:
    def __init__(self, setup):
        self.setup = setup

    def control(self, seen):
        if BROKEN and seen.position > 5.0:
            raise ArithmeticError("no steering wheel")
        return Acceleration(min(1.0, 2.0 - seen.speed), "slowly")
"""


def test_a_controller_is_driven_resumed_and_shown_beside_rivals(type_here, tmp_path):
    words = ("benchmark", "pid-tuned", *FEW, "--out", "b")
    done = type_here(*words, "--jobs", "1")
    assert done.returncode == 0, done.stderr
    assert "encounter, sparse: people of MIXED" in done.stdout
    assert "pid-tuned (kept)" in done.stdout
    assert "recorded drivers" in done.stdout
    assert "2 runs in" in done.stdout
    table = (tmp_path / "b" / "benchmark.csv").read_bytes()
    assert list(pd.read_csv(tmp_path / "b" / "benchmark.csv")["drives"]) == [2]

    next((tmp_path / "b" / "records").rglob("*.json")).unlink()
    done = type_here(*words, "--jobs", "2", "--resume", "--json")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["failed"] == 0
    assert found["table"][0]["controller"] == "pid-tuned"
    assert (tmp_path / "b" / "benchmark.csv").read_bytes() == table
    done = type_here(*words, "--force", "--quiet")
    assert (done.returncode, done.stdout) == (0, "")


def test_a_plug_in_is_driven_and_a_broken_one_is_told(type_here, installed):
    installed("mine47", PLUG_IN.replace("BROKEN", "False"))
    done = type_here("benchmark", "mine47:Mine", *FEW, "--jobs", "1")
    assert done.returncode == 0, done.stderr
    assert "mine47:Mine" in done.stdout
    installed("broken47", PLUG_IN.replace("BROKEN", "True"))
    done = type_here("benchmark", "broken47:Mine", *FEW, "--jobs", "1")
    assert done.returncode == 1
    assert "2 of 2 runs have no result" in done.stdout
    assert "no steering wheel" in done.stdout


def test_a_controller_or_scene_that_is_not_there_is_one_line(type_here, tmp_path):
    for words, expected in (
        (("nobody",), "nobody"),
        (("idm", "--only", "scene=moon"), "moon"),
        (("idm", "--config", "none.toml"), "none.toml"),
    ):
        done = type_here("benchmark", *words)
        assert done.returncode == 2
        assert len(done.stderr.strip().splitlines()) == 1
        assert expected in done.stderr
    assert not (tmp_path / "results").exists()


def test_a_dry_run_tells_drives_and_time(type_here, tmp_path):
    done = type_here("benchmark", "idm", *FEW[:4], "--dry-run", "--jobs", "1")
    assert done.returncode == 0, done.stderr
    assert "100 runs: 1 cell with seeds 701 to 800" in " ".join(done.stdout.split())
    assert not (tmp_path / "results").exists()
