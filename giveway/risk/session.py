"""The estimation of a risk: the missing runs are made, and the tables written."""

from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

from giveway.processes.interrupts import exit_code_of, who_ended
from giveway.risk.definition import RiskDefinition, dump_risk
from giveway.risk.plan import RiskPlan, RiskRun, batches, plan_risk
from giveway.risk.risk_folder import RISK_FILE, RiskFolder
from giveway.risk.tables import write_risk_tables
from giveway.studies.execution import Executor
from giveway.studies.folder.lock import reserved
from giveway.studies.keeping import Keeper
from giveway.studies.record import RunRecord, Task
from giveway.studies.study import StudyInterruptedError, StudyProgress
from giveway.studies.study_options import StudyOptions


def run_risk(
    definition: RiskDefinition,
    origin: str,
    out: Path,
    options: StudyOptions | None = None,
    watcher: Callable[[StudyProgress], None] | None = None,
    tell: Callable[[str], None] | None = None,
) -> RiskFolder:
    """Estimate a probability: make the missing runs, and write the tables.

    Args:
        definition: Definition of the risk.
        origin: File of the risk, for messages.
        out: Folder of the risk.
        options: Options of the computation.
        watcher: Function that is called with every finished run.
        tell: Function that takes one line for each kept file that is broken. None for standard
            error.

    Raises:
        GivewayError: the risk cannot be estimated, or was ended; every finished run is kept.
    """
    options = options or StudyOptions()
    planned = plan_risk(definition, origin)
    with reserved(out, definition.name, options):
        session = _Session(planned, out, options, watcher, tell)
        try:
            with options.executor() as executor:
                session.begin()
                session.compute(executor)
            return session.end()
        except KeyboardInterrupt as error:
            ended = StudyInterruptedError(
                f"{who_ended(error)}; {session.finished:,} runs are kept in {out}: go on with "
                "--resume"
            )
            ended.exit_code = exit_code_of(error)
            raise ended from None


class _Session:
    """The work of one process on a risk."""

    def __init__(
        self,
        planned: RiskPlan,
        out: Path,
        options: StudyOptions,
        watcher: Callable[[StudyProgress], None] | None,
        tell: Callable[[str], None] | None,
    ) -> None:
        self._plan, self._out, self._options = planned, out, options
        self._watcher = watcher or (lambda _: None)
        self._keeper = Keeper(out, RISK_FILE, dump_risk(planned.definition), tell)
        self._kept = self._made = self._failed = 0

    @property
    def finished(self) -> int:
        """The number of runs that are on disk."""
        return self._kept + self._made

    def begin(self) -> None:
        """Write definition and manifest, and remove the tables of a former session."""
        self._keeper.begin(force=self._options.force)
        self._write_manifest(complete=False)

    def compute(self, executor: Executor) -> None:
        """Make every run that the estimator asks for."""
        asking = batches(self._plan)
        with suppress(StopIteration):
            runs = next(asking)
            while True:
                records = self._records(executor, runs)
                runs = asking.send([records[run.key] for run in runs])

    def end(self) -> RiskFolder:
        """Write the tables, then mark the risk as complete."""
        write_risk_tables(RiskFolder(self._out, self._plan))
        self._write_manifest(complete=True)
        return RiskFolder(self._out, self._plan)

    def _records(self, executor: Executor, runs: list[RiskRun]) -> dict[str, RunRecord]:
        """Return the record of each run of a batch by its key."""
        records: dict[str, RunRecord] = {}
        missing: list[RiskRun] = []
        for run in runs:
            record = self._keeper.kept(run.key)
            if record is None or (record.failed and self._options.retry_failed):
                missing.append(run)
            else:
                records[run.key] = record
                self._kept += 1
                self._failed += record.failed
                self._report(None)
        for record in self._keeper.make(executor, self._tasks(missing)):
            records[record.key] = record
            self._made += 1
            self._failed += record.failed
            self._report(record)
        return records

    def _tasks(self, runs: list[RiskRun]) -> Iterator[Task]:
        return (self._plan.task(run) for run in {run.key: run for run in runs}.values())

    def _report(self, record: RunRecord | None) -> None:
        definition, groups = self._plan.definition, len(self._plan.inputs.groups)
        total = max(definition.runs + definition.why * (groups + 2), self.finished)
        self._watcher(StudyProgress(total, self._kept, self._made, self._failed, record))

    def _write_manifest(self, *, complete: bool) -> None:
        definition = self._plan.definition
        content = {
            "study": definition.name,
            "kind": "risk",
            "seeds": definition.runs,
            "complete": complete,
        }
        cell = {
            "cell": 1,
            "label": definition.event,
            "digest": self._plan.digest,
            "inputs": self._plan.hashes,
        }
        self._keeper.write_manifest(content, [cell])
