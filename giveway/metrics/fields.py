"""What a column of a table means: written once, beside its type, read by the data package."""

from __future__ import annotations

from dataclasses import dataclass
from typing import get_args, get_type_hints

from giveway.records.columns import Column, ColumnType

_TYPES: dict[type, ColumnType] = {
    bool: "boolean",
    int: "integer",
    float: "number",
    str: "string",
}


@dataclass(frozen=True)
class Quantity:
    """The annotation that a column carries where it is declared."""

    unit: str | None
    meaning: str


def columns_of(table: type) -> tuple[Column, ...]:
    """The columns of a class whose every attribute is ``Annotated[type, Quantity(...)]``."""
    columns = []
    for name, hint in get_type_hints(table, include_extras=True).items():
        python_type, quantity = get_args(hint)
        columns.append(Column(name, _TYPES[python_type], quantity.unit, quantity.meaning))
    return tuple(columns)
