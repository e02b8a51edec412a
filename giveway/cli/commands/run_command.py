"""The command ``giveway run``: progress bar, run, files, and a summary of one screen."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rich.console import Console

from fmus import processes_reused
from giveway.cli.exit import fail
from giveway.cli.option_groups import RunOutputs
from giveway.cli.screen.printing import escape, print_json
from giveway.cli.screen.progress_bars import run_progress
from giveway.config.files.layers import Layer, read_toml
from giveway.config.files.loading import load
from giveway.config.files.naming import default_folder
from giveway.errors import GivewayError
from giveway.processes.interrupts import DeferredInterrupt, ended_by, exit_code_of, who_ended
from giveway.results.folder import Destination, check_folder
from giveway.results.run_result import RunResult
from giveway.results.table_files import require_parquet
from giveway.run_data.progress import Ending


def layers_of(
    scenario: str | None, config: Path | None, settings: Mapping[str, Any]
) -> list[Layer]:
    """Return the user's settings: the file, then the flags."""
    layers = [] if config is None else [read_toml(config)]
    named = {} if scenario is None else {"scenario": scenario}
    return [*layers, Layer("command line", {**named, **settings}, from_flags=True)]


@processes_reused()
def run_command(
    scenario: str | None,
    config: Path | None,
    settings: Mapping[str, Any],
    outputs: RunOutputs,
    journal: Path | None = None,
) -> int:
    """Run once and return the exit code: 0, or 128 + the signal by which the user ended it.

    Args:
        scenario: Name or path, or None for the file's or the default.
        config: TOML file, or None.
        settings: Settings given by flags.
        outputs: Outputs to keep and to print.
        journal: Folder for the rows in case this process dies.

    Raises:
        GivewayError: one line that says what to do.
    """
    console = Console(quiet=outputs.quiet or outputs.as_json)
    layers = layers_of(scenario, config, settings)
    effective, found = load(layers, outputs.trust or ())
    if outputs.parquet or outputs.trajectories == "parquet":
        require_parquet()
    from giveway.cosimulation.preflight import preflight
    from giveway.precompile import compile_kernels_once
    from giveway.results.inputs import require_recorded

    if scenario is None:  # one that the user names is the user's
        for folder in filter(None, (layer.results for layer in layers)):
            require_recorded(folder, effective, found)
    checked = preflight(effective, found)
    folder = outputs.out or default_folder(effective, found.name)
    check_folder(folder, force=outputs.force)
    compile_kernels_once(console, threads=effective.crowd.threads)
    from giveway.api import run_checked
    from giveway.api.expected_size import size_note

    if note := size_note(checked, outputs.trajectories, journal):
        console.print(f"[yellow]note[/yellow] {escape(note)}", highlight=False)
    with run_progress(console, effective) as watcher:
        try:
            result = run_checked(
                checked,
                Destination(
                    folder, outputs.force, outputs.parquet, outputs.trajectories, outputs.pictures
                ),
                watcher=watcher,
                journal=journal,
                baseline=True,
            )
        except GivewayError as error:
            if error.result is not None and len(error.result.time):
                error.args = (f"{error}; rows up to then are in {folder}",)
            raise
    if result.ending is Ending.INTERRUPTED:
        return interrupted(result, folder)
    show(console, result, folder, explain=outputs.explain)
    if outputs.as_json:
        print_json(
            {
                "results": str(folder),
                "ending": result.ending.value,
                "remarks": list(result.remarks),
                "summary": json.loads((folder / "summary.json").read_text(encoding="utf-8")),
            }
        )
    return 0


def interrupted(result: RunResult, folder: Path) -> int:
    """Print what has been kept of a run that the user has ended, and return the exit code."""
    kept = f"rows up to then are in {folder}" if len(result.time) else "there are no rows yet"
    error = ended_by(DeferredInterrupt.latest)
    return fail(f"{who_ended(error)}; {kept}", exit_code_of(error))


def show(console: Console, result: RunResult, folder: Path, *, explain: bool = False) -> None:
    """Print the run's summary, the places of the files, and what to look at first."""
    from giveway.cli.screen.run_summary import explanation, summary_table
    from giveway.results.digest import worth_watching

    console.print(summary_table(result))
    if explain:
        console.print(explanation(result))
    for remark in result.remarks:
        console.print(f"[yellow]note[/yellow] {escape(remark)}", highlight=False)
    name = escape(str(folder))
    files = ", ".join(sorted(path.name for path in folder.iterdir()))
    console.print(f"Results in [bold]{name}[/bold]: {escape(files)}", highlight=False)
    moment = worth_watching(result)
    watch = f"{escape(moment)}; " if moment else ""
    console.print(f"Look: {watch}[bold]giveway replay {name}[/bold] plays it", highlight=False)
