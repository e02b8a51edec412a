"""``giveway report``: figures, replays and the HTML report of a study."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.console import Console

from giveway.cli.printing import print_place
from giveway.studies.folder import StudyFolder

if TYPE_CHECKING:
    from pathlib import Path


def report_command(study: Path, *, replays: bool, quiet: bool) -> int:
    """Write figures, replays and report anew; only the runs that are shown are computed again.

    Args:
        study: the study's folder.
        replays: whether to make the shown runs again.
        quiet: print nothing.

    Raises:
        GivewayError: there is no study, or nothing to show, or the disk is full.
    """
    write_all(StudyFolder.open(study), Console(quiet=quiet), replays=replays)
    return 0


def write_all(study: StudyFolder, console: Console, *, replays: bool = True) -> None:
    """Write figures, replays and report, and the tables unless those of all runs exist."""
    from giveway.precompile import compile_kernels_once
    from giveway.reports.with_replays import write_report_of
    from giveway.studies.output import write_tables

    compile_kernels_once(console)
    if not (study.complete and (study.path / "comparison.csv").is_file()):
        write_tables(study, whole=True)
    with console.status("Drawing ...") as status:
        page = write_report_of(study, replays=replays, tell=status.update)
    print_place(console, "Report", page)
