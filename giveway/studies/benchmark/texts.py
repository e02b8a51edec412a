"""The numbers of a benchmark's row in words, for the terminal and for pages."""

import math
from collections.abc import Mapping
from typing import Any, Final, NamedTuple

import pandas as pd


class Notation(NamedTuple):
    """The characters between numbers, and those in place of a number that is not there."""

    joint: str = "/"
    of: str = "/"
    missing: str = "–"


TERMINAL: Final = Notation()
"""The notation of narrow columns."""


def texts(row: Mapping[Any, Any], notation: Notation = TERMINAL) -> tuple[str, ...]:
    """Return the numbers of a row.

    Args:
        row: Row of the table.
        notation: Characters between numbers.

    Returns:
        Share of close passes, and of those near a moving ego [%]; close, tight and narrow passes a
        drive; people's delay [s]; serious conflicts a drive; time [s]; hard brakings a drive; RMS
        jerk [m/s^3]; frontal and side contacts; drives that arrived.
    """
    missing = notation.missing
    passes = (row[f"{kind}_passes"] for kind in ("close", "tight", "narrow"))
    contacts = (row[f"{side}_contacts"] for side in ("frontal", "side"))
    drives = (row["arrived"], row["drives"])
    return (
        bounded(row, "close_pass_share", 100.0, missing=missing),
        bounded(row, "close_pass_share_moving", 100.0, missing=missing),
        notation.joint.join(number(value, 2, missing) for value in passes),
        bounded(row, "people_delay", digits=2, missing=missing),
        number(row["conflicts"], 2, missing),
        bounded(row, "time", missing=missing),
        number(row["hard_brakes"], 2, missing),
        number(row["rms_jerk"], 2, missing),
        notation.joint.join(number(value, 0, missing) for value in contacts),
        notation.of.join(number(value, 0, missing) for value in drives),
    )


def bounded(
    row: Mapping[Any, Any],
    name: str,
    scale: float = 1.0,
    digits: int = 1,
    missing: str = TERMINAL.missing,
) -> str:
    """Return a number of a row with its interval, if it has one.

    Args:
        row: Row of the table.
        name: Column of the number.
        scale: Factor on the number.
        digits: Number of digits behind the point.
        missing: Characters in place of a number that is not there.
    """
    text, low, high = (
        number(scale * row[column], digits, missing)
        for column in (name, f"{name}_low", f"{name}_high")
    )
    return text if low == missing else f"{text} [{low}, {high}]"


def number(value: float | None, digits: int, missing: str = TERMINAL.missing) -> str:
    """Return a number with so many digits behind the point, or ``missing`` if there is none."""
    known = value is not None and not pd.isna(value) and math.isfinite(value)
    return f"{value:.{digits}f}" if known else missing
