"""The run of a study: plan, compute the missing runs, keep them, compare."""

import math
from collections import defaultdict
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from giveway.errors import GivewayError
from giveway.processes.interrupts import exit_code_of, who_ended
from giveway.studies.definition import StudyDefinition, dump_definition
from giveway.studies.execution import Executor
from giveway.studies.folder.folder_contents import DEFINITION
from giveway.studies.folder.frames import runs_frame
from giveway.studies.folder.lock import reserved
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.folder.table_files import write_tables
from giveway.studies.keeping import Keeper
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
        session = _Session(planned, out, options, watcher or (lambda _: None), tell)
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
        tell: Callable[[str], None] | None,
    ) -> None:
        self._plan = planned
        self._out = out
        self._options = options
        self._watcher = watcher
        self._keeper = Keeper(out, DEFINITION, dump_definition(planned.definition, out), tell)
        self._records: dict[str, RunRecord] = {}
        self._kept = self._made = self._failed = 0
        self._seeds = planned.seeds
        self._begun = False

    def begin(self) -> None:
        """Write definition and manifest, and remove tables and report of a former session."""
        self._keeper.begin(force=self._options.force)
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
            record = self._keeper.kept(run.key)
            if record is None or (record.failed and self._options.retry_failed):
                missing[run.key].append(run)
            else:
                self._records[run.key] = record
                self._kept += 1
                self._failed += record.failed
                self._report(None)
        for record in self._keeper.make(executor, (runs[0].task() for runs in missing.values())):
            self._records[record.key] = record
            count = len(missing[record.key])
            self._made += count
            self._failed += count * record.failed
            self._report(record)

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
        }
        cells = [
            {
                "cell": planned.cell.number,
                "label": planned.cell.label,
                "digest": planned.digest,
                "inputs": planned.inputs,
            }
            for planned in self._plan.cells
        ]
        self._keeper.write_manifest(content, cells)


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
