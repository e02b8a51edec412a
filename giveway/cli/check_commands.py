"""The commands ``giveway check``: the conformance of code of other packages."""

from typing import Annotated

import typer

from giveway.cli.help import Commands, JsonFlag

_Name = Annotated[str, typer.Argument(help="Declared name, or module:Class.")]
_Controller = Annotated[
    str, typer.Argument(help="Declared name, module:Class, or a controller FMU.")
]
_Profile = Annotated[
    str,
    typer.Option(
        "--controller-profile",
        metavar="FILE",
        help="Profile of a controller FMU. By default it is drafted.",
    ),
]
_Set = Annotated[
    list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="One of its options.")
]
_Step = Annotated[
    float | None,
    typer.Option(
        "--time-step", metavar="S", help="Control step of the scenes [s]. By default it is 0.05."
    ),
]


def build_check() -> Commands:
    """Return the group of commands."""
    check = Commands("Check code of other packages.")
    for command in (_controller, _model, _rule, _sensor, _metric):
        check.add(command.__name__.removeprefix("_"), command)
    return check


def _controller(
    name: _Controller,
    controller_profile: _Profile = "",
    set_: _Set = None,
    time_step: _Step = None,
    as_json: JsonFlag = False,
) -> None:
    """Check that a controller obeys the rules: it drives through made-up scenes, without SUMO."""
    _run("controller", name, set_, time_step, controller_profile, as_json=as_json)


def _model(
    name: _Name, set_: _Set = None, time_step: _Step = None, as_json: JsonFlag = False
) -> None:
    """Check that a pedestrian model obeys the rules: it moves people in made-up scenes."""
    _run("pedestrian model", name, set_, time_step, as_json=as_json)


def _rule(
    name: _Name, set_: _Set = None, time_step: _Step = None, as_json: JsonFlag = False
) -> None:
    """Check that a rule of the road obeys the rules: an ego drives along a made-up road."""
    _run("rule", name, set_, time_step, as_json=as_json)


def _sensor(
    name: _Name, set_: _Set = None, time_step: _Step = None, as_json: JsonFlag = False
) -> None:
    """Check that a sensor obeys the rules: it is shown people in made-up scenes."""
    _run("sensor", name, set_, time_step, as_json=as_json)


def _metric(
    name: _Name, set_: _Set = None, time_step: _Step = None, as_json: JsonFlag = False
) -> None:
    """Check that a metric obeys the rules: it measures made-up drives past people."""
    _run("metric", name, set_, time_step, as_json=as_json)


def _run(
    what: str,
    name: str,
    words: list[str] | None,
    time_step: float | None,
    profile: str = "",
    *,
    as_json: bool,
) -> None:
    """Check a plug-in of the kind ``what``, and end with the command's exit code."""
    from giveway.cli.commands.check_command import check_command
    from giveway.plug_ins.sockets import SOCKETS, TABLES

    (socket,) = (one for one in (*SOCKETS, *TABLES) if one.what == what)
    code = check_command(
        name, words or (), socket, time_step=time_step, profile=profile, as_json=as_json
    )
    raise typer.Exit(code)
