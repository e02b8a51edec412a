"""The commands ``giveway fmu ...`` and ``giveway export ...``, and their help."""

from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import typer

from giveway.cli.help import Commands, JsonFlag
from giveway.cli.option_groups import DryRun, ReplaceFile, StepTests, Unsealed
from giveway.cli.ungrouping import ungrouped
from giveway.errors import ConfigError

_Fmu = Annotated[Path, typer.Argument(help="The FMU (.fmu).")]
_Profile = Annotated[
    Path | None,
    typer.Option(help="Vehicle profile (TOML); without it, drafted from names and units."),
]


def _formats(incomplete: str) -> list[str]:
    known = ("fcd", "pedpy", "jupedsim", "geojson", "trj", "mp4", "gif")
    return [name for name in known if name.startswith(incomplete)]


def build_fmu() -> typer.Typer:
    """Return the commands about vehicle FMUs."""
    app = Commands("Look at, try and fit a vehicle FMU.")
    app.add("inspect", _inspect)
    app.add("check", ungrouped(_check))
    app.add("identify", ungrouped(_identify))
    app.add("passport", _passport)
    app.add("compile", _compile)
    return app


def build_export(with_flags: Callable[[Callable[..., None]], Callable[..., None]]) -> typer.Typer:
    """Return the commands that make FMUs.

    Args:
        with_flags: Function that adds the flags of the configuration.
    """
    app = Commands("Write the controller as an FMU, or a run in other formats.")
    app.add("controller", with_flags(_controller))
    app.add("run", _run)
    return app


def _run(
    folder: Annotated[Path, typer.Argument(help="Results folder of a run.")],
    to: Annotated[
        str,
        typer.Option(
            "--format",
            "-f",
            help="fcd (SUMO replays it), pedpy, jupedsim, geojson, trj (SSAM), mp4 or gif.",
            autocompletion=_formats,
        ),
    ] = "",
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="File to write (default: beside the folder, named so)."),
    ] = None,
    step: Annotated[
        float | None,
        typer.Option(help="Between two instants in s (default: the run's; MP4 0.05, GIF 0.1)."),
    ] = None,
    force: ReplaceFile = False,
    unsealed: Unsealed = False,
) -> None:
    """Write a run for SUMO, PedPy, JuPedSim or a map, or as a film."""
    from giveway.cli.commands.export_run_command import export_run_command

    export_run_command(folder, to, out, step=step, force=force, unsealed=unsealed)


def _inspect(
    fmu: _Fmu,
    draft: Annotated[
        Path | None, typer.Option(help="File to write the drafted profile to.")
    ] = None,
    everything: Annotated[bool, typer.Option("--all", help="All variables.")] = False,
    controller: Annotated[
        bool, typer.Option("--controller", help="It is a controller, and no vehicle.")
    ] = False,
    as_json: JsonFlag = False,
) -> None:
    """Tell what an FMU is, without loading it, and draft its profile."""
    from giveway.cli.commands.fmu_tools.fmu_inspect import inspect_command

    raise typer.Exit(
        inspect_command(fmu, draft, everything=everything, controller=controller, as_json=as_json)
    )


def _check(
    *,
    fmu: _Fmu,
    profile: _Profile = None,
    trial: DryRun,
) -> None:
    """Drive an FMU for some seconds: pass, or what is wrong and the line that mends it."""
    from giveway.cli.commands.fmu_tools.fmu_check import check_command

    out = trial.out or Path("results") / f"{fmu.stem}_check"
    raise typer.Exit(check_command(fmu, profile, trial._replace(out=out)))


def _identify(
    *,
    fmu: _Fmu,
    profile: _Profile = None,
    tests: StepTests,
) -> None:
    """Estimate M, alpha and the actuator's lag by step tests, for the controller."""
    from giveway.cli.commands.fmu_tools.fmu_identify import identify_command

    try:
        starts = [float(part) for part in tests.speeds.split(",")]
    except ValueError:
        raise ConfigError(f"--speeds {tests.speeds}: expected numbers like 0,4,8 [m/s]") from None
    name = f"{fmu.stem}_identify"
    picture = tests.picture or Path("results") / name / f"{name}.png"
    identify_command(fmu, profile, tests._replace(picture=picture), starts)


def _passport(
    fmu: _Fmu,
    profile: _Profile = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Folder (default results/FMU_passport).")
    ] = None,
    mass: Annotated[
        float | None, typer.Option(help="What the vehicle weighs in kg.", min=1e-3)
    ] = None,
) -> None:
    """Write what is known of an FMU: check, model, limits and a comparison, as JSON and page."""
    from giveway.cli.commands.fmu_tools.fmu_passport import passport_command

    folder = out or Path("results") / f"{fmu.stem}_passport"
    raise typer.Exit(passport_command(fmu, profile, folder, mass))


def _compile(
    fmu: _Fmu,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="FMU to write (default FMU_PLATFORM.fmu, here)."),
    ] = None,
    force: ReplaceFile = False,
) -> None:
    """Compile an FMU's C sources for this platform, into a copy of it."""
    from giveway.cli.commands.fmu_tools.fmu_compile import compile_command

    compile_command(fmu, out, force=force)


def _controller(
    settings: dict[str, object],
    out: Annotated[Path, typer.Option("--out", "-o", help="The FMU to write (.fmu).")],
    scenario: Annotated[str | None, typer.Argument(help="As for run.")] = None,
    config: Annotated[Path | None, typer.Option(help="As for run.")] = None,
    fmi: Annotated[str, typer.Option(help="FMI version: 2.0 or 3.0.")] = "2.0",
    force: ReplaceFile = False,
) -> None:
    """Write the controller (MPC with PID, or PID) as an FMU, with a run's settings."""
    from giveway.cli.commands.export_command import export_command

    raise typer.Exit(export_command(scenario, config, settings, out, fmi=fmi, force=force))
