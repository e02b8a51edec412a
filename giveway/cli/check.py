"""``giveway check``: the conformance of code of other packages."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from giveway.cli.help import Commands

if TYPE_CHECKING:
    from collections.abc import Sequence


def build_check() -> Commands:
    """The group of commands."""
    check = Commands("Check code of other packages.")
    check.add("controller", _controller)
    check.callback()(_check)
    return check


def _check() -> None:
    """Check code of other packages."""


def _controller(
    name: Annotated[str, typer.Argument(help="Declared name, or module:Class.")],
    set_: Annotated[
        list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="One of its options.")
    ] = None,
) -> None:
    """Does a controller keep to the rules? It is driven through made-up scenes, without SUMO."""
    raise typer.Exit(check_command(name, set_ or ()))


def check_command(name: str, words: Sequence[str]) -> int:
    """Print what was found; the exit code is 1 if a rule is broken.

    Raises:
        GivewayError: it cannot be found, imported or given its options.
    """
    from controller import check_controller
    from giveway.cli.flags import set_options
    from giveway.config import EgoRunConfig
    from giveway.config.layers import Layer, build_config
    from giveway.ego.plug_in import maker, setup_of
    from giveway.errors import ConfigError

    settings = {"controller": name, "controller_options": set_options(words)}
    config = build_config([Layer("command line", settings, from_flags=True)]).each_ego()[0]
    if not isinstance(config, EgoRunConfig) or not config.plugged_in:
        raise ConfigError(f"{name}: is giveway's own; expected a controller of another package")
    findings = check_controller(maker(config), setup_of(config, 0.05))
    for finding in findings:
        typer.echo(f"{'broken' if finding.problem else 'kept':7} {finding.rule}")
        if finding.problem:
            typer.echo(f"        {finding.problem}")
    broken = sum(bool(finding.problem) for finding in findings)
    typer.echo(f"{name}: {broken} of {len(findings)} rules broken" if broken else f"{name}: sound")
    return 1 if broken else 0
