"""The coverage of the intervals: a kept table meets its bar, and the command makes such tables."""

from __future__ import annotations

import csv
from pathlib import Path

import interval_coverage
import pytest
from known_probabilities import Problem, counter_examples, probability_in_plane
from scipy import stats

KEPT = Path(interval_coverage.__file__).with_name("interval_coverage.csv")
MISLEADING = {"RP110", "metaballs"}  # planes in which chains find the wrong region


def kept(method):
    with KEPT.open(newline="", encoding="utf-8") as stream:
        return {row["problem"]: row for row in csv.DictReader(stream) if row["method"] == method}


def test_subset_simulation_covers_26_problems_or_says_that_it_may_not():
    rows = kept("subset")
    known = {name: row for name, row in rows.items() if name not in {"metaballs", "Himmelblau"}}
    assert len(known) == 26
    assert {row["repeats"] for row in rows.values()} == {"100"}
    doubted = {name for name, row in known.items() if int(row["doubts"]) > 50}
    assert len(doubted) <= 3
    for name, row in known.items():
        assert min(int(row["covered"]), int(row["source_covered"])) >= 90, name
        assert name in doubted or float(row["ratio"]) <= 3.0, name


def test_no_interval_of_a_misleading_plane_is_wrong_without_a_doubt():
    rows = kept("subset")
    assert {name: rows[name]["silent"] for name in MISLEADING} == dict.fromkeys(MISLEADING, "0")


def test_the_probability_in_the_plane_is_that_of_a_formula():
    found = probability_in_plane(lambda u: u[:, 0] + 2.0 * u[:, 1] - 5.0, 2001)
    assert found == pytest.approx(stats.norm.sf(5.0 / 5.0**0.5), rel=2e-3)


def test_the_command_goes_on_where_it_was_ended(monkeypatch, tmp_path, capsys):
    plane = next(one for one in counter_examples() if one.name == "RP110")
    easy = Problem("easy", 3, float(stats.norm.sf(1.0)), lambda u: u[:, 0] - 1.0)
    monkeypatch.setattr(interval_coverage, "_problems", lambda: [easy, plane])
    asked = ["x", "--out", str(tmp_path), "--budget", "3000", "--only", "easy"]
    for repeats in ("2", "3"):
        monkeypatch.setattr("sys.argv", [*asked, "--repeats", repeats])
        interval_coverage.main()
    lines = (tmp_path / "coverage.csv").read_text(encoding="utf-8").splitlines()
    assert [line.split(",")[3] for line in lines[1:]] == ["0", "1", "2"]
    assert "| easy | 3 | 0.159 | subset | 3,000 |" in capsys.readouterr().out


def test_the_page_shows_the_kept_numbers():
    page = (KEPT.parents[2] / "docs" / "risk.md").read_text(encoding="utf-8")
    for method in ("subset", "importance"):
        for row in kept(method).values():
            numbers = f"{row['covered']} | {row['doubts']} | {row['silent']} |"
            begin = f"| {row['problem']} | {row['dimension']} | "
            lines = [line for line in page.splitlines() if line.startswith(begin)]
            assert any(f"| {method} |" in line and numbers in line for line in lines), begin
