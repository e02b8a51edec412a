"""``giveway check``: the conformance of code of other packages."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Protocol

import typer

from giveway.cli.help import Commands

if TYPE_CHECKING:
    from collections.abc import Sequence

    from giveway.config import RunConfig
    from giveway.plug_ins.sockets import Socket

_STEP = 0.05  # [s]

_Name = Annotated[str, typer.Argument(help="Declared name, or module:Class.")]
_Set = Annotated[
    list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="One of its options.")
]


class Finding(Protocol):
    """What a battery has found about one rule."""

    @property
    def rule(self) -> str:
        """In a few words."""

    @property
    def problem(self) -> str:
        """What breaks it; empty if it is kept."""


def build_check() -> Commands:
    """The group of commands."""
    check = Commands("Check code of other packages.")
    check.add("controller", _controller)
    check.add("model", _model)
    check.callback()(_check)
    return check


def _check() -> None:
    """Check code of other packages."""


def _controller(name: _Name, set_: _Set = None) -> None:
    """Does a controller keep to the rules? It is driven through made-up scenes, without SUMO."""
    raise typer.Exit(check_controller_command(name, set_ or ()))


def _model(name: _Name, set_: _Set = None) -> None:
    """Does a pedestrian model? It moves people through made-up scenes, without SUMO."""
    raise typer.Exit(check_model_command(name, set_ or ()))


def check_controller_command(name: str, words: Sequence[str]) -> int:
    """Print what was found; the exit code is 1 if a rule is broken.

    Raises:
        GivewayError: it cannot be found, imported or given its options.
    """
    from controller import check_controller
    from giveway.config import EgoRunConfig
    from giveway.ego.plug_in import maker, setup_of
    from giveway.plug_ins.sockets import CONTROLLER

    config = _configured(name, words, CONTROLLER).each_ego()[0]
    if not isinstance(config, EgoRunConfig) or not config.plugged_in:
        raise _ours(name, CONTROLLER)
    return _told(name, check_controller(maker(config), setup_of(config, _STEP)))


def check_model_command(name: str, words: Sequence[str]) -> int:
    """Print what was found; the exit code is 1 if a rule is broken.

    Raises:
        GivewayError: it cannot be found, imported or given its options.
    """
    from giveway.crowd.models import maker, setup_of
    from giveway.plug_ins.sockets import MODEL
    from pedestrian_model import check_model

    config = _configured(name, words, MODEL)
    if not config.crowd.plugged_in:
        raise _ours(name, MODEL)
    return _told(name, check_model(maker(config), setup_of(config, _STEP)))


def _configured(name: str, words: Sequence[str], socket: Socket) -> RunConfig:
    from giveway.cli.flags import set_options
    from giveway.config.layers import Layer, build_config

    settings: dict[str, Any] = {socket.options: set_options(words)}
    node = settings
    for table in socket.location[:-1]:
        node = node.setdefault(table, {})
    node[socket.location[-1]] = name
    return build_config([Layer("command line", settings, from_flags=True)])


def _ours(name: str, socket: Socket) -> Exception:
    from giveway.errors import ConfigError

    return ConfigError(f"{name}: is giveway's own; expected a {socket.what} of another package")


def _told(name: str, findings: Sequence[Finding]) -> int:
    for finding in findings:
        typer.echo(f"{'broken' if finding.problem else 'kept':7} {finding.rule}")
        if finding.problem:
            typer.echo(f"        {finding.problem}")
    broken = sum(bool(finding.problem) for finding in findings)
    typer.echo(f"{name}: {broken} of {len(findings)} rules broken" if broken else f"{name}: sound")
    return 1 if broken else 0
