"""The options of a plug-in: its class ``Options``, filled with texts and TOML values."""

import dataclasses
from collections.abc import Mapping
from typing import Any, get_type_hints

from pydantic import BaseModel, TypeAdapter, ValidationError
from pydantic.errors import PydanticUserError

from fmus.strict_table import NO_TRUTH, is_truth_for_number
from giveway.errors import ConfigError, ControlError, in_words, suggestion
from giveway.plug_ins.sockets import CONTROLLER, Socket


def read_options(
    name: str, kind: type | None, values: Mapping[str, Any], socket: Socket = CONTROLLER
) -> Any:
    """Return the options of a plug-in.

    Args:
        name: Name of the plug-in, for messages.
        kind: Class ``Options`` of the plug-in, a dataclass or pydantic model, or None without one.
        values: Values as the user has set them; those of a command line are texts.
        socket: Socket for which the plug-in is used.

    Returns:
        An instance of ``kind``, or None without it.

    Raises:
        ConfigError: a key is unknown, or a value cannot be used.
        ControlError: ``kind`` is neither a dataclass nor a pydantic model.
    """
    table = f"[{socket.options}]"
    known = [] if kind is None else _names(name, kind, socket)
    types = _types(kind)
    for key, value in values.items():
        if key not in known:
            hint = suggestion(key, known, "" if known else "expected none: it has no options")
            raise ConfigError(f"{table} {key}: '{name}' has no such option; {hint}")
        if is_truth_for_number(value, types.get(key)):
            raise ConfigError(f"{table} {key} = {value!r}: {NO_TRUTH} ('{name}')")
    if kind is None:
        return None
    try:
        return TypeAdapter(kind).validate_python(dict(values))
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(map(str, first["loc"])) or "options"
        said = f"{in_words(first)}{_unit(kind, key)}"
        given = "is missing" if first["type"] == "missing" else f"= {first['input']!r}"
        raise ConfigError(f"{table} {key} {given}: {said} ('{name}')") from None
    except PydanticUserError as error:
        said = str(error).partition("\n")[0]
        raise ControlError(
            f"{socket.setting} = '{name}': its Options cannot be read ({said})"
        ) from error
    except (Exception, SystemExit) as error:  # an error of the plug-in's own validators
        said = f"{type(error).__name__}: {str(error).partition(chr(10))[0]}"
        raise ConfigError(f"{table}: '{name}' refuses them ({said})") from error


def plain(options: Any) -> dict[str, Any]:
    """Return the options, with defaults, as in a manifest."""
    if isinstance(options, BaseModel):
        return options.model_dump(mode="json")
    if options is None:
        return {}
    values: dict[str, Any] = TypeAdapter(type(options)).dump_python(options, mode="json")
    return values


def _names(name: str, kind: Any, socket: Socket) -> list[str]:
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        return list(kind.model_fields)
    if isinstance(kind, type) and dataclasses.is_dataclass(kind):
        return [field.name for field in dataclasses.fields(kind) if field.init]
    raise ControlError(
        f"{socket.setting} = '{name}': Options = {kind!r}: expected a dataclass or a pydantic model"
    )


def _types(kind: Any) -> dict[str, Any]:
    """Return the types of the options by name; empty if a name in them means nothing."""
    try:
        return get_type_hints(kind)
    except (NameError, TypeError):  # pydantic reports it, or there is no class
        return {}


def _unit(kind: Any, key: str) -> str:
    """Return the declared unit of an option in brackets; empty if it has none."""
    field = getattr(kind, "model_fields", {}).get(key)
    extra = getattr(field, "json_schema_extra", None)
    unit = extra.get("unit") if isinstance(extra, dict) else None
    return f" [{unit}]" if unit else ""
