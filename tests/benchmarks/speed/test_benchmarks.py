"""The benchmarks run; what they measure is not asserted here."""

import runpy
import sys
from pathlib import Path

import pytest

BENCHMARKS = Path(__file__).parents[3] / "benchmarks" / "speed"


@pytest.mark.parametrize(
    ("script", "words", "printed"),
    [
        ("bench_loop.py", ["--pairs", "1", "--controller", "mpc"], "real-time factor"),
        ("bench_scenario.py", ["--walkers", "100", "--window", "1"], "walkers"),
        ("bench_metrics.py", ["--repetitions", "1"], "summary"),
        ("bench_models.py", ["--people", "5", "--steps", "3"], "constant-velocity"),
    ],
)
def test_a_short_one_prints_its_table(
    script: str,
    words: list[str],
    printed: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(sys, "argv", [script, *words])
    monkeypatch.syspath_prepend(str(BENCHMARKS))  # as Python does for a script
    runpy.run_path(str(BENCHMARKS / script), run_name="__main__")
    assert printed in capsys.readouterr().out
