"""The page of what things cost is written by the benchmarks; a time fails nothing."""

import re
from pathlib import Path

import performance
import pytest

HOUSE = Path(__file__).parents[2]


def test_the_page_has_a_place_for_each_command():
    page = performance.PAGE.read_text(encoding="utf-8")
    for name in ("machine", *(command.split()[0] for command in performance.COMMANDS)):
        page = performance.filled(page, name, f"what {name} prints")
        assert f"<!-- {name} -->\nwhat {name} prints\n<!-- end of {name} -->" in page


def test_a_page_without_the_place_is_refused():
    with pytest.raises(ValueError, match="no marks '<!-- machine -->'"):
        performance.filled("nothing", "machine", "text")


def test_each_command_is_a_benchmark_and_each_benchmark_is_in_it():
    scripts = {command.split()[0] for command in performance.COMMANDS}
    assert scripts == {path.name for path in (HOUSE / "benchmarks").glob("bench_*.py")}
    assert {command.split()[0] for command in performance.QUICK} <= scripts
    assert performance.COMMANDS[0] == "bench_loop.py"


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
