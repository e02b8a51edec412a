"""Impact speeds that were measured elsewhere, as on a test track: they verify a table's colours."""

import csv
from math import isfinite
from pathlib import Path

from giveway.errors import ConfigError
from giveway.ncap.plan import HOLDER
from giveway.ncap.protocol import Protocol
from giveway.ncap.rating import Key

COLUMNS = ("test", "hit_point", "speed", "relative_speed")
"""Columns of the file; others are ignored."""


def read_measured(file: Path, protocol: Protocol) -> dict[Key, float]:
    """Read measured impact speeds [km/h] by cell, relative to the dummy; 0 is no impact.

    A table of ``giveway ncap`` is read as well: rows of other drivers, without a person or without
    a result are passed over.

    Raises:
        ConfigError: the file cannot be read, or names a cell that the protocol does not have.
    """
    try:
        with file.open(encoding="utf-8-sig", newline="") as lines:
            rows = list(csv.DictReader(lines))
    except (OSError, ValueError, csv.Error) as error:
        reason = error.strerror if isinstance(error, OSError) else "not a CSV file in UTF-8"
        raise ConfigError(
            f"{file}: cannot be read ({reason}); expected measured impact speeds with the columns "
            f"{', '.join(COLUMNS)}"
        ) from None
    cells = {cell.key for cell in protocol.cells}
    tests = {test.name for test in protocol.tests}
    found: dict[Key, float] = {}
    for number, row in enumerate(rows, start=2):
        place = f"{file}: line {number}"
        for column in COLUMNS:
            if row.get(column) is None:
                raise ConfigError(f"{place}: no {column}; expected {', '.join(COLUMNS)}")
        if row.get("driver", HOLDER) != HOLDER or row["test"] == "nobody":
            continue
        if row["relative_speed"] == "":
            continue
        key = row["test"], int(_number(row, "hit_point", place)), int(_number(row, "speed", place))
        if key not in cells:
            raise ConfigError(
                f"{place}: {key[0]} {key[1]} % {key[2]} km/h: no cell of {protocol.title}; "
                f"expected a test of {', '.join(sorted(tests))} at one of its hit points and speeds"
            )
        found[key] = _number(row, "relative_speed", place)
    return found


def _number(row: dict[str, str], column: str, place: str) -> float:
    try:
        value = float(row[column])
    except ValueError:
        value = -1.0
    if not (isfinite(value) and value >= 0.0):
        raise ConfigError(f"{place}: {column} = {row[column]!r}: expected a number, 0 or above")
    return value
