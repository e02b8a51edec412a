"""The commands about studies and risks, and their help."""

from pathlib import Path
from typing import Annotated

import typer

from giveway.cli.help import Commands, JsonFlag
from giveway.cli.option_groups import (
    BenchmarkChoice,
    NcapChoice,
    NoTables,
    Pictures,
    RerunOutputs,
    RiskChoice,
    RiskEstimate,
    StudyChoice,
    StudyComputation,
    StudyOutputs,
    StudySeeds,
    Trust,
    Unsealed,
)
from giveway.cli.ungrouping import ungrouped

_Folder = Annotated[Path, typer.Argument(help="The folder of a study or risk.")]


def add_studies(app: Commands) -> None:
    """Add the commands about studies to ``app``."""
    app.add("study", ungrouped(_study))
    app.add("studies", _studies)
    app.add("benchmark", ungrouped(_benchmark))
    app.add("risk", ungrouped(_risk))
    app.add("ncap", ungrouped(_ncap))
    app.add("rerun", ungrouped(_rerun))
    app.add("report", _report)
    app.add("replay", _replay)


def _study(
    *,
    choice: StudyChoice,
    out: Annotated[Path | None, typer.Option(help="Folder (default results/study_NAME).")] = None,
    seeds: StudySeeds,
    computation: StudyComputation,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Show the plan and the time it will take.")
    ] = False,
    twin: Annotated[
        bool | None,
        typer.Option(help="Make each run twice to know what the egos cost the people."),
    ] = None,
    outputs: StudyOutputs,
) -> None:
    """Run a study: many paired runs, compared. It can be ended at any moment and resumed."""
    from giveway.errors import ConfigError
    from giveway.studies.study_files import find_study

    study, vary, only, config = choice
    if (study is None) == (not vary) or (config is not None and not vary):
        raise ConfigError(
            "expected a study, or --vary (with --config, if you like); 'giveway studies' lists the "
            "bundled ones"
        )
    if study is not None:
        find_study(study)  # before anything slower is loaded
    from giveway.cli.commands.study_command import StudyRequest, study_command
    from giveway.studies.study import StudyOptions

    options = StudyOptions(**computation._asdict())
    request = StudyRequest(
        study,
        tuple(vary or ()),
        tuple(only or ()),
        config,
        out,
        *seeds,
        twin,
        dry_run=dry_run,
        **outputs._asdict(),
    )
    raise typer.Exit(study_command(request, options))


def _benchmark(
    *,
    choice: BenchmarkChoice,
    out: Annotated[
        Path | None, typer.Option(help="Folder (default results/benchmark_CONTROLLER).")
    ] = None,
    computation: StudyComputation,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Show the plan and the time it will take.")
    ] = False,
    quiet: NoTables = False,
    as_json: JsonFlag = False,
) -> None:
    """Drive a controller through frozen scenes, and compare it with kept rivals; resumable."""
    from giveway.cli.commands.benchmark_command import BenchmarkRequest, benchmark_command
    from giveway.studies.study_options import StudyOptions

    shown = {"dry_run": dry_run, "quiet": quiet, "as_json": as_json}
    request = BenchmarkRequest(
        tuple(choice.controllers),
        choice.config,
        tuple(choice.only or ()),
        choice.runs,
        out,
        **shown,
    )
    options = StudyOptions(**computation._asdict())
    raise typer.Exit(benchmark_command(request, options))


def _risk(
    *,
    choice: RiskChoice,
    estimate: RiskEstimate,
    out: Annotated[Path | None, typer.Option(help="Folder (default results/risk_NAME).")] = None,
    computation: StudyComputation,
    pictures: Pictures = True,
    quiet: NoTables = False,
    as_json: JsonFlag = False,
) -> None:
    """Estimate how likely an event is in a run, and between which bounds; resumable."""
    from giveway.cli.commands.risk_command import RiskRequest, risk_command
    from giveway.studies.study_options import StudyOptions

    request = RiskRequest(
        choice.subject,
        estimate._asdict(),
        tuple(choice.fixed or ()),
        tuple(choice.random or ()),
        choice.config,
        out,
        pictures,
        quiet,
        as_json,
    )
    raise typer.Exit(risk_command(request, StudyOptions(**computation._asdict())))


def _ncap(
    *,
    choice: NcapChoice,
    out: Annotated[
        Path | None, typer.Option(help="Folder (default results/ncap_CAR_PROTOCOL).")
    ] = None,
    computation: StudyComputation,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Show the plan and the time it will take.")
    ] = False,
    quiet: NoTables = False,
    as_json: JsonFlag = False,
) -> None:
    """Test a car's FMU as Euro NCAP or UN R152 do with pedestrians; resumable."""
    from giveway.cli.commands.ncap_command import ncap_command
    from giveway.ncap.request import NcapRequest
    from giveway.studies.study_options import StudyOptions

    values = choice._asdict() | {"tests": choice.tests or (), "speeds": choice.speeds or ()}
    request = NcapRequest(**values, out=out)
    shown = {"dry_run": dry_run, "quiet": quiet, "as_json": as_json}
    raise typer.Exit(ncap_command(request, StudyOptions(**computation._asdict()), **shown))


def _studies(as_json: JsonFlag = False) -> None:
    """List the bundled studies."""
    from giveway.cli.screen.printing import print_list
    from giveway.studies.definition import read_definition
    from giveway.studies.study_files import bundled_studies, find_study

    found = {name: read_definition(find_study(name)).description for name in bundled_studies()}
    print_list(found, as_json=as_json)


def _rerun(
    study: _Folder,
    run: Annotated[str, typer.Argument(help="The run's id, like c2-s17; see runs.csv.")],
    outputs: RerunOutputs,
    trust: Trust = None,
) -> None:
    """Make one run of a study again, with all trajectories, and compare its numbers."""
    from giveway.cli.guards.isolated import run_isolated, supervised
    from giveway.processes.child import take_journal_folder

    journal = take_journal_folder()
    if journal is None:
        raise typer.Exit(run_isolated())
    from giveway.cli.commands.rerun_command import rerun_command

    supervised(
        journal, lambda: rerun_command(study, run, outputs, journal=journal, trusted=trust or ())
    )


def _report(
    study: _Folder,
    replays: Annotated[
        bool, typer.Option(help="Make the runs that it points at again, to play and show them.")
    ] = True,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress.")] = False,
    trust: Trust = None,
) -> None:
    """Write figures, replays of the most telling runs, and report.html into the folder."""
    from giveway.cli.commands.report_command import report_command

    report_command(study, replays=replays, quiet=quiet, trusted=trust or ())


def _replay(
    run: Annotated[Path, typer.Argument(help="Results folder of a run.")],
    out: Annotated[
        Path | None, typer.Option(help="Page to write (default RUN/replay.html).")
    ] = None,
    beside: Annotated[
        Path | None,
        typer.Option(help="Results folder of another run, to be played beside it in step."),
    ] = None,
    rerun: Annotated[
        bool, typer.Option(help="Make the run again for its predicted positions.")
    ] = True,
    unsealed: Unsealed = False,
    trust: Trust = None,
    show: Annotated[bool, typer.Option("--open", help="Open it in the browser.")] = False,
) -> None:
    """Write one HTML page that plays a run, in any browser, without a network."""
    from giveway.cli.commands.replay_command import PlayChoice, replay_command

    choice = PlayChoice(rerun, unsealed, tuple(trust or ()))
    raise typer.Exit(replay_command(run, choice, out=out, beside=beside, show=show))
