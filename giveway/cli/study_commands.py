"""The commands ``giveway study``, ``rerun``, ``report`` and ``replay``, and their help."""

from pathlib import Path
from typing import Annotated

import typer

from giveway.cli.completion import complete_study
from giveway.cli.help import Commands, JsonFlag

_Trust = Annotated[
    list[str] | None,
    typer.Option(metavar="MODULE:CLASS", help="Code that the study names and that you know."),
]
_Folder = Annotated[Path, typer.Argument(help="The study's folder.")]


def add_studies(app: Commands) -> None:
    """Add the commands about studies to ``app``."""
    app.add("study", _study)
    app.add("studies", _studies)
    app.add("rerun", _rerun)
    app.add("report", _report)
    app.add("replay", _replay)


def _study(
    study: Annotated[
        str | None,
        typer.Argument(
            help="Bundled study (see giveway studies) or .toml. Without one see --vary.",
            autocompletion=complete_study,
        ),
    ] = None,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KEY=A,B,...",
            help="Without a study: an option and its values, like crowd.pedestrians=10,20.",
        ),
    ] = None,
    only: Annotated[
        list[str] | None,
        typer.Option(
            metavar="FACTOR=LEVEL",
            help="Of the study this level of a factor alone, like controller=mpc; repeatable.",
        ),
    ] = None,
    config: Annotated[
        Path | None, typer.Option(help="With --vary: a run's TOML file with the other settings.")
    ] = None,
    out: Annotated[Path | None, typer.Option(help="Folder (default results/study_NAME).")] = None,
    runs: Annotated[
        int | None,
        typer.Option("--runs", "--seeds", help="Seeds per cell, instead of the study's.", min=1),
    ] = None,
    first_seed: Annotated[
        int | None, typer.Option(help="First seed, instead of the study's.", min=0)
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with what is in the folder.")
    ] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace the study there.")] = False,
    retry_failed: Annotated[
        bool, typer.Option("--retry-failed", help="With --resume: make failed runs again.")
    ] = False,
    jobs: Annotated[
        int | None, typer.Option(help="Worker processes (default: one per processor).", min=1)
    ] = None,
    cluster: Annotated[
        str | None,
        typer.Option(help="Dask scheduler to compute on, tcp://HOST:PORT, or local:N."),
    ] = None,
    hang_limit: Annotated[
        float, typer.Option(help="Seconds without progress after which a run is ended.", min=1.0)
    ] = 120.0,
    run_limit: Annotated[
        float | None, typer.Option(help="Seconds that one run may take (default: any).", min=0.1)
    ] = None,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Show the plan and the time it will take.")
    ] = False,
    twin: Annotated[
        bool | None,
        typer.Option(help="Make each run twice to know what the egos cost the people."),
    ] = None,
    report: Annotated[bool, typer.Option(help="Write figures and report.html.")] = True,
    quiet: Annotated[
        bool, typer.Option("--quiet", "-q", help="Neither progress bar nor tables.")
    ] = False,
    as_json: JsonFlag = False,
) -> None:
    """Run a study: many paired runs, compared. It can be ended at any moment and resumed."""
    from giveway.errors import ConfigError
    from giveway.studies.study_files import find_study

    if (study is None) == (not vary) or (config is not None and not vary):
        raise ConfigError(
            "expected a study, or --vary (with --config, if you like); 'giveway studies' lists the "
            "bundled ones"
        )
    if study is not None:
        find_study(study)  # before anything slower is loaded
    from giveway.cli.commands.study_command import StudyRequest, study_command
    from giveway.studies.study import StudyOptions

    options = StudyOptions(
        jobs=jobs,
        cluster=cluster,
        resume=resume,
        force=force,
        retry_failed=retry_failed,
        hang_limit=hang_limit,
        run_limit=run_limit,
    )
    request = StudyRequest(
        study,
        tuple(vary or ()),
        tuple(only or ()),
        config,
        out,
        runs,
        first_seed,
        twin,
        dry_run=dry_run,
        report=report,
        quiet=quiet,
        as_json=as_json,
    )
    raise typer.Exit(study_command(request, options))


def _studies() -> None:
    """List the bundled studies."""
    from giveway.studies.definition import read_definition
    from giveway.studies.study_files import bundled_studies, find_study

    for name in bundled_studies():
        typer.echo(f"{name:14} {read_definition(find_study(name)).description}")


def _rerun(
    study: _Folder,
    run: Annotated[str, typer.Argument(help="The run's id, like c2-s17; see runs.csv.")],
    out: Annotated[
        Path | None, typer.Option(help="Results folder (default STUDY/reruns/RUN).")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace the results there.")] = False,
    predictions: Annotated[
        bool, typer.Option("--predictions", help="Keep the predicted positions too.")
    ] = False,
    pictures: Annotated[bool, typer.Option(help="Draw the pictures.")] = True,
    quiet: Annotated[
        bool, typer.Option("--quiet", "-q", help="Neither progress bar nor summary.")
    ] = False,
    trust: _Trust = None,
) -> None:
    """Make one run of a study again, with all trajectories, and compare its numbers."""
    from giveway.cli.guards.isolated import run_isolated, supervised
    from giveway.processes.child import take_journal_folder

    journal = take_journal_folder()
    if journal is None:
        raise typer.Exit(run_isolated())
    from giveway.cli.commands.rerun_command import rerun_command
    from giveway.cli.commands.run_command import Outputs

    outputs = Outputs(out, force=force, parquet=False, pictures=pictures, quiet=quiet)
    supervised(
        journal,
        lambda: rerun_command(
            study, run, outputs, predictions=predictions, journal=journal, trusted=trust or ()
        ),
    )


def _report(
    study: _Folder,
    replays: Annotated[
        bool, typer.Option(help="Make the runs that it points at again, to play and show them.")
    ] = True,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress.")] = False,
    trust: _Trust = None,
) -> None:
    """Write figures, replays of the most telling runs, and report.html into a study's folder."""
    from giveway.cli.commands.report_command import report_command

    raise typer.Exit(report_command(study, replays=replays, quiet=quiet, trusted=trust or ()))


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
    show: Annotated[bool, typer.Option("--open", help="Open it in the browser.")] = False,
) -> None:
    """Write one HTML page that plays a run, in any browser, without a network."""
    from giveway.cli.commands.replay_command import replay_command

    raise typer.Exit(replay_command(run, out=out, beside=beside, rerun=rerun, show=show))
