"""The flag of every option of the configuration, derived from its declaration."""

from __future__ import annotations

import inspect
import math
import types
import typing
from typing import Annotated, Any, Literal

import typer

from giveway.cli.help import show_all_options
from giveway.config.files.layers import Location, Option, options, own_flags
from giveway.config.files.toml import toml_value
from giveway.errors import ConfigError
from giveway.plug_ins.sockets import CONTROLLER, SOCKETS, TABLES, Socket

if typing.TYPE_CHECKING:
    from collections.abc import Callable, Sequence

_PANELS = {
    "ego": "Ego",
    "vehicle": "Vehicle",
    "crowd": "Pedestrians",
    "regulation": "Regulation",
    "rules": "Rules",
    "safety": "Safety",
    "perception": "Perception",
    "traffic": "Traffic",
    "sumo": "SUMO",
    "record": "Recording",
    "metrics": "Recording",
}

_HelpAll = Annotated[
    bool,
    typer.Option(
        "--help-all",
        help="Show all options and exit.",
        is_eager=True,
        callback=show_all_options,
    ),
]


def _name_flag(socket: Socket) -> Any:
    return Annotated[
        list[str] | None,
        typer.Option(
            socket.flag,
            metavar="NAME[.KEY=VALUE]",
            help=f"A {socket.what} that is not giveway's own, and its options; as often as needed.",
            rich_help_panel=_PANELS[socket.options],
        ),
    ]


def _set_flag(socket: Socket) -> Any:
    return Annotated[
        list[str] | None,
        typer.Option(
            socket.set_flag,
            metavar="KEY=VALUE",
            help=f"An option of the {socket.what}; as often as needed.",
            rich_help_panel="Run",
        ),
    ]


_EVERYDAY = frozenset(
    {
        ("controller",),
        ("controller_options", "style"),
        ("seed",),
        ("time_limit",),
        ("twin",),
        ("ego", "take_over"),
        ("ego", "none"),
        ("vehicle", "fmu"),
        ("vehicle", "profile"),
        ("crowd", "pedestrians"),
        ("regulation", "reference_speed"),
    }
)


def accept_config_flags(command: Callable[..., None]) -> Callable[..., None]:
    """Return ``command`` with one flag per configuration option.

    The flags that are given arrive as the argument ``settings``.

    Values arrive as text. The configuration validates them, with the same messages as those of a
    TOML file.
    """
    locations = {"__".join(o.location): o for o in options() if o.location != ("scenario",)}
    own_options = {"__".join(o.location): o for o in own_flags()}

    def call(**arguments: Any) -> None:
        settings: dict[str, Any] = {}
        del arguments["help_all"]
        for name, option in own_options.items():
            if (value := arguments.pop(name)) is not None:
                words = arguments[CONTROLLER.options] or []
                arguments[CONTROLLER.options] = [*words, f"{option.location[-1]}={value}"]
        for socket in SOCKETS:
            set_values = set_options(arguments.pop(socket.options) or (), socket)
            if set_values:
                settings[socket.options] = set_values
        for socket in TABLES:
            if named := set_plug_ins(arguments.pop(socket.what) or (), socket):
                settings[socket.options] = named
        for name, option in locations.items():
            value = arguments.pop(name)
            if value is not None:
                _put(settings, option.location, value)
        command(settings=settings, **arguments)

    own = list(inspect.signature(command, eval_str=True).parameters.values())[1:]
    keyword = inspect.Parameter.KEYWORD_ONLY
    flags = [
        inspect.Parameter(name, keyword, default=None, annotation=_annotation(option))
        for name, option in (locations | own_options).items()
    ]
    flags += [
        inspect.Parameter(socket.options, keyword, default=None, annotation=_set_flag(socket))
        for socket in SOCKETS
    ]
    flags += [
        inspect.Parameter(socket.what, keyword, default=None, annotation=_name_flag(socket))
        for socket in TABLES
    ]
    flags.append(inspect.Parameter("help_all", keyword, default=False, annotation=_HelpAll))
    call.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
        [parameter.replace(kind=keyword) for parameter in own] + flags
    )
    call.__doc__ = command.__doc__
    call.__annotations__ = {p.name: p.annotation for p in (*own, *flags)}
    return call


def set_plug_ins(words: Sequence[str], socket: Socket) -> dict[str, Any]:
    """Return the plug-ins that a flag names, from words like ``school_zone`` or ``a.limit=8``.

    Raises:
        ConfigError: a word names no plug-in, or an option is given twice.
    """
    found: dict[str, Any] = {}
    for word in words:
        name, _, own = word.partition("=")
        plug_in, _, key = name.rpartition(".") if "=" in word else (name, "", "")
        if not plug_in:
            msg = f"{socket.flag} {word}: expected a {socket.what}, or NAME.KEY=VALUE"
            raise ConfigError(msg)
        known = found.setdefault(plug_in, {})
        if key in known:
            raise ConfigError(f"{socket.flag} {word}: '{key}' is given twice; keep one")
        if key:
            known |= set_options([f"{key}={own}"], socket)
    return {name: own or True for name, own in found.items()}


def set_options(words: Sequence[str], socket: Socket = CONTROLLER) -> dict[str, Any]:
    """Return the options of a plug-in, from words like ``headway=1.5``.

    Raises:
        ConfigError: a word is no key and value, or a key is given twice.
    """
    values: dict[str, Any] = {}
    for word in words:
        key, equals, text = word.partition("=")
        key = key.strip()
        if not equals or not key:
            raise ConfigError(
                f"{socket.set_flag} {word}: expected an option and its value, like headway=1.5"
            )
        if key in values:
            raise ConfigError(f"{socket.set_flag} {word}: '{key}' is given twice; keep one")
        value = toml_value(text.strip())
        # TOML writes nan and inf as words
        is_word = isinstance(value, float) and not math.isfinite(value)
        values[key] = text.strip() if is_word else value
    return values


def _put(settings: dict[str, Any], location: Location, value: Any) -> None:
    *tables, key = location
    for table in tables:
        settings = settings.setdefault(table, {})
    settings[key] = value


def _annotation(option: Option) -> Any:
    everyday = option.location in _EVERYDAY
    panel = None if everyday else _PANELS.get(option.location[0], "Run")
    text = _help(option)
    switch = option.field.annotation in (bool, bool | None)
    if switch and option.flag.startswith("--no-"):
        return Annotated[bool | None, typer.Option(option.flag, help=text, rich_help_panel=panel)]
    if switch:
        name = f"{option.flag}/--no-{option.flag.removeprefix('--')}"
        return Annotated[bool | None, typer.Option(name, help=text, rich_help_panel=panel)]
    return Annotated[
        str | None,
        typer.Option(
            option.flag,
            help=text,
            rich_help_panel=panel,
            metavar=_metavar(option.field.annotation),
            autocompletion=_choices(option.field.annotation),
        ),
    ]


def _help(option: Option) -> str:
    """Return the meaning, the unit and the default of an option as a sentence."""
    default = option.field.get_default(call_default_factory=True)
    shown = ",".join(map(str, default)) if isinstance(default, tuple) else default
    shown = {True: "yes", False: ""}.get(shown, shown) if isinstance(shown, bool) else shown
    known = "" if shown in (None, "") else f"default {shown}"
    remarks = "; ".join(part for part in (option.unit, known) if part)
    text = option.field.description
    return f"{text} ({remarks})." if remarks else f"{text}."


def _choices(annotation: Any) -> Callable[[str], list[str]] | None:
    """Return the completion of an option's words, or None if it takes other values."""
    if typing.get_origin(annotation) in (typing.Union, types.UnionType):
        annotation = typing.get_args(annotation)[0]
    if typing.get_origin(annotation) is not Literal:
        return None
    words = [str(word) for word in typing.get_args(annotation)]

    def complete(incomplete: str) -> list[str]:
        return [word for word in words if word.startswith(incomplete)]

    return complete


def _metavar(annotation: Any) -> str:
    origin = typing.get_origin(annotation)
    if origin in (typing.Union, types.UnionType):
        annotation = typing.get_args(annotation)[0]
        origin = typing.get_origin(annotation)
    if origin is Literal:
        return "|".join(map(str, typing.get_args(annotation)))
    if origin is tuple:
        return "A,B,..."
    return {int: "INTEGER", float: "NUMBER"}.get(annotation, "TEXT")
