"""Findings in words: a number of pairs that shows nothing is told."""

from __future__ import annotations

from giveway.reports.findings_in_words import cautions


def test_so_few_pairs_that_nothing_can_be_shown_are_told(study):
    rows = study.comparison.assign(n=4, verdict="no difference shown")

    class Few:
        path, definition, design, manifest = (
            study.path, study.definition, study.design, study.manifest,
        )  # fmt: skip
        runs, situations, failures = study.runs, study.situations, study.failures
        execution, comparison = study.execution, rows

    assert any(
        "test of 4 different differences has a p-value of 0.125" in said for said in cautions(Few())
    )
    Few.comparison = rows.assign(n=6)
    assert not any("signed-rank" in said for said in cautions(Few()))
