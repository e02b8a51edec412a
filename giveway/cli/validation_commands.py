"""The commands ``giveway validate`` and ``calibrate``, and their help."""

from pathlib import Path
from typing import Annotated

import typer

from giveway.cli.help import Commands
from giveway.cli.option_groups import FitSettings
from giveway.cli.ungrouping import ungrouped

_Clips = Annotated[Path, typer.Argument(help="A data set's folder, or any part of it with clips.")]
_Dataset = Annotated[
    str | None,
    typer.Option(
        help="Which one it is: citr, dut, another known one, or its description (TOML); "
        "docs/recordings.md."
    ),
]


def add_validation(app: Commands) -> None:
    """Add the commands about recorded trajectories to ``app``."""
    app.add("validate", _validate)
    app.add("calibrate", ungrouped(_calibrate))


def _validate(
    clips: _Clips,
    dataset: _Dataset = None,
    preset: Annotated[
        str, typer.Option(help="MIXED, CITR, DUT, SIM, TABLE2 or a preset file (TOML).")
    ] = "MIXED",
    out: Annotated[
        Path | None, typer.Option(help="Folder (default results/validation_PRESET).")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace the results there.")] = False,
    quiet: Annotated[
        bool, typer.Option("--quiet", "-q", help="Neither progress bar nor tables.")
    ] = False,
) -> None:
    """Hold the pedestrian model against recorded trajectories: ADE, FDE, contacts."""
    from giveway.cli.commands.validate_command import validate_command

    validate_command(clips, dataset=dataset, preset=preset, out=out, force=force, quiet=quiet)


def _calibrate(
    *,
    clips: Annotated[
        list[Path], typer.Argument(help="Data sets' folders, or any parts of them with clips.")
    ],
    out: Annotated[Path, typer.Option(help="Preset file (TOML) to write.")],
    dataset: Annotated[
        list[str] | None,
        typer.Option(
            help="Which ones they are, in the order of the folders: citr, dut, another known one, "
            "or a description (TOML); docs/recordings.md."
        ),
    ] = None,
    fit: FitSettings,
    force: Annotated[
        bool,
        typer.Option("--force", help="Replace the file, and write a fit that is worse."),
    ] = False,
    quiet: Annotated[
        bool, typer.Option("--quiet", "-q", help="Neither progress bar nor tables.")
    ] = False,
) -> None:
    """Fit parameters of the pedestrian model to recorded trajectories: a preset file."""
    from giveway.cli.commands.calibrate_command import calibrate_command

    calibrate_command(clips, out, dataset or [], fit, force=force, quiet=quiet)
