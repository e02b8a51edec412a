"""The declaration of an option: unit, bounds, and the conversion of values from files and flags."""

import math
import shlex
from collections.abc import Callable
from typing import Annotated, Any, Final, Literal, Protocol, TypeVar, get_args

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    JsonValue,
    ValidationError,
    ValidationInfo,
    field_validator,
)
from pydantic.fields import FieldInfo
from pydantic_core import PydanticCustomError

from fmus.strict_table import StrictTable
from giveway.errors import in_words

_TOO_SMALL = "least"
_OUT_OF_RANGE = frozenset(
    {_TOO_SMALL, "greater_than", "greater_than_equal", "less_than", "less_than_equal"}
)


def option(
    default: Any,
    unit: str | None,
    description: str,
    *,
    flag: str | None = None,
    least: float | None = None,
    because: str | tuple[str, str] | None = None,
    **bounds: Any,
) -> Any:
    """Declare an option with its documentation.

    Args:
        default: Value if it is not set.
        unit: Unit of a quantity.
        description: Meaning of the option.
        flag: Name on the command line, if the derived one is clumsy.
        least: Smallest positive value that makes sense; a bound says whether 0 is allowed.
        because: Reason why values outside of ``least`` and ``bounds`` make no sense; or two, of
            values that are too small and too large.
        bounds: Bounds as for a pydantic field.
    """
    reasons: list[JsonValue] = [because, because] if not isinstance(because, tuple) else [*because]
    extra: dict[str, JsonValue] = {"unit": unit, "flag": flag, "least": least, "because": reasons}
    return Field(default, description=description, json_schema_extra=extra, **bounds)


def declared(field: FieldInfo) -> dict[str, Any]:
    """Return the declarations of :func:`option` beside the field: unit, flag, least, because."""
    extra = field.json_schema_extra
    return dict(extra) if isinstance(extra, dict) else {}


def expectation(error: Any, field: FieldInfo) -> str:
    """Return what was expected instead of a refused value: range, unit, reason, meaning.

    Args:
        error: One error of a ``ValidationError``.
        field: Field of the option.
    """
    extra = declared(field)
    expected = in_words(error)
    if error["type"] in {"missing", "too_long"}:  # errors of a tuple's values
        expected = f"expected {len(get_args(field.annotation))} values"
    unit = f" [{extra['unit']}]" if extra.get("unit") else ""
    out_of_range = error["type"] in _OUT_OF_RANGE and not _is_sign_wrong(error, field)
    too_small, too_large = extra.get("because", (None, None))
    reason = too_large if error["type"].startswith("less") else too_small
    because = f": {reason}" if out_of_range and reason else ""
    return f"{expected}{unit}{because} ({field.description})"


def _is_sign_wrong(error: Any, field: FieldInfo) -> bool:
    """Return whether the sign alone is wrong: the reason of a field is then that of its maximum."""
    crossed = error.get("ctx", {})
    above_zero = crossed.get("ge", crossed.get("gt")) == 0
    return above_zero and any(hasattr(bound, "le") for bound in field.metadata)


def is_number(value: object) -> bool:
    """Return whether a value of a TOML file is a finite number."""
    number = isinstance(value, int | float) and not isinstance(value, bool)
    return number and math.isfinite(value)  # type: ignore[arg-type]


def problem_of_name(name: str) -> str:
    """Return what is wrong with a name that a user gives and tables show; empty if nothing is."""
    if name.startswith(("=", "+", "-", "@", "\t", "\r")):
        return "should not begin with =, +, -, @ or a tab: spreadsheets take it for a formula"
    return ""


def _name(value: str) -> str:
    if problem := problem_of_name(value):
        raise PydanticCustomError("name", "{expected}", {"expected": problem})
    return value


def _split(value: Any) -> Any:
    """Return a comma-separated flag value as the list that a TOML file would hold."""
    return [part.strip() for part in value.split(",")] if isinstance(value, str) else value


def _words(value: Any) -> Any:
    """Return options for SUMO that are written as in a shell."""
    if not isinstance(value, str):
        return value
    try:
        return shlex.split(value)
    except ValueError as error:
        msg = f"expected options as in a shell, like '--emission-output e.xml' ({error})"
        raise PydanticCustomError("shell", "{expected}", {"expected": msg}) from None


def _text(value: Any) -> Any:
    """Return a number as the text that is expected, such as a radius in a TOML file."""
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return f"{value:.12g}" if is_number else value


PRESET_NAMES: Final = ("SIM", "TABLE2", "MIXED", "CITR", "DUT")
"""The presets of the VCI model, named here since to import the model takes time."""

DEFAULT_PRESET: Final = "MIXED"
"""The preset of people unless the user or the controller names another one."""


def _preset(value: str) -> str:
    """Return a name or file of the model's parameters; the file is read when it is needed."""
    if value in {"", *PRESET_NAMES} or value.endswith(".toml"):
        return value
    msg = (
        f"expected {', '.join(PRESET_NAMES)} or a preset file (.toml; giveway calibrate writes one)"
    )
    raise PydanticCustomError("preset", "{expected}", {"expected": msg})


def _seed(value: Any) -> Any:
    return int(value) if isinstance(value, str) and value.isdecimal() else value


def _speed_or_lane(value: Any) -> Any:
    """Return a number or the word "lane"; any other value is an error that names both."""
    try:
        return value if value == LANE or isinstance(value, bool) else float(value)
    except (TypeError, ValueError):
        msg = f"expected a number or '{LANE}'"
        raise PydanticCustomError("speed", "{expected}", {"expected": msg}) from None


def _time_or_window(value: Any) -> Any:
    """Return a time, or the earliest and the latest time; any other value is an error."""
    times = value.split(",") if isinstance(value, str) else value
    is_window = isinstance(times, list | tuple) and len(times) != 1
    try:
        read = [float(time) for time in (times if isinstance(times, list | tuple) else [times])]
    except (TypeError, ValueError):
        read = []
    count = 2 if is_window else 1
    if isinstance(value, bool) or len(read) != count or not 0.0 <= read[0] <= read[-1] <= _LATEST:
        msg = f"expected a time, or the earliest and the latest one, from 0 to {_LATEST:g}"
        raise PydanticCustomError("time", "{expected}", {"expected": msg})
    return tuple(read) if is_window else read[0]


_LATEST = 1e7  # Largest time [s]; beyond it a millisecond is lost in rounding

LANE: Literal["lane"] = "lane"
"""Word in place of a speed: the limit of the ego's lane."""


SpeedOrLane = Annotated[
    Annotated[float, Field(gt=0, le=60)] | Literal["lane"], BeforeValidator(_speed_or_lane)
]


TimeOrWindow = Annotated[float | tuple[float, float], BeforeValidator(_time_or_window)]


Rectangle = Annotated[tuple[float, float, float, float], BeforeValidator(_split)]


Displacement = Annotated[tuple[float, float], BeforeValidator(_split)]


Name = Annotated[str, AfterValidator(_name)]
"""A name that a user gives and tables show."""


NameList = Annotated[tuple[str, ...], BeforeValidator(_split)]


TextOrNumber = Annotated[str, BeforeValidator(_text)]


Preset = Annotated[str, AfterValidator(_preset)]


OptionList = Annotated[tuple[str, ...], BeforeValidator(_words)]


SumoOutput = Literal["fcd", "tripinfo", "ssm", "summary"]
SumoOutputs = Annotated[tuple[SumoOutput, ...], BeforeValidator(_split)]


SumoSeed = Annotated[
    Annotated[int, Field(ge=0, le=2**31 - 1)] | Literal["scenario", "run"], BeforeValidator(_seed)
]


class Section(StrictTable):
    """A table of the configuration, whose defaults are checked, too."""

    model_config = ConfigDict(validate_default=True)

    @field_validator("*", mode="after")
    @classmethod
    def _large_enough(cls, value: Any, info: ValidationInfo) -> Any:
        field = cls.model_fields[str(info.field_name)]
        least = declared(field).get("least")
        if least is not None and isinstance(value, int | float) and 0 < value < least:
            zero = any(getattr(bound, "ge", None) == 0 for bound in field.metadata)
            expected = f"should be {'0, or ' if zero else ''}at least {least:g}"
            raise PydanticCustomError(_TOO_SMALL, "{expected}", {"expected": expected})
        return value


class NamedTable(Protocol):
    """A table of an array of tables, which has a name."""

    @property
    def name(self) -> str:
        """The name of the table."""
        ...


_Table = TypeVar("_Table", bound=NamedTable)
_Model = TypeVar("_Model", bound=BaseModel)


def read_tables(
    value: Any, kind: type[_Table], what: str, heading: str, read: Callable[[Any, int], _Table]
) -> tuple[_Table, ...]:
    """Read the tables of an array in a TOML file or a dictionary, each with a name of its own.

    Args:
        value: Tables, as dictionaries or as they are read.
        kind: Class of a table, with the attribute ``name``.
        what: Key of the array, for messages.
        heading: Heading of a table, for messages.
        read: Function that reads one dictionary, given its index.

    Raises:
        ValueError: a table is not valid; the message names it.
    """
    if not isinstance(value, list | tuple) or not all(isinstance(t, dict | kind) for t in value):
        raise ValueError(f"{what} = {value!r}: expected tables, each headed {heading}")
    tables = [t if isinstance(t, kind) else read(t, number) for number, t in enumerate(value)]
    names = [table.name for table in tables]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"{what} '{name}': two have this name; give each its own")
    return tuple(tables)


def reader_of_named(kind: type[_Model], what: str) -> Callable[[dict[str, Any], int], _Model]:
    """Return the function that reads one table of an array; without a name it gets its number.

    Args:
        kind: Class of a table, with the attribute ``name``.
        what: Word for a table, in messages and in names.
    """

    def read(entry: dict[str, Any], number: int) -> _Model:
        name = entry.get("name") or f"{what}{number}"
        try:
            return kind.model_validate({**entry, "name": name})
        except ValidationError as error:
            first: Any = error.errors(include_url=False)[0]
            raise ValueError(f"{what} '{name}': {_explained(kind, first)}") from None

    return read


def _explained(kind: type[BaseModel], error: Any) -> str:
    """Return one line on pydantic's error in a table."""
    if not error["loc"]:  # its values do not fit each other
        return str(error["ctx"]["error"])
    key = str(error["loc"][0])
    field = kind.model_fields.get(key)
    if field is None:
        return f"unknown key '{key}'; expected one of {', '.join(kind.model_fields)}"
    if error["type"] == "missing":
        return f"{key} is missing ({field.description})"
    return f"{key} = {error['input']!r}: {expectation(error, field)}"
