"""The fixtures for packages that plug in: sound ones pass, others fail with what they break."""

from __future__ import annotations

import os
import subprocess
import sys

TEST = """
from dataclasses import dataclass
from pedestrian_model import Accelerations
import pytest

@dataclass
class Options:
    pull: float = 2.0

class People:
    Options = Options
    def __init__(self, setup, options):
        self.pull = options.pull
    def step(self, walkers):
        return Accelerations(self.pull * (walkers.preferred - walkers.velocity))

class Driver:
    def __init__(self, setup):
        pass
    def control(self, seen):
        return "fast"

def test_people(require_sound_model):
    require_sound_model(People, pull=3.0)

def test_driver(require_sound_controller):
    require_sound_controller(Driver)
"""


def test_the_fixtures_are_found_by_pytest(tmp_path):
    (tmp_path / "test_mine.py").write_text(TEST, encoding="utf-8")
    plugin = [] if _is_installed() else ["-p", "giveway.plug_ins.testing"]
    words = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *plugin]
    done = subprocess.run(
        [*words, "test_mine.py"], cwd=tmp_path, capture_output=True, text=True, env=os.environ
    )
    assert "1 failed, 1 passed" in done.stdout, done.stdout + done.stderr
    assert "Driver breaks rules:" in done.stdout
    assert "answers numbers: it returned 'fast'" in done.stdout


def _is_installed() -> bool:
    from importlib.metadata import entry_points

    names = {point.value for point in entry_points(group="pytest11")}
    return "giveway.plug_ins.testing" in names
