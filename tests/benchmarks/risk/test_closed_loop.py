"""The estimates in a closed loop: those that are kept, and how they are."""

from __future__ import annotations

import csv
from pathlib import Path

import closed_loop

KEPT = Path(closed_loop.__file__).with_name("closed_loop.csv")


def rows(file):
    with file.open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def test_every_kept_interval_meets_that_of_the_reference():
    reference, *estimates = rows(KEPT)
    assert reference["name"] == closed_loop.REFERENCE
    assert int(reference["runs"]) >= 10_000
    for one in estimates:
        assert float(one["low"]) <= float(reference["high"]), one["name"]
        assert float(reference["low"]) <= float(one["high"]), one["name"]


def test_the_table_has_what_is_there_the_reference_first(tmp_path):
    for name in ("subset-10", "subset-2", "reference"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "risk.csv").write_text("event,probability,low,high\nfrontal,0.1,0,1\n")
    (tmp_path / "subset-3").mkdir()
    closed_loop.keep(tmp_path, tmp_path / "kept.csv")
    assert [row["name"] for row in rows(tmp_path / "kept.csv")] == [
        "reference",
        "subset-2",
        "subset-10",
    ]
