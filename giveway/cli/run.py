"""``giveway run``: progress bar, run, files, one screen of summary."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.console import Console

from giveway.cli import INTERRUPTED, fail
from giveway.cli.progress import run_progress
from giveway.configfile import Layer, read_toml
from giveway.errors import GivewayError
from giveway.loading import load
from giveway.results import check_folder, require_parquet
from giveway.simulation import Ending

if TYPE_CHECKING:
    from collections.abc import Mapping

    from giveway.api import RunResult
    from giveway.config import RunConfig


@dataclass(frozen=True)
class Outputs:
    """What the user wants to keep, and to see."""

    folder: Path | None
    force: bool
    parquet: bool
    pictures: bool
    quiet: bool


def layers_of(
    scenario: str | None, config: Path | None, settings: Mapping[str, Any]
) -> list[Layer]:
    """The user's settings: the file, then the flags."""
    layers = [] if config is None else [read_toml(config)]
    named = {} if scenario is None else {"scenario": scenario}
    return [*layers, Layer("command line", {**named, **settings}, from_flags=True)]


def run_command(
    scenario: str | None, config: Path | None, settings: Mapping[str, Any], outputs: Outputs
) -> int:
    """Run once; the exit code is 0, or 130 when the user interrupted.

    Raises:
        GivewayError: one line that says what to do.
    """
    console = Console(quiet=outputs.quiet)
    layers = layers_of(scenario, config, settings)
    effective, found = load(layers)
    folder = outputs.folder or default_folder(effective, found.name)
    check_folder(folder, force=outputs.force)
    if outputs.parquet:
        require_parquet()
    from giveway.kernels import compile_kernels_once

    compile_kernels_once(console)
    from giveway.api import run_layers

    with run_progress(console, effective) as watcher:
        try:
            result = run_layers(
                layers,
                results=folder,
                force=outputs.force,
                parquet=outputs.parquet,
                pictures=outputs.pictures,
                watcher=watcher,
            )
        except GivewayError as error:
            if error.result is not None and len(error.result.ego_track.time):
                error.args = (f"{error}; rows up to then are in {folder}",)
            raise
    if result.ending is Ending.INTERRUPTED:
        return fail(f"interrupted; rows up to then are in {folder}", INTERRUPTED)
    _show(console, result, folder)
    return 0


def default_folder(config: RunConfig, scenario: str) -> Path:
    """``results/<scenario>_<controller>_<persons>ped_seed<seed>``."""
    crowd = f"{config.crowd.pedestrians}ped"
    return Path("results") / f"{scenario}_{config.controller}_{crowd}_seed{config.seed}"


def _show(console: Console, result: RunResult, folder: Path) -> None:
    from giveway.cli.summary import summary_table

    console.print(summary_table(result))
    files = ", ".join(sorted(path.name for path in folder.iterdir()))
    console.print(f"Results in [bold]{folder}[/bold]: {files}", highlight=False)
