"""The run of a study: plan, compute the missing runs, keep them, compare."""

import json
import math
import sys
from collections import defaultdict
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from giveway.errors import GivewayError
from giveway.gate import fingerprint, signed
from giveway.processes.interrupts import exit_code_of, who_ended
from giveway.results.provenance import processor, software_versions
from giveway.studies.definition import StudyDefinition, dump_definition
from giveway.studies.execution import Executor
from giveway.studies.folder.atomic_files import write_atomically
from giveway.studies.folder.folder_contents import DEFINITION, MANIFEST, broken_files, read_manifest
from giveway.studies.folder.frames import runs_frame
from giveway.studies.folder.lock import remove_derived_files, remove_study, reserved
from giveway.studies.folder.sealing import BrokenFileError, put_aside, sealed
from giveway.studies.folder.store import RecordStore
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.folder.table_files import write_tables
from giveway.studies.identity import differences, relevant_versions, software_identity
from giveway.studies.plan import Plan, PlannedRun, plan
from giveway.studies.record import RunRecord
from giveway.studies.statistics import looks, precise_enough
from giveway.studies.study_options import StudyOptions

__all__ = [
    "StudyInterruptedError",
    "StudyOptions",
    "StudyProgress",
    "estimate",
    "run_study",
]


class StudyInterruptedError(GivewayError):
    """The user ended a study; every finished run is kept."""

    exit_code = 130  # 128 + SIGINT, as shells have it


@dataclass(frozen=True)
class StudyProgress:
    """The progress of a study."""

    total: int  # number of runs, if it is known
    kept: int  # number of runs kept from former sessions
    made: int  # number of runs made in this session
    failed: int  # number of failed runs among both
    latest: RunRecord | None

    @property
    def finished(self) -> int:
        """The number of runs that are on disk."""
        return self.kept + self.made


def run_study(
    definition: StudyDefinition,
    origin: str,
    out: Path,
    options: StudyOptions | None = None,
    watcher: Callable[[StudyProgress], None] | None = None,
    tell: Callable[[str], None] | None = None,
) -> StudyFolder:
    """Compute the missing runs of a study, and write its tables.

    Args:
        definition: Definition of the study.
        origin: File of the study, for messages.
        out: Folder of the study.
        options: Options of the computation.
        watcher: Function that is called with every finished run.
        tell: Function that takes one line for each kept file that is broken, and when runs of
            another giveway version are made again. None for standard error.

    Raises:
        GivewayError: the study cannot be run, or was ended; every finished run is kept.
    """
    options = options or StudyOptions()
    planned = plan(definition, origin)
    with reserved(out, definition.name, options):
        session = _Session(planned, out, options, watcher or (lambda _: None), tell or _to_stderr)
        try:
            with options.executor() as executor:
                session.begin()
                session.compute(executor)
            session.end()
        except KeyboardInterrupt as error:
            with suppress(KeyboardInterrupt):  # a second Ctrl-C skips the tables
                session.write_partial_tables()
            ended = StudyInterruptedError(f"{who_ended(error)}; {session.kept()}")
            ended.exit_code = exit_code_of(error)
            raise ended from None
    return StudyFolder(out)


class _Session:
    """The work of one process on a study."""

    def __init__(
        self,
        planned: Plan,
        out: Path,
        options: StudyOptions,
        watcher: Callable[[StudyProgress], None],
        tell: Callable[[str], None],
    ) -> None:
        self._plan = planned
        self._out = out
        self._options = options
        self._watcher = watcher
        self._tell = tell
        self._software = software_identity()
        self._store = RecordStore(out, self._software)
        self._records: dict[str, RunRecord] = {}
        self._kept = self._made = self._failed = 0
        self._seeds = planned.seeds
        self._definition = dump_definition(planned.definition)
        self._begun = False
        self._processors: set[str] = set()  # of which the user has been told

    def begin(self) -> None:
        """Write definition and manifest, and remove tables and report of a former session."""
        if self._options.force:
            remove_study(self._out)
        for file in broken_files(self._out):
            there = put_aside(file, self._out)
            self._tell(f"{file}: is not what giveway wrote; put aside in {there}, it is made again")
        with suppress(OSError, KeyError):
            manifest = read_manifest(self._out)
            before = manifest["identity"]
            if before != self._software:
                differ = differences(relevant_versions(manifest["software"]))
                self._tell(
                    f"{self._out}: its runs were made by another giveway, other libraries or a "
                    f"machine of another kind (identity {before}, now {self._software}: {differ}); "
                    "they are made again"
                )
        remove_derived_files(self._out)
        write_atomically(self._out / DEFINITION, self._definition, durable=True)
        self._write_manifest(complete=False)
        self._begun = True

    def compute(self, executor: Executor) -> None:
        """Make every run that is missing, in batches if precision decides how many."""
        precision = self._plan.definition.precision
        seeds = self._plan.seeds
        if precision is None:
            self._make(executor, seeds)
            return
        before = 0
        for count in looks(precision, len(seeds)):
            self._make(executor, seeds[before:count])
            before, self._seeds = count, seeds[:count]
            if count < len(seeds) and self._precise():
                return

    def end(self) -> None:
        """Write the tables, then mark the study as complete."""
        # the precision that was reached has fixed the number of seeds
        self._write_manifest(complete=False)
        write_tables(StudyFolder(self._out), whole=True)
        self._write_manifest(complete=True)

    def write_partial_tables(self) -> None:
        """Write the tables that are quickly made, after an interruption."""
        if self._begun:
            self._seeds = self._plan.seeds
            self._write_manifest(complete=False)
            write_tables(StudyFolder(self._out), whole=False)

    def kept(self) -> str:
        """Return the message to a user who has ended the study."""
        done = f"{self._kept + self._made:,} of {len(self._plan):,} runs"
        return f"{done} are kept in {self._out}: go on with --resume"

    def _make(self, executor: Executor, seeds: range) -> None:
        """Make the missing runs of ``seeds``.

        Cells with equal settings share runs.
        """
        missing: defaultdict[str, list[PlannedRun]] = defaultdict(list)
        for run in self._plan.runs(seeds):
            record = self._kept_record(run.key)
            if record is None or (record.failed and self._options.retry_failed):
                missing[run.key].append(run)
            else:
                self._records[run.key] = record
                self._tell_processor(record)
                self._kept += 1
                self._failed += record.failed
                self._report(None)
        for record in executor.run(runs[0].task() for runs in missing.values()):
            self._store.put(record)
            self._records[record.key] = record
            self._tell_processor(record)
            if record.computing.retried and not record.failed:
                self._tell(f"{record.run}: {record.computing.retried}; another process has made it")
            count = len(missing[record.key])
            self._made += count
            self._failed += count * record.failed
            self._report(record)

    def _tell_processor(self, record: RunRecord) -> None:
        """Tell the user once of each processor, other than this one, that has made a run."""
        name, here = record.computing.processor, processor()["name"]
        if name not in {"", here, *self._processors}:
            self._processors.add(name)
            self._tell(
                f"{record.run}: made on another processor ({name}; here {here}); the bytes are the "
                "same (docs/results.md)"
            )

    def _kept_record(self, key: str) -> RunRecord | None:
        """Return the record of a run that has been made.

        A broken record is reported and put aside.
        """
        try:
            return self._store.get(key)
        except BrokenFileError as error:
            there = put_aside(error.file, self._out)
            self._tell(
                f"{error.file}: is not what giveway wrote ({error.reason}); put aside in {there}, "
                "the run is made again"
            )
            return None

    def _report(self, record: RunRecord | None) -> None:
        total = len(self._plan)
        self._watcher(StudyProgress(total, self._kept, self._made, self._failed, record))

    def _precise(self) -> bool:
        """Return whether the seeds so far determine the difference precisely enough."""
        definition, design = self._plan.definition, self._plan.design
        assert definition.precision is not None
        made = [
            (run.planned.cell, run.seed, self._records[run.key])
            for run in self._plan.runs(self._seeds)
        ]
        enough, _ = precise_enough(
            runs_frame(made, design),
            design,
            definition.comparison,
            definition.precision,
            seeds=len(self._seeds),
        )
        return enough

    def _write_manifest(self, *, complete: bool) -> None:
        content = {
            "study": self._plan.definition.name,
            "seeds": len(self._seeds),
            "complete": complete,
            "identity": self._software,
            "definition": fingerprint(self._definition.encode("utf-8")),
            "cells": [
                {
                    "cell": planned.cell.number,
                    "label": planned.cell.label,
                    "digest": planned.digest,
                    "inputs": planned.inputs,
                }
                for planned in self._plan.cells
            ],
            "software": dict(software_versions()),
        }
        whole = signed(sealed(content, self._software))
        text = json.dumps(whole, indent=2, ensure_ascii=False) + "\n"
        write_atomically(self._out / MANIFEST, text, durable=True)


def estimate(planned: Plan, options: StudyOptions) -> tuple[float, dict[str, float]]:
    """Estimate the time [s] that a study will take, from two runs of each cell.

    These runs are not kept.

    Returns:
        The whole time on the workers of ``options``, and the seconds of one run by the number of
        its cell. They are nan if the run failed, and the whole time leaves that cell out.
    """
    seeds = planned.seeds
    tasks = [run.task() for seed in seeds[:2] for run in planned.runs(range(seed, seed + 1))]
    seconds: dict[str, float] = {}
    with options.executor() as executor:
        workers = executor.workers
        for record in executor.run(iter(tasks)):
            cell = record.run.partition("-")[0].removeprefix("c")
            taken = math.nan if record.failed else record.computing.seconds
            # the first run is slower: it warms up
            seconds[cell] = float(np.fmin(seconds.get(cell, math.nan), taken))
    return float(np.nansum([*seconds.values()])) * len(seeds) / workers, seconds


def _to_stderr(line: str) -> None:
    sys.stderr.write(f"note: {line}\n")
