"""The help pages: one plain style for all of them, everyday options first.

Names are never cut: a long name has a line of its own (as click writes definition lists).
"""

import re
from collections.abc import Callable, Sequence
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup

JsonFlag = Annotated[
    bool, typer.Option("--json", help="Print what was found as JSON, for scripts, and no more.")
]
"""Type of the flag of every command whose findings a script may need."""

_KIND = re.compile(r"<(\w+)(?: range)?>")
_KINDS = {"int": "INTEGER", "float": "NUMBER", "str": "TEXT"}
_LONGEST = 300  # Number of characters of a command's sentence in the list, so that none is cut


class Commands(typer.Typer):
    """A group of commands in giveway's style.

    Args:
        purpose: Purpose of the group.
        completion: True if it has the options that install the shell's completion.
    """

    def __init__(self, purpose: str, *, completion: bool = False) -> None:
        super().__init__(
            cls=_Group,
            help=purpose,
            no_args_is_help=True,
            add_completion=completion,
            pretty_exceptions_enable=False,
            rich_markup_mode=None,
        )

    def add(self, name: str, function: Callable[..., None]) -> None:
        """Add the command ``name``, whose help is the function's docstring."""
        self.command(name, cls=_Command)(function)

    def keep(self, name: str | None) -> None:
        """Leave only the command or group ``name``, if it is one: typer builds each of them."""
        commands = [command for command in self.registered_commands if command.name == name]
        groups = [group for group in self.registered_groups if group.name == name]
        if commands or groups:
            self.registered_commands, self.registered_groups = commands, groups


def show_all_options(ctx: typer.Context, wanted: bool) -> None:
    """Print the help with all options; the callback of ``--help-all``."""
    if wanted:
        assert isinstance(ctx.command, _Command)
        ctx.command.everything = True
        typer.echo(ctx.get_help())
        raise typer.Exit


class _Command(TyperCommand):
    """A command whose help shows the options in panels only with ``--help-all``."""

    everything = False

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the arguments and everyday options, and with ``--help-all`` all others by panel."""
        groups: dict[str, list[tuple[str, str]]] = {"Arguments": [], "Options": []}
        for parameter in self.get_params(ctx):
            record = parameter.get_help_record(ctx)
            if record is None:
                continue
            is_option = parameter.param_type_name == "option"
            panel = getattr(parameter, "rich_help_panel", None)
            group = panel or ("Options" if is_option else "Arguments")
            head = _KIND.sub(_kind, record[0]) + _installed(parameter.opts)
            groups.setdefault(group, []).append((head, record[1]))
        for name, records in groups.items():
            if records and (self.everything or name in {"Arguments", "Options"}):
                with formatter.section(name):
                    formatter.write_dl(records)


class _Group(TyperGroup):
    """A group of commands; each is listed with its whole first sentence."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the list of commands."""
        commands = [(name, self.get_command(ctx, name)) for name in self.list_commands(ctx)]
        rows = [
            (name, command.get_short_help_str(_LONGEST))
            for name, command in commands
            if command is not None
        ]
        with formatter.section("Commands"):
            formatter.write_dl(rows)


def _installed(flags: Sequence[str]) -> str:
    """Return the names that installed packages add to those of a flag, as in "|idm"."""
    from giveway.plug_ins.finding import declared_names  # these take half a second to import
    from giveway.plug_ins.sockets import SOCKETS

    sockets = [socket for socket in SOCKETS if socket.flag in flags]
    return "".join(f"|{name}" for socket in sockets for name in declared_names(socket))


def _kind(match: re.Match[str]) -> str:
    return _KINDS.get(match[1], match[1].upper())
