"""The commands ``giveway check``: the conformance of code of other packages."""

from __future__ import annotations

from typing import Annotated

import typer

from giveway.cli.help import Commands

_Name = Annotated[str, typer.Argument(help="Declared name, or module:Class.")]
_Controller = Annotated[
    str, typer.Argument(help="Declared name, module:Class, or a controller FMU.")
]
_Profile = Annotated[
    str,
    typer.Option("--controller-profile", metavar="FILE", help="Of an FMU; none: drafted."),
]
_Set = Annotated[
    list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="One of its options.")
]
_Step = Annotated[
    float | None,
    typer.Option("--time-step", metavar="S", help="Control step of the scenes [s]; none: 0.05."),
]


def build_check() -> Commands:
    """Return the group of commands."""
    check = Commands("Check code of other packages.")
    check.add("controller", _controller)
    check.add("model", _model)
    check.add("rule", _rule)

    check.add("sensor", _sensor)
    check.callback()(_check)
    return check


def _check() -> None:
    """Check code of other packages."""


def _controller(
    name: _Controller,
    controller_profile: _Profile = "",
    set_: _Set = None,
    time_step: _Step = None,
) -> None:
    """Check that a controller obeys the rules: it drives through made-up scenes, without SUMO."""
    from giveway.cli.commands.check_command import check_command
    from giveway.plug_ins.sockets import CONTROLLER

    raise typer.Exit(
        check_command(name, set_ or (), CONTROLLER, time_step=time_step, profile=controller_profile)
    )


def _model(name: _Name, set_: _Set = None, time_step: _Step = None) -> None:
    """Check that a pedestrian model obeys the rules: it moves people in made-up scenes."""
    from giveway.cli.commands.check_command import check_command
    from giveway.plug_ins.sockets import MODEL

    raise typer.Exit(check_command(name, set_ or (), MODEL, time_step=time_step))


def _rule(name: _Name, set_: _Set = None, time_step: _Step = None) -> None:
    """Check that a rule of the road obeys the rules: an ego drives along a made-up road."""
    from giveway.cli.commands.check_command import check_command
    from giveway.plug_ins.sockets import RULE

    raise typer.Exit(check_command(name, set_ or (), RULE, time_step=time_step))


def _sensor(name: _Name, set_: _Set = None, time_step: _Step = None) -> None:
    """Check that a sensor obeys the rules: it is shown people in made-up scenes."""
    from giveway.cli.commands.check_command import check_command
    from giveway.plug_ins.sockets import SENSOR

    raise typer.Exit(check_command(name, set_ or (), SENSOR, time_step=time_step))
