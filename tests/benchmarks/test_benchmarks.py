"""The benchmarks run; what they measure is not asserted here."""

import subprocess
import sys
from pathlib import Path

import pytest

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.mark.parametrize(
    ("script", "words", "printed"),
    [
        ("bench_loop.py", ["--pairs", "1"], "real-time factor"),
        ("bench_scenario.py", ["--walkers", "100", "--window", "1"], "walkers"),
        ("bench_metrics.py", ["--repetitions", "1"], "summary"),
    ],
)
def test_a_short_one_prints_its_table(script: str, words: list[str], printed: str) -> None:
    done = subprocess.run(
        [sys.executable, str(BENCHMARKS / script), *words],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert printed in done.stdout
