"""A session of a study: a dry run makes nothing, a second session only what is missing."""

from __future__ import annotations

import io

from rich.console import Console
from support.studies import SMALL

from giveway.cli.commands.study_session import make_study
from giveway.studies.definition import changed, parse_definition
from giveway.studies.study_options import StudyOptions


def test_a_dry_run_plans_and_a_session_makes_what_is_missing(tmp_path):
    definition = changed(parse_definition(SMALL, "small", tmp_path), {"replications": 1}, "small")
    text = io.StringIO()
    console, out = Console(file=text, width=100), tmp_path / "study"
    words = console, definition, "small", out

    assert make_study(*words, StudyOptions(jobs=1), dry_run=True) is None
    assert "4 runs: 4 cells with seed 1" in text.getvalue()
    assert not out.exists()

    session = make_study(*words, StudyOptions(jobs=1), dry_run=False)
    assert (session.effort.made, session.effort.workers) == (4, 1)
    assert len(session.study.records) == len(session.plan) == 4

    next((out / "records").rglob("*.json")).unlink()
    again = make_study(*words, StudyOptions(jobs=2, resume=True), dry_run=False)
    assert (again.effort.made, again.effort.workers) == (1, 2)
