"""The command ``giveway run``: progress bar, run, files, and a summary of one screen."""

import json
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

from rich.console import Console

from giveway.cli.exit import fail
from giveway.cli.option_groups import RunOutputs
from giveway.cli.screen.printing import escape, print_json
from giveway.cli.screen.progress_bars import run_progress
from giveway.config import RunConfig
from giveway.config.files.layers import Layer, dump_toml, read_toml
from giveway.config.files.loading import load
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


def default_folder(config: RunConfig, scenario: str) -> Path:
    """Return ``results/<scenario>_<controller>_<persons>ped_seed<seed>``, with ids of egos.

    The number of persons is left out if giveway adds none: the scenario may bring its own.
    If anything else differs from the scenario's settings and the defaults, six digits of a hash
    over the whole configuration follow, so that different runs have different folders.
    """
    egos = config.each_ego()
    controllers = _safe("_".join(dict.fromkeys(ego.controller_name for ego in egos))) or "no_ego"
    taken = "".join(f"_{name}" for ego in egos for name in ego.ego.take_over)
    safe = _safe(taken)
    added = f"_{config.crowd.pedestrians}ped" if config.crowd.pedestrians else ""
    name = f"{scenario}_{controllers}{safe[:60]}{added}_seed{config.seed}"
    if not _is_told_by_name(config):
        name += f"_{sha256(dump_toml(config).encode()).hexdigest()[:6]}"
    return Path("results") / name


def _safe(name: str) -> str:
    """Return a part of a folder's name that is valid on every system."""
    return "".join(letter if letter.isalnum() or letter in "._-" else "-" for letter in name)


def _is_told_by_name(config: RunConfig) -> bool:
    """Return whether the folder's name says all that differs from the scenario's own settings."""
    ego = {key: value for key in ("take_over", "none") if (value := getattr(config.ego, key))}
    told = {
        "scenario": config.scenario,
        "controller": config.controller,
        "seed": config.seed,
        "crowd": {"pedestrians": config.crowd.pedestrians},
        "ego": ego,
    }
    try:
        plain, _ = load([Layer("", told)])
    except GivewayError:
        return False
    return dump_toml(plain) == dump_toml(config)


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
