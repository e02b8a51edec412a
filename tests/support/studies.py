"""A small study that is really run: two controllers, two crowds, five seeds."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from giveway.studies.record import RunRecord, Task

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


class InThisProcess:
    """An executor without processes, for tests of what is kept and not of how it is computed."""

    workers = 1

    def __enter__(self) -> InThisProcess:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def run(self, tasks: Iterable[Task]) -> Iterator[RunRecord]:
        from giveway.studies.execution.perform import perform

        for task in tasks:
            yield perform(task)


@pytest.fixture(scope="session")
def study_of():
    """Runs a study from its text: (text, folder, **options) -> StudyFolder.

    In this process, unless ``jobs`` or ``cluster`` are among the options.
    """

    from giveway.studies.definition import parse_definition
    from giveway.studies.study import StudyOptions, run_study

    class OptionsHere(StudyOptions):
        def executor(self) -> Any:
            here = self.jobs is None and self.cluster is None
            return InThisProcess() if here else super().executor()

    def make(text: str, out: Path, watcher=None, **options):
        definition = parse_definition(text, "study.toml", Path())
        return run_study(definition, "study.toml", out, OptionsHere(**options), watcher)

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
