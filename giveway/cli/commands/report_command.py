"""The command ``giveway report``: figures, replays and the HTML report of a study or risk."""

import sys
from collections.abc import Collection
from pathlib import Path

from rich.console import Console

from giveway.cli.screen.printing import print_notes, print_place
from giveway.risk.risk_folder import RiskFolder, is_risk
from giveway.studies.folder.study_folder import StudyFolder


def report_command(
    study: Path, *, replays: bool, quiet: bool, trusted: Collection[str] = ()
) -> None:
    """Write figures, replays and report again.

    Only the runs that are shown are made again.

    Args:
        study: Folder of the study or risk.
        replays: True to make the shown runs again.
        quiet: True to print nothing.
        trusted: Code, as module:Class, that the study may import.

    Raises:
        GivewayError: there is no study, or nothing to show, or the disk is full.
    """
    if is_risk(study):
        _write_risk(RiskFolder(study, trusted=trusted), Console(quiet=quiet), replays, trusted)
        return
    write_all(StudyFolder.open(study), Console(quiet=quiet), replays=replays, trusted=trusted)


def _write_risk(
    risk: RiskFolder, console: Console, replays: bool, trusted: Collection[str]
) -> None:
    """Write tables, replays and report of a risk."""
    from giveway.reports.with_replays import write_report_of_risk

    with console.status("Drawing ...") as status:
        page = write_report_of_risk(
            risk, replays=replays, tell=status.update, trusted=trusted, warn=print_notes
        )
    print_place(console, "Report", page)


def write_all(
    study: StudyFolder, console: Console, *, replays: bool = True, trusted: Collection[str] = ()
) -> None:
    """Write figures, replays and report, and the tables unless those of all runs exist."""
    from giveway.precompile import compile_kernels_once
    from giveway.reports.with_replays import write_report_of
    from giveway.studies.folder.folder_contents import broken_tables, intact_tables
    from giveway.studies.folder.sealing import put_aside
    from giveway.studies.folder.table_files import TABLES, write_tables

    compile_kernels_once(console)
    for file in broken_tables(study.path):
        there = put_aside(file, study.path)
        sys.stderr.write(
            f"note: {file}: is not what giveway wrote; put aside in {there}, it is made again\n"
        )
    if not study.complete or {f"{name}.csv" for name in TABLES} - intact_tables(study.path):
        write_tables(study, whole=True)
    with console.status("Drawing ...") as status:
        page = write_report_of(
            study, replays=replays, tell=status.update, trusted=trusted, warn=print_notes
        )
    print_place(console, "Report", page)
