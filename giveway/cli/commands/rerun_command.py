"""The command ``giveway rerun``: the repetition of one run of a study, as by ``giveway run``."""

from collections.abc import Collection
from pathlib import Path

from rich.console import Console

from giveway.cli.commands.run_command import interrupted, show
from giveway.cli.option_groups import RerunOutputs
from giveway.cli.screen.printing import escape
from giveway.cli.screen.progress_bars import run_progress
from giveway.gate import require_no_link
from giveway.precompile import compile_kernels_once
from giveway.results.folder import Destination, check_folder
from giveway.risk.risk_folder import RiskFolder, is_risk
from giveway.run_data.progress import Ending
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.repeated_run import checked_run, rerun


def rerun_command(
    study: Path,
    run: str,
    outputs: RerunOutputs,
    *,
    journal: Path | None,
    trusted: Collection[str] = (),
) -> int:
    """Make the run again, and print whether its numbers are the study's.

    Args:
        study: Folder of the study.
        run: Id of the run.
        outputs: Outputs to keep and to print.
        trusted: Code, as module:Class, that the study may import.
        journal: Folder for the rows in case this process dies.

    Raises:
        GivewayError: one line that says what to do.
    """
    console = Console(quiet=outputs.quiet)
    folder = RiskFolder(study, trusted=trusted) if is_risk(study) else StudyFolder.open(study)
    checked = checked_run(folder, run, predictions=outputs.predictions, trusted=trusted)
    out = outputs.out or study / "reruns" / run
    require_no_link(out / "manifest.json", study)
    check_folder(out, force=outputs.force)
    compile_kernels_once(console)
    with run_progress(console, checked.config) as watcher:
        kept = Destination(out, force=outputs.force, pictures=outputs.pictures)
        result = rerun(folder, run, kept, checked=checked, watcher=watcher, journal=journal)
    if result.ending is Ending.INTERRUPTED:
        return interrupted(result, out)
    show(console, result, out)
    record = folder.record(run)
    if record is not None and record.failed:
        console.print(f"In the study it {record.ending}: {escape(record.failure)}", highlight=False)
    elif record is not None:
        console.print("Its numbers are those of the study's row.")
    return 0
