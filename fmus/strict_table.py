"""The base of every table that is read from TOML: `true` is no number in it."""

from collections.abc import Iterator, Mapping
from typing import Any, Final, LiteralString, get_args

from pydantic import BaseModel, ConfigDict, ValidationInfo, field_validator
from pydantic_core import PydanticCustomError

NO_TRUTH: Final[LiteralString] = "should be a number, not true or false"
"""Expectation where true or false stands for a number."""


class StrictTable(BaseModel):
    """A table of a TOML file: frozen, with finite numbers only; unknown keys are refused."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    @field_validator("*", mode="before")
    @classmethod
    def _no_truth_as_number(cls, value: Any, info: ValidationInfo) -> Any:
        """Refuse true and false where numbers are expected; pydantic reads them as 1 and 0."""
        if is_truth_for_number(value, cls.model_fields[str(info.field_name)].annotation):
            raise PydanticCustomError("number", NO_TRUTH)
        return value


def is_truth_for_number(value: Any, annotation: Any) -> bool:
    """Return whether true or false stands where an annotation expects numbers only."""
    if not any(isinstance(part, bool) for part in _parts(value)):
        return False
    types = set(_types(annotation))
    return bool(types & {int, float}) and bool not in types


def _parts(value: Any) -> Iterator[Any]:
    """Yield a value, or the values in a list or table, at any depth."""
    if not isinstance(value, list | tuple | Mapping):
        yield value
        return
    for part in value.values() if isinstance(value, Mapping) else value:
        yield from _parts(part)


def _types(annotation: Any) -> Iterator[type]:
    """Yield the types that an annotation is composed of."""
    if isinstance(annotation, type):
        yield annotation
    for argument in get_args(annotation):
        yield from _types(argument)
