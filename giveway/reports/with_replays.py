"""The report of a study, with the runs that it shows made again and played on pages."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from giveway.errors import GivewayError
from giveway.replays import write_replay
from giveway.reports import write_report
from giveway.studies.rerun import checked_run, rerun

if TYPE_CHECKING:
    from collections.abc import Callable

    from giveway.results.run_result import RunResult
    from giveway.studies.folder import StudyFolder

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
    """

    def result(run: str) -> RunResult:
        tell(f"Run {run} for an example ...")
        return rerun(study, run, None)

    def page(run: str) -> Path | None:
        tell(f"Run {run} for its replay ...")
        return _replay(study, run)

    shutil.rmtree(study.path / REPLAYS, ignore_errors=True)
    if not replays:
        return write_report(study)
    return write_report(study, rerun=result, replay=page)


def _replay(study: StudyFolder, run: str) -> Path | None:
    """Write the page that plays a run; None where the run cannot be made any more."""
    with tempfile.TemporaryDirectory(prefix="giveway-replay-") as temporary:
        folder = Path(temporary) / run
        try:
            checked = checked_run(study, run, predictions=True)
            rerun(study, run, folder, checked=checked, pictures=False)
        except GivewayError:
            return None  # its scenario has changed or is missing
        target = study.path / REPLAYS / f"{run}.html"
        target.parent.mkdir(exist_ok=True)
        return write_replay(folder, target)
