"""``[[crowd.flow]]``: streams of people from one place to another, in persons per hour."""

from __future__ import annotations

from typing import Annotated, Any, Final

from pydantic import BeforeValidator, ConfigDict, Field, ValidationError, model_validator
from pydantic_core import PydanticCustomError

from giveway.config.option import Name, Section, expectation, is_number, option, read_tables
from giveway.config.tables.people import SHARE, PeopleConfig

_FARTHEST = 1e7  # Largest coordinate [m]; beyond it a millimetre is lost in rounding
_SHORTEST = 0.01  # Smallest side of a rectangle or length of a line [m]
# Longest time [s] before the run's beginning for which a flow may have run
_LONGEST_BEFORE: Final = 3600.0
_MOST = 100  # Largest number of flows

Point = tuple[float, float]
Line = tuple[Point, Point]
Box = tuple[float, float, float, float]
Place = Point | Line | Box
"""A point x, y, a line between two points, or a rectangle x_min, y_min, x_max, y_max, all in
[m]."""


def is_line(place: Place) -> bool:
    """Return whether a place is a line."""
    return not isinstance(place[0], int | float)


def _refused(expected: str) -> PydanticCustomError:
    return PydanticCustomError("place", "{expected}", {"expected": expected})


def _point(value: Any) -> Point | None:
    """Return ``value`` as a point, or None if it is none."""
    if not isinstance(value, list | tuple) or len(value) != 2:
        return None
    if not all(is_number(c) and abs(c) <= _FARTHEST for c in value):
        return None
    return float(value[0]), float(value[1])


def _line(value: Any) -> Line | None:
    """Return ``value`` as a line, or None if it is none."""
    ends = [_point(end) for end in value] if isinstance(value, list | tuple) else []
    if len(ends) != 2 or ends[0] is None or ends[1] is None:
        return None
    if max(abs(a - b) for a, b in zip(*ends, strict=True)) < _SHORTEST:
        raise _refused(f"expected two ends, {_SHORTEST:g} apart or more")
    return ends[0], ends[1]


def _box(value: Any) -> Box | None:
    """Return ``value`` as a rectangle, or None if it is none."""
    if not isinstance(value, list | tuple) or len(value) != 4:
        return None
    if not all(is_number(c) and abs(c) <= _FARTHEST for c in value):
        return None
    x_min, y_min, x_max, y_max = map(float, value)
    if x_max - x_min < _SHORTEST or y_max - y_min < _SHORTEST:
        raise _refused(f"expected x_min < x_max and y_min < y_max, {_SHORTEST:g} apart or more")
    return x_min, y_min, x_max, y_max


def _origin(value: Any) -> Place:
    """Return the place that people come from, which has room for several people."""
    found = _line(value) or _box(value)
    if found is None:
        raise _refused("expected a line or a rectangle")
    return found


def _destination(value: Any) -> Place:
    """Return the place that people go to."""
    found = _point(value) or _line(value) or _box(value)
    if found is None:
        raise _refused(
            "expected a point, a line [[x, y], [x, y]] or a rectangle [x_min, y_min, x_max, y_max]"
        )
    return found


def _via(value: Any) -> tuple[Point | Line, ...]:
    """Return the places that people pass, one after the other."""
    places = value if isinstance(value, list | tuple) else [value]
    found = [_point(place) or _line(place) for place in places]
    if not all(found):
        raise _refused("expected a list of points [x, y] and lines [[x, y], [x, y]]")
    return tuple(place for place in found if place)


class FlowConfig(Section):
    """One stream of people, in network coordinates."""

    model_config = ConfigDict(serialize_by_alias=True)

    name: Name = option(
        "",
        None,
        "Name of the flow, of letters and digits. Its people are called name.0, name.1, ...",
        pattern=r"^[A-Za-z0-9_.-]{1,60}$",
    )
    start: Annotated[Line | Box, BeforeValidator(_origin)] = Field(
        alias="from",
        description="Place where people appear: a line [[x, y], [x, y]] or a rectangle [x_min, "
        "y_min, x_max, y_max]",
        json_schema_extra={"unit": "m"},
    )
    to: Annotated[Point | Line | Box, BeforeValidator(_destination)] = Field(
        description="Destination of each person: a point [x, y], or somewhere on a line or in a"
        " rectangle",
        json_schema_extra={"unit": "m"},
    )
    via: Annotated[tuple[Point | Line, ...], BeforeValidator(_via)] = option(
        (), "m", "Points and lines through which people come on the way, in this order"
    )
    rate: float = Field(
        gt=0,
        le=50_000,
        description="Average number of people in an hour",
        json_schema_extra={
            "unit": "persons/h",
            "because": ["a flow has people", "a path 10 m wide carries at most 50,000"],
        },
    )
    begin: float = option(
        0.0,
        "s",
        "Time after the run's start at which the flow begins. Of a flow that began before it, < "
        "0, people are on their way already",
        ge=-_LONGEST_BEFORE,
        le=_FARTHEST,
        because=("no walk takes longer than an hour", "no run takes 1e7 s"),
    )
    end: float | None = option(
        None,
        "s",
        "Time after the run's start at which the flow ends. By default it ends with the run",
        le=_FARTHEST,
    )
    people: PeopleConfig | None = option(
        None, None, "Kinds of people in the flow. By default they are those of [crowd.people]"
    )
    groups: float | None = option(
        None,
        None,
        "Share of the flow's people who walk in groups. By default it is that of [crowd]",
        ge=0,
        le=1,
        because=SHARE,
    )

    @model_validator(mode="after")
    def _ordered(self) -> FlowConfig:
        if self.end is not None and self.end <= self.begin:
            raise ValueError(f"end = {self.end:g}: expected later than begin = {self.begin:g} [s]")
        return self

    def settings(self) -> dict[str, Any]:
        """Return the entries for a table of a TOML file."""
        values: dict[str, Any] = self.model_dump(mode="json", exclude_defaults=True)
        return values


def read_flows(value: Any) -> tuple[FlowConfig, ...]:
    """Read the flows in a TOML file or a dictionary.

    Raises:
        ValueError: a flow is not valid; the message names it.
    """
    if isinstance(value, list | tuple) and len(value) > _MOST:
        raise ValueError(f"{len(value)} flows: expected {_MOST} at most")
    return read_tables(value, FlowConfig, "flow", "[[crowd.flow]]", _read)


def _read(entry: dict[str, Any], number: int) -> FlowConfig:
    name = entry.get("name") or f"flow{number}"
    try:
        return FlowConfig.model_validate({**entry, "name": name})
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        raise ValueError(f"flow '{name}': {_explain(first)}") from None


def _explain(error: Any) -> str:
    """Return one line on pydantic's error in a flow."""
    where = [str(part) for part in error["loc"]]
    keys = {field.alias or name: field for name, field in FlowConfig.model_fields.items()}
    if error["type"] == "value_error":
        return str(error["ctx"]["error"])
    if error["type"] == "missing":
        return f"{where[0]} is missing ({keys[where[0]].description})"
    if error["type"] == "extra_forbidden":
        known = PeopleConfig.model_fields if where[0] == "people" else keys
        return f"unknown key '{where[-1]}'; expected one of {', '.join(known)}"
    field = keys[where[0]]
    if where[0] == "people" and where[-1] in PeopleConfig.model_fields:
        field = PeopleConfig.model_fields[where[-1]]
    return f"{'.'.join(where[:2])} = {error['input']!r}: {expectation(error, field)}"
