"""The tests of this folder import the files of benchmarks/ by their names."""

from __future__ import annotations

import sys
from pathlib import Path

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
sys.path[:0] = [str(folder) for folder in BENCHMARKS.iterdir() if folder.is_dir()]
