"""A study from its definition to its tables: plan, compute what is missing, keep, compare."""

from __future__ import annotations

import json
import os
import shutil
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import filelock
import tomlkit

from giveway.errors import GivewayError, ResultsError
from giveway.manifest import software_versions
from giveway.studies.execution import cluster_executor, local_executor
from giveway.studies.folder import DEFINITION, MANIFEST, StudyFolder
from giveway.studies.frames import runs_frame
from giveway.studies.identity import software_identity
from giveway.studies.output import TABLES, write_tables
from giveway.studies.plan import Plan, plan
from giveway.studies.statistics import precise_enough
from giveway.studies.store import RECORDS, RecordStore

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from giveway.studies.definition import StudyDefinition
    from giveway.studies.execution import Executor
    from giveway.studies.plan import PlannedRun
    from giveway.studies.record import RunRecord

HANG_LIMIT = 120.0  # [s] of wall clock without progress, as for a single run
LOCK = ".lock"
OURS = frozenset(
    {
        DEFINITION,
        MANIFEST,
        RECORDS,
        LOCK,
        *(f"{name}.csv" for name in TABLES),
        "datapackage.json",
        "figures",
        "report.html",
        "replays",
        "reruns",
    }
)


class StudyInterruptedError(GivewayError):
    """The user ended a study; every finished run is kept."""

    exit_code = 130  # 128 + SIGINT, as shells have it


@dataclass(frozen=True)
class StudyOptions:
    """How a study is computed, which its results do not depend on.

    Attributes:
        jobs: worker processes on this machine; None: one per processor that we may use.
        cluster: address of a Dask scheduler instead, or "local:N".
        resume: go on with what is in the folder.
        force: replace what is in the folder.
        retry_failed: make failed runs again.
        hang_limit: [s] without progress after which a run's worker is killed.
        run_limit: [s] of wall clock that one run may take; None: no limit.
    """

    jobs: int | None = None
    cluster: str | None = None
    resume: bool = False
    force: bool = False
    retry_failed: bool = False
    hang_limit: float = HANG_LIMIT
    run_limit: float | None = None

    def executor(self) -> Executor:
        """Who computes."""
        if self.cluster is not None:
            return cluster_executor(
                self.cluster, hang_limit=self.hang_limit, run_limit=self.run_limit
            )
        return local_executor(
            jobs=self.jobs or processors(), hang_limit=self.hang_limit, run_limit=self.run_limit
        )


@dataclass(frozen=True)
class StudyProgress:
    """Where a study stands."""

    total: int  # runs, as far as is known
    kept: int  # were there already
    made: int  # by this session
    failed: int  # of all that are there
    latest: RunRecord | None

    @property
    def finished(self) -> int:
        """Runs that are on disk."""
        return self.kept + self.made


def processors() -> int:
    """How many processors this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def run_study(
    definition: StudyDefinition,
    origin: str,
    out: Path,
    options: StudyOptions | None = None,
    watcher: Callable[[StudyProgress], None] | None = None,
) -> StudyFolder:
    """Compute what is missing of a study, and write its tables.

    Args:
        definition: of the study.
        origin: its file, for messages.
        out: its folder.
        options: how it is computed.
        watcher: told of every finished run.

    Raises:
        GivewayError: it cannot be run, or was ended; every finished run is kept.
    """
    options = options or StudyOptions()
    planned = plan(definition, origin)
    _check_folder(out, options)
    with _locked(out):
        if options.force:
            _clear(out)
        session = _Session(planned, out, options, watcher or (lambda _: None))
        session.begin()
        try:
            session.compute()
        except KeyboardInterrupt:
            session.end(whole=False)
            raise StudyInterruptedError(session.interrupted()) from None
        session.end(whole=True)
    return StudyFolder(out)


class _Session:
    """One process's work on a study."""

    def __init__(
        self,
        planned: Plan,
        out: Path,
        options: StudyOptions,
        watcher: Callable[[StudyProgress], None],
    ) -> None:
        self._plan = planned
        self._out = out
        self._options = options
        self._watcher = watcher
        self._store = RecordStore(out)
        self._records: dict[str, RunRecord] = {}
        self._kept = self._made = self._failed = 0
        self._seeds = planned.seeds

    def begin(self) -> None:
        """Write down what the study is; tables of a former session no longer hold."""
        for name in TABLES:
            (self._out / f"{name}.csv").unlink(missing_ok=True)
        self._write(DEFINITION, dump_definition(self._plan.definition))
        self._write_manifest()

    def compute(self) -> None:
        """Make every run that is missing, in batches if precision decides how many."""
        precision = self._plan.definition.precision
        seeds = self._plan.seeds
        with self._options.executor() as executor:
            if precision is None:
                self._make(executor, seeds)
                return
            count = min(precision.minimum, len(seeds))
            while True:
                self._make(executor, seeds[:count])
                if count == len(seeds) or self._precise(seeds[:count]):
                    break
                count = min(count + precision.batch, len(seeds))
        self._seeds = seeds[:count]

    def end(self, *, whole: bool) -> None:
        """Write the tables; of an unfinished study those that take no time."""
        if whole:
            self._write_manifest()
        write_tables(StudyFolder(self._out), whole=whole)

    def interrupted(self) -> str:
        """What to tell the user."""
        done = f"{self._kept + self._made:,} of {len(self._plan):,} runs"
        return f"interrupted; {done} are kept in {self._out}: go on with --resume"

    def _make(self, executor: Executor, seeds: range) -> None:
        missing = [run for run in self._plan.runs(seeds) if not self._known(run)]
        for record in executor.run(run.task() for run in missing):
            self._store.put(record)
            self._records[record.key] = record
            self._made += 1
            self._failed += record.failed
            self._tell(record)

    def _known(self, run: PlannedRun) -> bool:
        """Whether the run is there; the first look finds those of former sessions."""
        if run.key in self._records:
            return True
        record = self._store.get(run.key)
        if record is None or (record.failed and self._options.retry_failed):
            return False
        self._records[run.key] = record
        self._kept += 1
        self._failed += record.failed
        self._tell(None)
        return True

    def _tell(self, record: RunRecord | None) -> None:
        total = len(self._plan)
        self._watcher(StudyProgress(total, self._kept, self._made, self._failed, record))

    def _precise(self, seeds: range) -> bool:
        definition = self._plan.definition
        assert definition.precision is not None
        made = [
            (run.planned.cell, run.seed, self._records[run.key]) for run in self._plan.runs(seeds)
        ]
        frame = runs_frame(made, self._plan.design)
        enough, _ = precise_enough(
            frame,
            self._plan.design,
            definition.comparison,
            definition.precision,
            seeds=len(seeds),
        )
        return enough

    def _write_manifest(self) -> None:
        content = {
            "study": self._plan.definition.name,
            "seeds": len(self._seeds),
            "identity": software_identity(),
            "cells": [
                {
                    "cell": planned.cell.number,
                    "label": planned.cell.label,
                    "digest": planned.digest,
                    "inputs": planned.inputs,
                }
                for planned in self._plan.cells
            ],
            "software": software_versions(),
        }
        self._write(MANIFEST, json.dumps(content, indent=2, ensure_ascii=False) + "\n")

    def _write(self, name: str, text: str) -> None:
        path = self._out / name
        try:
            new = path.with_suffix(".new")
            new.write_text(text, encoding="utf-8")
            new.replace(path)
        except OSError as error:
            msg = f"{path}: cannot be written ({error.strerror}); free the disk and use --resume"
            raise ResultsError(msg) from error


def dump_definition(definition: StudyDefinition) -> str:
    """The study as TOML."""
    return tomlkit.dumps(definition.model_dump(mode="json", exclude_none=True))


def _check_folder(out: Path, options: StudyOptions) -> None:
    """Make sure that the study may go to ``out``; nothing is changed.

    Raises:
        ResultsError: it holds a study and neither resume nor force is given, or something else.
    """
    if not out.exists():
        return
    if not out.is_dir():
        msg = f"{out}: is a file; expected a folder for the study, name another with --out"
        raise ResultsError(msg)
    present = {path.name for path in out.iterdir()} - {LOCK}
    foreign = sorted(present - OURS)
    if foreign:
        msg = (
            f"{out}: holds '{foreign[0]}', which no study of giveway wrote; name another folder "
            "with --out"
        )
        raise ResultsError(msg)
    if present and not (options.resume or options.force):
        msg = (
            f"{out}: a study is there; go on with it by --resume, replace it by --force, or name "
            "another folder with --out"
        )
        raise ResultsError(msg)


def _clear(out: Path) -> None:
    for name in OURS - {LOCK}:
        path = out / name
        try:
            if path.is_dir():
                shutil.rmtree(path)
            else:
                path.unlink(missing_ok=True)
        except OSError as error:
            msg = f"{path}: cannot be removed ({error.strerror}); name another folder with --out"
            raise ResultsError(msg) from error


@contextmanager
def _locked(out: Path) -> Iterator[None]:
    """No two processes work on one study; a killed one holds nothing.

    Raises:
        ResultsError: another does, or the folder cannot be made.
    """
    try:
        out.mkdir(parents=True, exist_ok=True)
        lock = filelock.FileLock(out / LOCK, timeout=0)
        lock.acquire()
    except filelock.Timeout:
        msg = f"{out}: another giveway study is at work there; wait for it, or name another --out"
        raise ResultsError(msg) from None
    except OSError as error:
        msg = f"{out}: cannot be written ({error.strerror}); name another folder with --out"
        raise ResultsError(msg) from error
    try:
        yield
    finally:
        lock.release()


def estimate(planned: Plan, options: StudyOptions) -> tuple[float, dict[str, Any]]:
    """How long a study will take [s], from one run of each cell; nothing is kept.

    Returns:
        The whole time on the workers that ``options`` ask for, and the seconds of one run by the
        number of its cell.
    """
    seeds = planned.seeds
    tasks = [run.task() for seed in seeds[:2] for run in planned.runs(range(seed, seed + 1))]
    seconds: dict[str, Any] = {}
    with options.executor() as executor:
        workers = executor.workers
        for record in executor.run(iter(tasks)):
            cell = record.run.partition("-")[0].removeprefix("c")
            if record.failed:
                raise GivewayError(f"run {record.run}: {record.failure}")
            known = seconds.get(cell, record.computing.seconds)
            seconds[cell] = min(known, record.computing.seconds)  # the first run warms up
    return sum(seconds.values()) * len(seeds) / workers, seconds
