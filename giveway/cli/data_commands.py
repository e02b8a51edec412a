"""The commands ``giveway data ...`` about recorded people and vehicles, and their help."""

from pathlib import Path
from typing import Annotated

import typer

from giveway.cli.help import Commands
from giveway.cli.option_groups import Unsealed

_Folder = Annotated[Path, typer.Argument(help="Folder with recordings, in it or below it.")]
_Dataset = Annotated[
    str | None,
    typer.Option(
        help="Data set: citr, deepscenario, dut, eth_ucy, hermes, imptc, ind, sind, sumo_fcd, or "
        "its description (TOML); docs/recordings.md."
    ),
]
_Model = Annotated[str, typer.Option(help="Pedestrian model: a bundled one, as in [crowd] model.")]
_Preset = Annotated[
    str, typer.Option(help="MIXED, CITR, DUT, SIM, TABLE2 or a preset file (TOML).")
]
_Drawn = Annotated[
    Path | None, typer.Option(help="Folder for tables and picture; without it, none.")
]
_Out = Annotated[Path | None, typer.Option(help="Folder for the tables (CSV); without it, none.")]
_Force = Annotated[bool, typer.Option("--force", help="Replace the tables there.")]
_Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Neither progress bar nor tables.")]


def build_data() -> typer.Typer:
    """Return the commands about recorded people and vehicles."""
    app = Commands("Look at recorded people and vehicles, and measure recorded drives.")
    app.add("describe", _describe)
    app.add("measure", _measure)
    app.add("behave", _behave)
    app.add("scenario", _scenario)
    app.add("compare", _compare)
    return app


def _describe(
    folder: _Folder,
    dataset: _Dataset = None,
    out: _Out = None,
    force: _Force = False,
    quiet: _Quiet = False,
) -> None:
    """Say who is in recordings, how near people and vehicles come, and what is wrong with them."""
    from giveway.cli.commands.data_command import describe_command

    describe_command(folder, dataset, out, force=force, quiet=quiet)


def _measure(
    folder: _Folder,
    dataset: _Dataset = None,
    vehicle: Annotated[
        str | None, typer.Option(help="Id of the only vehicle to measure; its people are listed.")
    ] = None,
    out: _Out = None,
    force: _Force = False,
    quiet: _Quiet = False,
) -> None:
    """Measure recorded drives as giveway measures its own: speeds, close passes, TTC, PET."""
    from giveway.cli.commands.data_command import measure_command

    measure_command(folder, dataset, vehicle, out, force=force, quiet=quiet)


def _behave(
    folder: _Folder,
    dataset: _Dataset = None,
    model: _Model = "vci",
    preset: _Preset = "MIXED",
    out: _Drawn = None,
    force: _Force = False,
    quiet: _Quiet = False,
) -> None:
    """Compare simulated with recorded people: near recorded vehicles, or in corridors."""
    from giveway.cli.commands.behave_command import behave_command

    behave_command(folder, dataset, model, preset, out, force=force, quiet=quiet)


def _scenario(
    folder: Annotated[Path, typer.Argument(help="Folder with recordings, or a file of one.")],
    out: Annotated[Path, typer.Option(help="Folder for the scenario.")],
    dataset: _Dataset = None,
    clip: Annotated[str, typer.Option(help="Name of the recording; the only one needs none.")] = "",
    vehicle: Annotated[
        str | None, typer.Option(help="Id of the vehicle in whose place the ego drives.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace the scenario there.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Say nothing.")] = False,
) -> None:
    """Write a scenario in which the ego drives in place of a recorded vehicle, among its people."""
    from giveway.cli.commands.recorded_drive_command import scenario_command

    scenario_command(folder, dataset, clip, vehicle, out, force=force, quiet=quiet)


def _compare(
    runs: Annotated[list[Path], typer.Argument(help="Results of runs among recorded people.")],
    out: _Out = None,
    force: _Force = False,
    quiet: _Quiet = False,
    unsealed: Unsealed = False,
) -> None:
    """Compare drives of egos with those of the recorded vehicles in whose place they drove."""
    from giveway.cli.commands.recorded_drive_command import compare_command

    compare_command(runs, out, force=force, quiet=quiet, unsealed=unsealed)
