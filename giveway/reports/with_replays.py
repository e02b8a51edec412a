"""The report of a study, with the runs that it shows made again and played on pages."""

import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path

from giveway.errors import GivewayError
from giveway.records.progress import Ending
from giveway.replays import write_replay
from giveway.reports import write_report
from giveway.results.run_result import RunResult
from giveway.studies.folder import StudyFolder
from giveway.studies.rerun import checked_run, rerun

REPLAYS = "replays"


def write_report_of(
    study: StudyFolder, *, replays: bool = True, tell: Callable[[str], None] = lambda _: None
) -> Path:
    """Write figures, replays and ``report.html`` into the study's folder.

    Args:
        study: its folder.
        replays: make the runs that the report shows once more, for pages that play them and
            for the examples of speed and gap.
        tell: takes one line at each step.

    Raises:
        GivewayError: the disk is full.
        KeyboardInterrupt: the user has ended it.
    """

    def result(run: str) -> RunResult:
        tell(f"Run {run} for an example ...")
        return _whole(rerun(study, run, None))

    def page(run: str) -> Path | None:
        tell(f"Run {run} for its replay ...")
        return _replay(study, run)

    shutil.rmtree(study.path / REPLAYS, ignore_errors=True)
    if not replays:
        return write_report(study)
    return write_report(study, rerun=result, replay=page)


def _whole(result: RunResult) -> RunResult:
    """A run that was not cut off, which a report would show as if it had ended there.

    Raises:
        KeyboardInterrupt: the user has ended it, and means the report.
    """
    if result.ending is Ending.INTERRUPTED:
        raise KeyboardInterrupt
    return result


def _replay(study: StudyFolder, run: str) -> Path | None:
    """Write the page that plays a run; None where the run cannot be made any more."""
    with tempfile.TemporaryDirectory(prefix="giveway-replay-") as temporary:
        folder = Path(temporary) / run
        try:
            checked = checked_run(study, run, predictions=True)
            _whole(rerun(study, run, folder, checked=checked, pictures=False))
        except GivewayError:
            return None  # its scenario has changed or is missing
        target = study.path / REPLAYS / f"{run}.html"
        target.parent.mkdir(exist_ok=True)
        return write_replay(folder, target)
