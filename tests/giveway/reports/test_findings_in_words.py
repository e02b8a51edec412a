"""Findings in words: a number of pairs that shows nothing is told."""

from __future__ import annotations

import pytest

from giveway.reports.findings_in_words import cautions, findings, primary_outcome
from giveway.reports.report_page import write_report


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


@pytest.fixture
def with_outcome(changed):
    """The study with the completion time as its primary outcome."""

    def name(smallest_effect: float):
        outcome = "[primary_outcome]\nmetric = 'completion_time'\nreason = 'a tenth of it'\n"
        outcome += f"smallest_effect = {smallest_effect}\n"
        return changed(lambda record: record, lambda text: f"{text}\n{outcome}")

    return name


@pytest.mark.usefixtures("unpictured")
def test_a_primary_outcome_makes_its_differences_confirmatory(study, with_outcome, parsed):
    assert any("names no primary outcome" in said for said in cautions(study))
    named = with_outcome(1e-6)
    said = findings(named)[0]
    assert said == primary_outcome(named)
    assert said.startswith("Primary outcome: completion time (general). The study has 2 confirm")
    assert "smaller than 1e-06 s, the smallest of interest (a tenth of it), are excluded" in said
    assert not any("primary outcome" in said for said in cautions(named))
    page = parsed(write_report(named))
    head, *rows = page.tables["confirmatory-table"]
    assert head[-1] == "effects below 1e-06 s"
    assert len(rows) == 2
    head, *rows = page.tables["comparison-table"]
    metric, situation = head.index("metric"), head.index("situation")
    confirmatory = [row for row in rows if row[head.index("kind")] == "confirmatory"]
    assert {(row[metric], row[situation]) for row in confirmatory} == {
        ("completion time [s]", "general")
    }
    assert len(confirmatory) == 2


def test_no_effect_of_interest_may_be_possible(with_outcome):
    assert "and no larger ones are possible in 2." in primary_outcome(with_outcome(1e6))
