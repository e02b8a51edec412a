"""The fixtures for packages with rules of the road and sensors, as pytest finds them."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.metadata import entry_points
from pathlib import Path

TEST = """
from dataclasses import dataclass

from giveway.ego.rules.protocol import Demand

@dataclass
class Options:
    limit: float = 5.0

class Slow:
    Options = Options
    def __init__(self, limit):
        self.limit = limit
    @classmethod
    def on(cls, route, options):
        return cls(options.limit)
    def demand(self, situation):
        return Demand(speed=self.limit)

class Wordy:
    def demand(self, situation):
        return "slowly"

class Nobody:
    def __init__(self, setup):
        pass
    def observe(self, truth, person_ids, ego):
        return "nobody"

def test_slow(require_sound_rule):
    require_sound_rule(Slow, limit=3.0)

def test_wordy(require_sound_rule):
    require_sound_rule(Wordy)

def test_nobody(require_sound_sensor):
    require_sound_sensor(Nobody)
"""
MODULES = ("giveway.plug_ins.testing", "giveway.ego.testing")


def test_the_fixtures_are_found_by_pytest(tmp_path: Path) -> None:
    (tmp_path / "test_mine.py").write_text(TEST, encoding="utf-8")
    installed = {point.value for point in entry_points(group="pytest11")}
    plug_ins = [word for name in MODULES if name not in installed for word in ("-p", name)]
    words = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *plug_ins]
    done = subprocess.run(
        [*words, "test_mine.py"], cwd=tmp_path, capture_output=True, text=True, env=os.environ
    )
    assert "2 failed, 1 passed" in done.stdout, done.stdout + done.stderr
    assert "Wordy breaks rules:" in done.stdout
    assert "Nobody breaks rules:" in done.stdout
