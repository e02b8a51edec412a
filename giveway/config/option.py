"""How an option is declared: its unit, its bounds, and the values it takes from files and flags."""

from __future__ import annotations

import shlex
from typing import Annotated, Any, Literal

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    JsonValue,
)
from pydantic_core import PydanticCustomError


def option(
    default: Any, unit: str | None, description: str, *, flag: str | None = None, **bounds: Any
) -> Any:
    """A documented option: its unit, what it means, its flag where the derived one is clumsy."""
    extra: dict[str, JsonValue] = {"unit": unit, "flag": flag}
    return Field(default, description=description, json_schema_extra=extra, **bounds)


def _split(value: Any) -> Any:
    """A comma-separated flag value as the list that a TOML file would hold."""
    return [part.strip() for part in value.split(",")] if isinstance(value, str) else value


def _words(value: Any) -> Any:
    """Options for SUMO, written as in a shell."""
    if not isinstance(value, str):
        return value
    try:
        return shlex.split(value)
    except ValueError as error:
        msg = f"expected options as in a shell, like '--emission-output e.xml' ({error})"
        raise PydanticCustomError("shell", "{expected}", {"expected": msg}) from None


def _text(value: Any) -> Any:
    """A number where text is expected, like a radius in a TOML file."""
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return f"{value:.12g}" if is_number else value


def _preset(value: str) -> str:
    """A name or a file of the model's parameters; the file itself is read when it is needed."""
    if value in {"", "SIM", "TABLE2"} or value.endswith(".toml"):
        return value
    msg = "expected SIM, TABLE2 or a preset file (.toml; giveway calibrate writes one)"
    raise PydanticCustomError("preset", "{expected}", {"expected": msg})


def _seed(value: Any) -> Any:
    return int(value) if isinstance(value, str) and value.isdecimal() else value


Rectangle = Annotated[tuple[float, float, float, float], BeforeValidator(_split)]


Displacement = Annotated[tuple[float, float], BeforeValidator(_split)]


NameList = Annotated[tuple[str, ...], BeforeValidator(_split)]


TextOrNumber = Annotated[str, BeforeValidator(_text)]


Preset = Annotated[str, AfterValidator(_preset)]


OptionList = Annotated[tuple[str, ...], BeforeValidator(_words)]


SumoSeed = Annotated[
    Annotated[int, Field(ge=0, le=2**31 - 1)] | Literal["scenario", "run"], BeforeValidator(_seed)
]


class Section(BaseModel):
    """A table of the configuration: frozen, finite numbers only, unknown keys refused."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", allow_inf_nan=False, validate_default=True
    )
