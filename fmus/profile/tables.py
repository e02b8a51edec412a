"""The common parts of all profiles: tables, axes, stepping, start values, and their errors."""

from __future__ import annotations

import tomllib
from math import isfinite
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

from pydantic import (
    BeforeValidator,
    Field,
    ValidationError,
    model_validator,
)

from fmus.description.model import Value
from fmus.errors import FmuProfileError
from fmus.strict_table import StrictTable
from fmus.text import printable


class Axis(StrictTable):
    """One quantity: SI = gain * (factor * raw + unit_offset) + offset.

    ``factor`` and ``unit_offset`` belong to the unit. ``variable`` may be one element of an FMI 3
    array, ``x[2]``, counted from 1.
    """

    variable: str = Field(min_length=1)
    unit: str | None = None  # unit, if the FMU declares none or a wrong one
    gain: float | None = None  # gain, or None for 1 with a unit of the right dimension
    offset: float = 0.0

    @model_validator(mode="after")
    def _invertible(self) -> Axis:
        if self.gain == 0.0:
            raise ValueError("gain = 0: expected a number that is not 0")
        return self


def flat(values: Any) -> Any:
    """Return the variables' values by full name: ``vehicle.mass = 1`` is a table in TOML."""
    if not isinstance(values, dict):
        return values
    found: dict[str, Any] = {}
    tables = [("", values)]
    while tables:
        prefix, table = tables.pop()
        for key, value in table.items():
            name = f"{prefix}{key}"
            if isinstance(value, dict):
                tables.append((f"{name}.", value))
            elif not _is_value(value):
                expected = "a finite number, true, false, text, or a list of finite numbers"
                raise ValueError(f"{name} = {str(value)[:60]}: expected {expected}")
            else:
                found[name] = value
    return found


Period = Annotated[float, Field(ge=0, le=1e6)]
Periods = Annotated[dict[str, Period], BeforeValidator(flat)]


class Stepping(StrictTable):
    """The settings for stepping an FMU."""

    # None for co-simulation if it has it
    kind: Literal["co-simulation", "model-exchange"] | None = None
    # [s] step of the FMU, or None for the control step
    step: float | None = Field(None, gt=0, le=10)
    start_time: float = Field(0.0, ge=-1e9, le=1e9)  # [s] the FMU's time at the start of the run
    stop_time: float | None = Field(None, gt=0, le=1e9)  # [s] end that the FMU is given, or None
    # [s] period of an input clock in place of its own, by name; 0: it never ticks
    clocks: Periods = Field(default_factory=dict)
    # solver of Model Exchange, or None for cvode if it runs
    solver: Literal["cvode", "rk4"] | None = None
    tolerance: float | None = Field(None, gt=0, le=0.1)  # relative tolerance of Model Exchange
    start_timeout: float = Field(60.0, gt=0, le=3600)  # [s] wall-clock limit
    step_timeout: float = Field(10.0, gt=0, le=3600)  # [s] wall-clock limit

    @model_validator(mode="after")
    def _ends_after_its_start(self) -> Stepping:
        if self.stop_time is not None and self.stop_time <= self.start_time:
            raise ValueError(
                f"stop_time = {self.stop_time:g}: expected more than start_time = "
                f"{self.start_time:g} [s]"
            )
        return self


Parameters = Annotated[dict[str, Value], BeforeValidator(flat)]
"""Start values by variable name, in the FMU's own units."""


def _is_value(value: object) -> bool:
    if isinstance(value, list):
        return all(_is_number(item) for item in value)
    return isinstance(value, bool | str) or _is_number(value)


def _is_number(value: object) -> bool:
    if isinstance(value, int):
        return not isinstance(value, bool) and abs(value) < 1 << 64
    return isinstance(value, float) and isfinite(value)


_Profile = TypeVar("_Profile", bound=StrictTable)


def read_tables(path: Path, what: str, guide: str) -> dict[str, Any]:
    """Return the tables of a profile's TOML file.

    Args:
        path: Path of the file.
        what: Expected contents, in words.
        guide: Place of a guide, for messages.

    Raises:
        FmuProfileError: the file is missing, or not TOML.
    """
    try:
        return tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except FileNotFoundError:
        raise FmuProfileError(f"{path}: no such file; {guide}") from None
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "not UTF-8 text"
        raise FmuProfileError(
            f"{path}: cannot be read ({reason}); expected {what} (TOML)"
        ) from None
    # other errors than TOML's: a number with thousands of digits
    except (ValueError, RecursionError) as error:
        raise FmuProfileError(f"{path}: not valid TOML: {error}; correct this line") from None


def validated(kind: type[_Profile], values: dict[str, Any], origin: str, guide: str) -> _Profile:
    """Return a profile of a kind.

    Args:
        kind: Kind of profile.
        values: Values with the keys of the TOML file.
        origin: Name of the source in errors.
        guide: Description of the keys, for messages.

    Raises:
        FmuProfileError: a key or value cannot be used.
    """
    try:
        return kind.model_validate(values)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        raise FmuProfileError(f"{origin}: {_explained(first, guide)}") from None


def _explained(error: Any, guide: str) -> str:
    *tables, key = (str(part) for part in error["loc"]) if error["loc"] else ("",)
    place = f"[{'.'.join(tables)}] {key}" if tables else f"[{key}]" if key else "profile"
    if error["type"] == "extra_forbidden":
        return f"{place}: unknown key; {guide} lists the keys"
    if error["type"] == "missing":
        return f"{place}: missing; add it ({guide})"
    if error["type"] == "value_error":
        table = ".".join((*tables, key))
        return f"[{table}]: {error['ctx']['error']}" if table else str(error["ctx"]["error"])
    given = printable(repr(error["input"]), 60)
    return f"{place} = {given}: {str(error['msg']).removeprefix('Input ')}"
