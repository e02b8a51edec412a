"""The page of what things cost is written by the benchmarks; a time fails nothing."""

import re
from pathlib import Path

import performance
import pytest
from pages import PAGES

HOUSE = Path(__file__).parents[3]


def test_each_benchmark_has_a_block_of_the_page():
    scripts = [block.name for block in PAGES["performance"].blocks if block.name != "machine"]
    benchmarks = HOUSE / "benchmarks" / "speed"
    assert sorted(scripts) == sorted(path.name for path in benchmarks.glob("bench_*.py"))
    assert {command.split()[0] for command in performance.QUICK} <= set(scripts)


def test_a_short_run_tells_its_ratios_and_hides_no_failure():
    pattern = performance.QUICK["bench_fmu.py --ticks 1000 --rounds 5"]
    found = re.findall(pattern, performance.printed("bench_fmu.py --ticks 50 --rounds 1"), re.M)
    assert [name for name, _ in found] == ["FMI 2.0", "FMI 3.0"]
    assert all(float(ratio) > 0 for _, ratio in found)
    with pytest.raises(performance.subprocess.CalledProcessError):
        performance.printed("bench_fmu.py --no-such-option")


def test_a_ratio_far_from_the_kept_one_is_marked_whichever_way():
    kept = {"a": 2.0, "b": 2.0, "c": 2.0, "gone": 1.0}
    lines = performance.compared({"a": 2.5, "b": 4.0, "c": 1.0, "new": 1.0}, kept)
    marked = [line.split()[0] for line in lines if "times apart" in line]
    assert marked == ["b", "c"]
    assert len(lines) == 1 + 5
