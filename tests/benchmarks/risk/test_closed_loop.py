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


def test_the_table_has_all_parts_of_the_reference_in_its_first_row(tmp_path):
    for name, runs, events in (
        ("subset-10", 4000, 200),
        ("subset-2", 4100, 210),
        ("reference-1", 10_000, 19),
        ("reference-2", 10_000, 21),
    ):
        (tmp_path / name).mkdir()
        (tmp_path / name / "risk.csv").write_text(
            f"event,probability,low,high,runs,events\nfrontal,0.1,0,1,{runs},{events}\n"
        )
    (tmp_path / "subset-3").mkdir()
    closed_loop.keep(tmp_path, tmp_path / "kept.csv")
    reference, *estimates = rows(tmp_path / "kept.csv")
    assert [one["name"] for one in estimates] == ["subset-2", "subset-10"]
    assert (reference["name"], reference["runs"], reference["events"]) == (
        "reference",
        "20000",
        "40",
    )
    assert float(reference["probability"]) == 0.002
    assert 0.001 < float(reference["low"]) < 0.002 < float(reference["high"]) < 0.003


def test_the_page_tells_how_many_intervals_cover_the_reference():
    reference, *estimates = rows(KEPT)
    p = float(reference["probability"])
    covered = sum(float(one["low"]) <= p <= float(one["high"]) for one in estimates)
    told = f"their intervals cover 0.0018 in {covered} of {len(estimates)}"
    page = (KEPT.parents[2] / "docs" / "risk.md").read_text(encoding="utf-8")
    assert told in " ".join(page.split())
    assert f"{int(reference['runs']):,} plain runs have {reference['events']} contacts" in " ".join(
        page.split()
    )
