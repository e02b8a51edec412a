"""Recovery after a crash of native code: the recorded rows become a result like any other."""

import shutil
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from giveway.api import Outputs, in_journal, keep
from giveway.config import RunConfig
from giveway.config.files.foreign_code import named_in
from giveway.config.files.layers import build_config, read_toml_text
from giveway.config.files.loading import load
from giveway.config.files.toml import parse_toml
from giveway.config.files.trust import code_of
from giveway.errors import CrashError, GivewayError, ResultsError
from giveway.gate import is_own
from giveway.journal.journal_reader import JournalContents, read_journal
from giveway.journal.recorded import RecordedRows
from giveway.processes.heartbeat import Heartbeat
from giveway.processes.interrupts import DeferredInterrupt
from giveway.processes.locks import FolderInUseError, locked
from giveway.processes.supervisor import Verdict, journals, verdict_on_left
from giveway.results.ego_result import results_of_egos
from giveway.results.folder import is_marked_only, release_folder, taken_folder
from giveway.results.provenance import RunFacts, manifest
from giveway.results.run_result import RunResult
from giveway.run_data.progress import Ending
from sumo_scenarios import Scenario


def recover(journal: Path, verdict: Verdict) -> CrashError:
    """Write the rows of a run whose process died, and report the cause of its death.

    Args:
        journal: Folder of the dead process's journal, which this process has made.
        verdict: Verdict on the end of the process.

    Returns:
        The error to report; its ``result`` holds the rows, if there are any.

    Raises:
        GivewayError: the rows cannot be read or written.
    """
    contents = read_journal(journal)
    how = "the user has ended the run" if verdict.interrupted else "the run's process died"
    if not contents.meta:
        doctor = "" if verdict.interrupted else "; run 'giveway doctor'"
        return CrashError(f"{how}: {verdict.message}{doctor}")
    config, scenario = load([read_toml_text(contents.meta["config"], "the run's configuration")])
    doctor = f"; 'giveway doctor {config.scenario}' looks for the cause"
    report = f"{scenario.config_file}: {how}: {named_in(verdict.message, config)}"
    report += "" if verdict.interrupted else doctor
    error = CrashError(report)
    folder = None if contents.meta["results"] is None else Path(contents.meta["results"])
    if not contents.commits:
        if folder is not None and contents.meta["taken"]:
            release_folder(folder)
        return error
    error.result = result = _result_of(config, scenario, contents, error, verdict)
    if folder is not None:
        try:
            keep(result, folder, contents.meta["taken"], _outputs(contents))
        except ResultsError as failure:
            Heartbeat(journal).keep()
            failure.args = (f"{report}; {failure}; {in_journal(journal)}",)
            raise
        error.args = (f"{report}; rows up to then are in {folder}",)
    return error


@dataclass(frozen=True)
class LeftJournal:
    """The journal of a run that was killed together with its supervisor.

    Attributes:
        path: Folder of the journal.
        scenario: Scenario of the run.
        results: Folder for its results, or None without one.
        steps: Number of recorded steps.
        clock: Latest instant [s] on SUMO's clock.
    """

    path: Path
    scenario: str
    results: Path | None
    steps: int
    clock: float


def left_journals() -> list[LeftJournal]:
    """Return the journals with rows that killed runs have left, oldest first."""
    found = []
    for path in journals():
        with suppress(GivewayError, OSError):
            left = _look_at(path, read_journal(path))
            if left.steps:
                found.append(left)
    return found


def recover_left(
    journal: Path, out: Path | None = None, *, force: bool = False
) -> tuple[RunResult, Path]:
    """Write the rows in a journal that a killed run has left, and remove the journal.

    Args:
        journal: Folder of the journal.
        out: Folder for the rows, or None for the run's own.
        force: True to replace existing results.

    Returns:
        The result, and its folder.

    Raises:
        ResultsError: there is no such journal, its run is still going on, or nothing can be
            written; the journal stays.
    """
    try:
        with locked(journal):
            left = _look_at(journal, contents := read_journal(journal))
            folder = out or left.results
            own = is_own(contents.meta)
            if out is None and folder is not None and not own:
                raise ResultsError(
                    f"{journal}: another user or another giveway wrote this journal, whose folder "
                    f"for the results ({folder}) is not used; name one with --out"
                )
            if folder is None:
                raise ResultsError(f"{journal}: the run wrote no results; name a folder with --out")
            if not left.steps:
                raise ResultsError(f"{journal}: the run was killed before its first row")
            layer = read_toml_text(contents.meta["config"], "the run's configuration")
            code = [] if own else code_of(build_config([layer]))
            if code:
                raise ResultsError(
                    f"{journal}: another user or another giveway wrote this journal, and it names "
                    f"code, '{code[0].name}', which would run; recover it as that user"
                )
            config, scenario = load([layer])
            verdict = verdict_on_left(journal)
            error = CrashError(f"{scenario.config_file}: the run was {verdict.message}")
            result = _result_of(config, scenario, contents, error, verdict)
            replaced = force or is_marked_only(folder)
            with DeferredInterrupt(), taken_folder(folder, force=replaced) as taken:
                keep(result, folder, taken, _outputs(contents))
            shutil.rmtree(journal, ignore_errors=True)
    except FolderInUseError:
        raise ResultsError(f"{journal}: its run is still at work; wait for it, or end it") from None
    except (LookupError, TypeError, ValueError):
        raise ResultsError(
            f"{journal}: another version of giveway wrote this journal; recover it with that one"
        ) from None
    except OSError as error:
        raise ResultsError(
            f"{journal}: no journal can be read there ({error.strerror}); 'giveway recover' lists "
            "those that there are"
        ) from error
    return result, folder


def _outputs(contents: JournalContents) -> Outputs:
    """Return the outputs that the run was to write."""
    meta = contents.meta
    return Outputs(
        parquet=meta["parquet"], trajectories=meta["trajectories"], pictures=meta["pictures"]
    )


def _look_at(journal: Path, contents: JournalContents) -> LeftJournal:
    config, results = (contents.meta.get(name) for name in ("config", "results"))
    known = {"config", "results"} <= contents.meta.keys()
    if not (known and isinstance(config, str) and isinstance(results, str | None)):
        raise ResultsError(
            f"{journal}: holds no journal of a run; 'giveway recover' lists those that there are"
        )
    settings = parse_toml(config, str(journal))
    return LeftJournal(
        path=journal,
        scenario=str(settings.get("scenario", "")),
        results=None if results is None else Path(results),
        steps=contents.commits,
        clock=contents.pulse.time,
    )


def _result_of(
    config: RunConfig,
    scenario: Scenario,
    contents: JournalContents,
    error: CrashError,
    verdict: Verdict,
) -> RunResult:
    rows = RecordedRows(contents.tables, contents.names)
    ending = Ending.INTERRUPTED if verdict.interrupted else Ending.CRASHED
    failure = None if verdict.interrupted else error
    configs = {ego.ego_id: ego for ego in config.each_ego()}
    endings = {
        ego.id: Ending.COMPLETED
        for ego in rows.egos()
        if ego.track.position[-1] >= ego.goal  # the ego had reached its goal before the crash
    }
    return RunResult(
        config=config,
        scenario=scenario,
        ending=ending,
        error=failure,
        time=rows.time,
        egos=results_of_egos(configs, rows, ending, endings),
        crowd_track=rows.crowd_track(),
        background_track=rows.background_track(),
        signal_track=rows.signal_track(),
        sight_track=rows.sight_track(),
        people_track=rows.people_track(),
        timings=rows.timings(),
        elapsed=float(np.nansum(rows.timings().seconds[:, -1])),
        facts=manifest(
            config,
            scenario,
            RunFacts(pedestrians=rows.ledger),
            config_text=contents.meta["config"],
            remarks=(),
            ending=str(ending),
            error=None if failure is None else str(failure),
        ),
        sumo_messages="\n".join(part for part in (verdict.last_words, verdict.traceback) if part),
        road=(),
        remarks=(),
    )
