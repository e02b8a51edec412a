"""A small study that is really run: two controllers, two crowds, five seeds."""

from __future__ import annotations

from pathlib import Path

import pytest

SMALL = """
name = "small"
replications = 5
[run]
time_limit = 2.0
[factors]
"crowd.pedestrians" = [3, 2]
controller = ["mpc", "pid"]
[comparison]
minimum_pairs = 4
resamples = 99
"""
TABLES = ("runs", "cells", "levels", "comparison", "situations", "failures")


@pytest.fixture(scope="session")
def study_of():
    """Runs a study from its text: (text, folder, **options) -> StudyFolder."""

    from giveway.studies.definition import parse_definition
    from giveway.studies.study import StudyOptions, run_study

    def make(text: str, out: Path, watcher=None, **options):
        definition = parse_definition(text, "study.toml", Path())
        return run_study(
            definition, "study.toml", out, StudyOptions(**{"jobs": 1, **options}), watcher
        )

    return make


@pytest.fixture(scope="session")
def small_study_text() -> str:
    return SMALL


@pytest.fixture(scope="session")
def small_study(study_of, tmp_path_factory):
    """The small study, finished; nobody changes its folder."""
    return study_of(SMALL, tmp_path_factory.mktemp("study") / "small")


@pytest.fixture(scope="session")
def tables_of():
    """The bytes of everything that must not depend on how a study was computed."""

    def read(folder: Path) -> dict[str, bytes]:
        names = [f"{name}.csv" for name in TABLES]
        return {n: (folder / n).read_bytes() for n in (*names, "study.toml", "manifest.json")}

    return read
