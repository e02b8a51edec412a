"""The options of commands, in groups that belong together.

An option is declared once, as a field with its flag, help and default. A command takes whole
groups (``ungrouping.py``).
"""

from pathlib import Path
from typing import Annotated, NamedTuple

import typer

from giveway.cli.completion import complete_study
from giveway.cli.help import JsonFlag
from giveway.run_data.seal import Form

Force = Annotated[bool, typer.Option("--force", help="Replace the results there.")]
Pictures = Annotated[bool, typer.Option(help="Draw the pictures.")]
NoSummary = Annotated[bool, typer.Option("--quiet", "-q", help="Neither progress bar nor summary.")]
NoTables = Annotated[bool, typer.Option("--quiet", "-q", help="Neither progress bar nor tables.")]
ControlStep = Annotated[float, typer.Option(help="Control step in s.", min=0.001, max=0.5)]
ForceLimit = Annotated[float, typer.Option(help="Largest force in N.", min=1.0, max=1e6)]
Trust = Annotated[
    list[str] | None,
    typer.Option(metavar="NAME", help="Code (FMU, plug-in) that results name and that you know."),
]
Unsealed = Annotated[
    bool, typer.Option("--unsealed", help="Use tables although they are not what the run wrote.")
]
ReplaceFile = Annotated[bool, typer.Option("--force", help="Replace a file that is there.")]


class RunOutputs(NamedTuple):
    """The outputs of a run that the user wants to keep and to see."""

    out: Annotated[
        Path | None, typer.Option(help="Results folder (default: a new one in results/).")
    ] = None
    force: Force = False
    parquet: Annotated[
        bool,
        typer.Option("--parquet", help="Write the tables as Parquet too.", rich_help_panel="Run"),
    ] = False
    trajectories: Annotated[
        Form, typer.Option(help="Form of the longest table.", rich_help_panel="Run")
    ] = "csv"
    pictures: Annotated[bool, typer.Option(help="Draw the pictures.", rich_help_panel="Run")] = True
    quiet: NoSummary = False
    explain: Annotated[
        bool, typer.Option("--explain", help="Print all numbers of the summary, with meanings.")
    ] = False
    as_json: JsonFlag = False
    trust: Trust = None


class RerunOutputs(NamedTuple):
    """The outputs of a repeated run that the user wants to keep and to see."""

    out: Annotated[Path | None, typer.Option(help="Results folder (default STUDY/reruns/RUN).")] = (
        None
    )
    force: Force = False
    predictions: Annotated[
        bool, typer.Option("--predictions", help="Keep the predicted positions too.")
    ] = False
    pictures: Pictures = True
    quiet: NoSummary = False


class StudyChoice(NamedTuple):
    """The study that the user names, or varies by flags."""

    study: Annotated[
        str | None,
        typer.Argument(
            help="Bundled study (see giveway studies) or .toml. Without one see --vary.",
            autocompletion=complete_study,
        ),
    ] = None
    vary: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KEY=A,B,...",
            help="Without a study: an option and its values, like crowd.pedestrians=10,20.",
        ),
    ] = None
    only: Annotated[
        list[str] | None,
        typer.Option(
            metavar="FACTOR=LEVEL",
            help="Of the study this level of a factor alone, like controller=mpc; repeatable.",
        ),
    ] = None
    config: Annotated[
        Path | None, typer.Option(help="With --vary: a run's TOML file with the other settings.")
    ] = None


class BenchmarkChoice(NamedTuple):
    """The controllers that the user wants to compare, and the part of the benchmark."""

    controllers: Annotated[
        list[str],
        typer.Argument(metavar="CONTROLLER...", help="Bundled controllers, plug-ins or FMUs."),
    ]
    config: Annotated[
        Path | None, typer.Option(help="TOML file with the options that the controller needs.")
    ] = None
    only: Annotated[
        list[str] | None,
        typer.Option(
            metavar="FACTOR=LEVEL",
            help="This scene or these people alone, like people=MIXED; repeatable.",
        ),
    ] = None
    runs: Annotated[
        int | None, typer.Option("--runs", help="Drives per scene (default 100).", min=1)
    ] = None


class RiskChoice(NamedTuple):
    """The runs whose risk the user wants to know."""

    subject: Annotated[
        str,
        typer.Argument(metavar="SCENARIO|FILE", help="Scenario, or a risk file (docs/risk.md)."),
    ]
    config: Annotated[
        Path | None, typer.Option(help="A run's TOML file with other settings of every run.")
    ] = None
    fixed: Annotated[
        list[str] | None,
        typer.Option(
            "--fix",
            metavar="KEY=VALUE",
            help="Setting of every run, like crowd.pedestrians=30; repeatable.",
        ),
    ] = None
    random: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KEY=DISTRIBUTION:NUMBERS",
            help="Random input, like vehicle.mass=normal:1000,100; repeatable.",
        ),
    ] = None


class RiskEstimate(NamedTuple):
    """The event and the estimator; see ``RiskDefinition``."""

    event: Annotated[
        str | None,
        typer.Option(
            help="frontal (default), side, contact, impact>SPEED in km/h, mais3 or red-light."
        ),
    ] = None
    method: Annotated[
        str | None, typer.Option(help="monte-carlo (default), subset or importance.")
    ] = None
    criticality: Annotated[
        str | None,
        typer.Option(help="Nearness to the event: deceleration (default), clearance or ttc."),
    ] = None
    runs: Annotated[
        int | None,
        typer.Option(help="Runs, or the budget (default 1000).", min=1),
    ] = None
    why: Annotated[
        int | None,
        typer.Option(help="Base vectors of the Sobol indices of the criticality.", min=0),
    ] = None
    seed: Annotated[int | None, typer.Option(help="Of all vectors (default 1).", min=0)] = None
    confidence: Annotated[
        float | None, typer.Option(help="Of the interval (default 0.95).", min=0.5, max=1.0)
    ] = None


class NcapChoice(NamedTuple):
    """The car and the tests that the user wants to see."""

    car: Annotated[
        str, typer.Argument(metavar="CAR.FMU", help="Vehicle FMU, or a bundled one, like fmi2.")
    ]
    profile: Annotated[Path | None, typer.Option(help="Vehicle profile (TOML) of the FMU.")] = None
    protocol: Annotated[str, typer.Option(help="euroncap, or r152 (UN R152).")] = "euroncap"
    year: Annotated[str, typer.Option(help="Euro NCAP's protocol: 2026 or 2023.")] = "2026"
    controller: Annotated[
        str | None,
        typer.Option(help="Add a table in which this controller drives. It is no rating."),
    ] = None
    config: Annotated[
        Path | None,
        typer.Option(help="A run's TOML file with the car's width, its sensors and its layer."),
    ] = None
    tests: Annotated[
        list[str] | None, typer.Option("--only", metavar="TEST", help="A test; repeatable.")
    ] = None
    speeds: Annotated[
        list[int] | None, typer.Option("--speed", metavar="KM/H", help="A speed; repeatable.")
    ] = None
    measured: Annotated[
        Path | None,
        typer.Option(help="CSV file of measured impact speeds, which verify the colours."),
    ] = None
    seed: Annotated[int, typer.Option(help="Seed of all runs.", min=0)] = 1


class StudySeeds(NamedTuple):
    """The seeds of a study's runs."""

    runs: Annotated[
        int | None,
        typer.Option("--runs", "--seeds", help="Seeds per cell, instead of the study's.", min=1),
    ] = None
    first_seed: Annotated[
        int | None, typer.Option(help="First seed, instead of the study's.", min=0)
    ] = None


class StudyComputation(NamedTuple):
    """The options of a study's computation; see ``StudyOptions``."""

    resume: Annotated[bool, typer.Option("--resume", help="Go on with what is in the folder.")] = (
        False
    )
    force: Annotated[bool, typer.Option("--force", help="Replace the study there.")] = False
    retry_failed: Annotated[
        bool, typer.Option("--retry-failed", help="With --resume: make failed runs again.")
    ] = False
    jobs: Annotated[
        int | None,
        typer.Option(help="Worker processes (default: one per processor).", min=1),
    ] = None
    cluster: Annotated[
        str | None,
        typer.Option(help="Dask scheduler to compute on, tcp://HOST:PORT, or local:N."),
    ] = None
    hang_limit: Annotated[
        float, typer.Option(help="Seconds without progress after which a run is ended.", min=1.0)
    ] = 120.0
    run_limit: Annotated[
        float | None, typer.Option(help="Seconds that one run may take (default: any).", min=0.1)
    ] = None


class StudyOutputs(NamedTuple):
    """The outputs of a study that the user wants to see."""

    report: Annotated[bool, typer.Option(help="Write figures and report.html.")] = True
    quiet: NoTables = False
    as_json: JsonFlag = False


class FitSettings(NamedTuple):
    """The settings of a fit of the pedestrian model."""

    parameters: Annotated[
        str,
        typer.Option(
            help="What is fitted, comma-separated; by default 14 parameters: docs/validation.md."
        ),
    ] = ""
    start: Annotated[
        str, typer.Option("--preset", help="Where the fit starts: a preset or a preset file.")
    ] = "SIM"
    seed: Annotated[int, typer.Option(help="Of the search.", min=0)] = 0
    evaluations: Annotated[
        int | None,
        typer.Option(help="At most; by default 1,500.", min=1),
    ] = None


class DryRun(NamedTuple):
    """The settings of an FMU's dry run, and its outputs."""

    step: ControlStep = 0.05
    out: Annotated[
        Path | None, typer.Option(help="Folder for the picture (default results/FMU_check).")
    ] = None
    mass: Annotated[
        float | None,
        typer.Option(help="What the vehicle weighs, M of the controller, in kg.", min=1e-3),
    ] = None
    ego_class: Annotated[
        str | None, typer.Option(help="SUMO's vehicle class, where its mass is not known.")
    ] = None
    friction: Annotated[float, typer.Option(help="alpha of it in N.s/m.", min=0.0)] = 100.0
    force_limit: ForceLimit = 8000.0
    speed: Annotated[float, typer.Option(help="Rolling start in m/s.", min=0.0)] = 4.0
    as_json: JsonFlag = False


class StepTests(NamedTuple):
    """The settings of an FMU's step tests, and their outputs."""

    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Profile to write, with the model in it.")
    ] = None
    step: ControlStep = 0.05
    horizon: Annotated[int, typer.Option(help="Of the MPC in steps.", min=2, max=200)] = 15
    force_limit: Annotated[
        float | None,
        typer.Option(help="Largest force in N (default: 8 m/s² of the mass).", min=1.0, max=1e7),
    ] = None
    speeds: Annotated[
        str, typer.Option(help="Speeds in m/s that the tests start from, comma-separated.")
    ] = "0,2,5,9,14,20"
    picture: Annotated[
        Path | None,
        typer.Option(
            help="Measured against fitted (default results/FMU_identify/FMU_identify.png)."
        ),
    ] = None
    force: ReplaceFile = False
