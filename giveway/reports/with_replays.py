"""The report of a study or risk with replays: the runs that it shows are made again."""

import time
from collections.abc import Callable, Collection, Sequence
from pathlib import Path

from fmus.archive.own_folder import OwnFolder
from giveway.errors import GivewayError
from giveway.processes.interrupts import DeferredInterrupt, ended_by
from giveway.replays import write_replay
from giveway.reports.examples import Drive, drives_of
from giveway.reports.kept_runs import REPLAYS, KeptRuns
from giveway.reports.report_page import shown_runs, write_report
from giveway.reports.risk_page import write_risk_page
from giveway.results.folder import Destination
from giveway.results.run_result import RunResult
from giveway.risk.causes import likeliest
from giveway.risk.risk_folder import RiskFolder
from giveway.risk.tables import write_risk_tables
from giveway.run_data.progress import Ending
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.repeated_run import Runs, checked_run, rerun


def write_report_of(
    study: StudyFolder,
    *,
    replays: bool = True,
    tell: Callable[[str], None] = lambda _: None,
    trusted: Collection[str] = (),
    warn: Callable[[str], None] = lambda _: None,
) -> Path:
    """Write figures, replays and ``report.html`` into the study's folder.

    Args:
        study: Folder of the study.
        replays: True to make again the runs that the report shows, for replays and for the examples
            of speed and gap. Runs that a former report has made are kept.
        tell: Function that takes one line at each step.
        trusted: Code, as module:Class, that the study may import.
        warn: Function that takes one line if runs cannot be made again.

    Raises:
        GivewayError: the disk is full.
        KeyboardInterrupt: the user has ended it.
    """
    if not replays:
        return write_report(study)
    kept, lost = _made_again(shown_runs(study), study, tell, trusted, warn)

    def drives(run: str) -> Sequence[Drive]:
        if run in lost:
            raise lost[run]
        return kept.drives(run)

    tell("Drawing the figures ...")
    return write_report(study, drives=drives, replay=lambda run: _page(kept, run, lost))


def write_report_of_risk(
    risk: RiskFolder,
    *,
    replays: bool = True,
    tell: Callable[[str], None] = lambda _: None,
    trusted: Collection[str] = (),
    warn: Callable[[str], None] = lambda _: None,
) -> Path:
    """Write tables, replays and ``report.html`` into the folder of a risk.

    The arguments are those of :func:`write_report_of`.

    Raises:
        GivewayError: runs are missing, or the disk is full.
        KeyboardInterrupt: the user has ended it.
    """
    write_risk_tables(risk)
    pages: dict[str, str] = {}
    if replays:
        runs = [one.run.id for one in likeliest(risk)]
        kept, lost = _made_again(runs, risk, tell, trusted, warn)
        pages = {run: f"{REPLAYS}/{kept.page(run).name}" for run in runs if run not in lost}
    return write_risk_page(risk, pages)


def _made_again(
    runs: Sequence[str],
    study: Runs,
    tell: Callable[[str], None],
    trusted: Collection[str],
    warn: Callable[[str], None],
) -> tuple[KeptRuns, dict[str, GivewayError]]:
    """Keep the pages and drives of the runs that a report shows, and of no others.

    Returns:
        The kept runs, and the errors of those that cannot be made again, by their ids.
    """
    kept = KeptRuns(study)
    kept.only(runs)
    lost = _make([run for run in runs if not kept.has(run)], study, kept, tell, trusted)
    if lost:
        first = next(iter(lost.values()))
        warn(f"{len(lost)} of {len(runs)} shown runs have no replay: {first}")
    return kept, lost


def _page(kept: KeptRuns, run: str, lost: dict[str, GivewayError]) -> Path | None:
    return None if run in lost else kept.page(run)


def _make(
    runs: Sequence[str],
    study: Runs,
    kept: KeptRuns,
    tell: Callable[[str], None],
    trusted: Collection[str],
) -> dict[str, GivewayError]:
    """Make runs again, and keep their pages and drives.

    Returns:
        The errors of the runs that cannot be made again, by their ids.
    """
    lost: dict[str, GivewayError] = {}
    begun = time.monotonic()
    for done, run in enumerate(runs):
        left = (time.monotonic() - begun) / done * (len(runs) - done) if done else 0.0
        about = f", about {left:.0f} s left" if left >= 1.0 else ""
        tell(f"Making run {run} again for its replay, {done + 1} of {len(runs)}{about} ...")
        with OwnFolder("giveway-replay-") as temporary:
            folder = Path(temporary) / run
            try:
                checked = checked_run(study, run, predictions=True, trusted=trusted)
                files = Destination(folder, pictures=False)
                result = _whole(rerun(study, run, files, checked=checked))
            except GivewayError as error:
                lost[run] = error  # the run's scenario has changed or is missing
                continue
            write_replay(folder, kept.page(run))
            kept.keep(run, drives_of(result))
    return lost


def _whole(result: RunResult) -> RunResult:
    """Return the run, unless the user interrupted it: then it would look complete in a report.

    Raises:
        KeyboardInterrupt: the user has interrupted the run, and so the report.
    """
    if result.ending is Ending.INTERRUPTED:
        raise ended_by(DeferredInterrupt.latest)
    return result
