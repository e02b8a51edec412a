"""The commands and their help; the work of each command is in a module of its own."""

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated

import typer

from giveway import errors
from giveway.cli.check_commands import build_check
from giveway.cli.completion import complete_scenario
from giveway.cli.data_commands import build_data
from giveway.cli.fmu_commands import build_export, build_fmu
from giveway.cli.help import Commands, JsonFlag
from giveway.cli.option_groups import RunOutputs
from giveway.cli.study_commands import add_studies
from giveway.cli.ungrouping import ungrouped
from giveway.cli.validation_commands import add_validation

HELP = """How should a vehicle drive through a crowd, and what happens to both?

A vehicle FMU, driven by MPC or PID, and a crowd of VCI pedestrians meet in a SUMO scenario.
"""

_COMPLETING = "_GIVEWAY_COMPLETE"  # Environment variable with which a shell asks for completions
# Variables with the line typed so far: for bash, for other shells
_TYPED = ("COMP_WORDS", "_TYPER_COMPLETE_ARGS")


def build_app(arguments: Sequence[str]) -> Commands:
    """Return the typer application that ``arguments`` need.

    The flags of the configuration take a tenth of a second to load. They are loaded only if a
    command that has them is named. A command that is named is the only one.
    """
    command = next((word for word in arguments if not word.startswith("-")), None)
    app = Commands(HELP, completion=True)
    app.callback()(_main)
    app.add("run", _with_flags(ungrouped(_run), command))
    add_studies(app)
    add_validation(app)
    app.add("scenarios", _scenarios)
    app.add("new", _new)
    app.add("doctor", _doctor)
    app.add("precompile", _precompile)
    app.add("recover", _recover)
    app.add("config", _with_flags(_config, command))
    app.add("schema", _schema)
    app.add_typer(build_data(), name="data")
    app.add_typer(build_fmu(), name="fmu")
    app.add_typer(build_export(lambda f: _with_flags(f, command, "export")), name="export")
    app.add_typer(build_check(), name="check")
    app.add_typer(_build_plot(), name="plot")
    app.keep(command)
    return app


def invoke(words: list[str]) -> int:
    """Run the command that ``words`` name, and return its exit code.

    The application itself is not called, because it would turn Ctrl-C into an exit code without a
    message.
    """
    if _COMPLETING in os.environ:
        typed = next((os.environ[name] for name in _TYPED if name in os.environ), "")
        typer.main.get_command(build_app(typed.split()[1:])).main(prog_name="giveway")
    command = typer.main.get_command(build_app(words))
    try:
        with command.make_context("giveway", words) as context:
            command.invoke(context)
    except typer.Exit as end:
        return end.exit_code
    return 0


def _with_flags(
    function: Callable[..., None], command: str | None, name: str | None = None
) -> Callable[..., None]:
    if command != (name or function.__name__.removeprefix("_")):

        def not_called() -> None: ...

        not_called.__doc__ = function.__doc__
        return not_called
    from giveway.cli.flags import accept_config_flags

    return accept_config_flags(function)


def _print_version(wanted: bool) -> None:
    if wanted:
        from giveway._version import __version__

        typer.echo(f"giveway {__version__}")
        raise typer.Exit


def _main(
    version: Annotated[
        bool,
        typer.Option(
            "--version", help="Print the version and exit.", is_eager=True, callback=_print_version
        ),
    ] = False,
) -> None: ...


def _run(
    settings: dict[str, object],
    *,
    scenario: Annotated[
        str | None,
        typer.Argument(
            help="Bundled scenario, folder or .sumocfg (default shared_space).",
            autocompletion=complete_scenario,
        ),
    ] = None,
    config: Annotated[
        Path | None, typer.Option(help="TOML file with options; flags override it.")
    ] = None,
    outputs: RunOutputs,
    isolate: Annotated[
        bool,
        typer.Option(
            help="Run in a process of its own, whose crash loses no row.", rich_help_panel="Run"
        ),
    ] = True,
) -> None:
    """Drive the ego through a crowd once: summary, CSVs, pictures."""
    from giveway.cli.guards.isolated import run_isolated, supervised
    from giveway.processes.child import take_journal_folder

    journal = take_journal_folder()
    if journal is None:
        from giveway.cli.guards.archive_check import require_archives

        require_archives(config, settings)
        if scenario is not None:
            _require_scenario(scenario)
        if isolate:
            raise typer.Exit(run_isolated())
    from giveway.cli.commands.run_command import run_command

    supervised(journal, lambda: run_command(scenario, config, settings, outputs, journal))


def _require_scenario(name: str) -> None:
    """Refuse a scenario that does not exist before anything slower is loaded."""
    from sumo_scenarios import ScenarioError, find

    try:
        find(name)
    except ScenarioError as error:
        raise errors.ScenarioError(str(error)) from None


def _config(
    settings: dict[str, object],
    scenario: Annotated[
        str | None, typer.Argument(help="As for run.", autocompletion=complete_scenario)
    ] = None,
    config: Annotated[Path | None, typer.Option(help="As for run.")] = None,
) -> None:
    """Print the effective configuration as TOML, with units."""
    from giveway.cli.commands.run_command import layers_of
    from giveway.config.files.layers import dump_toml
    from giveway.config.files.loading import load

    typer.echo(dump_toml(load(layers_of(scenario, config, settings))[0]), nl=False)


def _schema(
    out: Annotated[Path, typer.Option(help="Folder for them.")] = Path(),
) -> None:
    """Write JSON schemas, with which editors complete and check run, study and other TOML files."""
    from giveway.cli.commands.schema_command import schema_command

    schema_command(out)


def _doctor(
    scenario: Annotated[
        str | None,
        typer.Argument(
            help="Bundled scenario, folder or .sumocfg; or the results of a run or study.",
            autocompletion=complete_scenario,
        ),
    ] = None,
    as_json: JsonFlag = False,
) -> None:
    """Examine the installation, and a scenario or results: findings and their remedies."""
    from giveway.cli.commands.doctor_command import doctor_command

    raise typer.Exit(doctor_command(scenario, as_json=as_json))


def _precompile(
    into: Annotated[
        Path | None,
        typer.Option(help="Folder for them, which NUMBA_CACHE_DIR names later [user's cache]."),
    ] = None,
) -> None:
    """Compile the numerical kernels before the first run, as in an image or for a cluster."""
    from giveway.cli.commands.precompile_command import precompile_command

    precompile_command(into)


def _recover(
    journal: Annotated[
        Path | None, typer.Argument(help="Folder of the journal (default: list them).")
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Results folder (default: the run's own).")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace the results there.")] = False,
) -> None:
    """Write the rows of a run that was killed (SIGKILL, a crash of the machine) as its results."""
    from giveway.cli.commands.recover_command import recover_command

    recover_command(journal, out, force=force)


def _scenarios(as_json: JsonFlag = False) -> None:
    """List the bundled scenarios."""
    from giveway.cli.screen.printing import print_list
    from sumo_scenarios import available, find

    print_list({name: find(name).description for name in available()}, as_json=as_json)


def _new(
    source: Annotated[
        Path | None,
        typer.Argument(
            help="Description of a street (.toml), or map of OpenStreetMap (.osm, .osm.gz); "
            "without it an example of a description is written, street.toml."
        ),
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Folder for the scenario [name of the source].")
    ] = None,
    vehicles: Annotated[
        float, typer.Option(help="Vehicles in an hour, on a whole map.", min=0.0, max=1e5)
    ] = 360.0,
    people: Annotated[
        float, typer.Option(help="People in an hour, on a whole map.", min=0.0, max=1e5)
    ] = 2400.0,
    duration: Annotated[
        float, typer.Option(help="Time in s in which they depart on a map.", min=60.0, max=86400.0)
    ] = 600.0,
    seed: Annotated[
        int, typer.Option(help="Seed of their trips on a map.", min=0, max=2**31 - 1)
    ] = 1,
    force: Annotated[bool, typer.Option("--force", help="Replace the scenario there.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Say nothing.")] = False,
) -> None:
    """Make a scenario of a drawn street or a map: network, traffic, people, settings."""
    from giveway.cli.commands.new_command import new_command
    from giveway.scenario_builder import Demand

    demand = Demand(vehicles, people, duration, seed)
    new_command(source, out, demand, force=force, quiet=quiet)


def _build_plot() -> Commands:
    plot = Commands("Draw figures.")
    plot.add("influence", _influence)
    plot.add("reference", _reference)
    return plot


def _influence(
    out: Annotated[Path, typer.Option(help="Picture to write: .png, .svg or .pdf.")] = Path(
        "influence.png"
    ),
    speeds: Annotated[
        str, typer.Option(help="Vehicle speeds in m/s, comma-separated, one panel each.")
    ] = "0,1,2,4",
    preset: Annotated[
        str, typer.Option(help="VCI parameter set: SIM, TABLE2, MIXED, CITR or DUT.")
    ] = "SIM",
    length: Annotated[float, typer.Option(help="Vehicle length in m.")] = 5.0,
    width: Annotated[float, typer.Option(help="Vehicle width in m.")] = 2.0,
) -> None:
    """Draw the vehicle's influence on a pedestrian (figure 2 of Yang & Özgüner 2019)."""
    from giveway.cli.commands.plot_command import influence_command

    influence_command(out, speeds, preset=preset, length=length, width=width)


def _reference(
    out: Annotated[Path, typer.Option(help="Picture to write: .png, .svg or .pdf.")] = Path(
        "reference.png"
    ),
) -> None:
    """Draw both PIDs' reference speed over the gap (figure 3 of Yang & Özgüner 2019)."""
    from giveway.cli.commands.plot_command import reference_command

    reference_command(out)
