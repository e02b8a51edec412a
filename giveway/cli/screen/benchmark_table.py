"""The table of the benchmark in a terminal: a block per scene and people, close passes first."""

import math
from collections.abc import Mapping
from typing import Any

import pandas as pd
from rich.console import Console

from giveway.cli.screen.printing import escape
from giveway.cli.screen.study_levels import print_level_table
from giveway.reports.tables.level_table import LevelTable, Mean, Row
from giveway.studies.benchmark import RECORDED, VERSION

_HEADINGS = (
    ("close", "%"),
    ("moving", "%"),
    ("c/t/n", "a drive"),
    ("delay", "s"),
    ("conflicts", "a drive"),
    ("time", "s"),
    ("hard", "a drive"),
    ("RMS jerk", "m/s^3"),
    ("contacts", "front/side"),
    ("arrived", ""),
)


def print_benchmark(console: Console, table: pd.DataFrame, kept: pd.DataFrame) -> None:
    """Print the rows of the user's controllers, and those of the rivals below them.

    Args:
        console: Console to print on.
        table: Table of the user's controllers.
        kept: Kept rows of the rivals and of recorded drivers.
    """
    driven = dict.fromkeys(zip(table["people"], table["scene"], strict=True))
    rows = [
        _row(f"{scene}: people of {people}", row, mark)
        for people, scene in driven
        for frame, mark in ((table, ""), (kept, " (kept)"))
        for row in frame.to_dict("records")
        if (row["people"], row["scene"]) == (people, scene)
    ]
    rows += [
        _row(str(row["scene"]), row, "")
        for row in kept.to_dict("records")
        if row["controller"] == RECORDED
    ]
    console.print(f"Benchmark {VERSION}, with 95 % intervals", style="bold", highlight=False)
    print_level_table(console, LevelTable(_HEADINGS, tuple(rows), ""))
    others = kept[kept["controller"] != RECORDED]
    made = ", ".join(dict.fromkeys(others["made_with"]))
    console.print(
        "close: people within 4 m who are passed at less than 0.5 m and more than 2 m/s; moving: "
        "of those near an ego above 0.5 m/s; c/t/n: close, tight (0.3 m, 3 m/s) and narrow (0.3 m, "
        "1 m/s) passes; delay: people's; conflicts: serious ones; hard: brakings above 3 m/s².\n"
        f"Kept numbers: {escape(made)}. docs/benchmark.md",
        highlight=False,
    )


def _row(context: str, row: Mapping[Any, Any], mark: str) -> Row:
    passes = (row["close_passes"], row["tight_passes"], row["narrow_passes"])
    texts = (
        _bounded(row, "close_pass_share", 100.0, 1),
        _bounded(row, "close_pass_share_moving", 100.0, 1),
        "/".join(_number(value, 2) for value in passes),
        _bounded(row, "people_delay", 1.0, 2),
        _number(row["conflicts"], 2),
        _bounded(row, "time", 1.0, 1),
        _number(row["hard_brakes"], 2),
        _number(row["rms_jerk"], 2),
        "/".join(_number(row[f"{side}_contacts"], 0) for side in ("frontal", "side")),
        f"{_number(row['arrived'], 0)}/{_number(row['drives'], 0)}",
    )
    return Row(context, f"{row['controller']}{mark}", tuple(Mean(text) for text in texts))


def _bounded(row: Mapping[Any, Any], name: str, scale: float, digits: int) -> str:
    """Return a number with its interval, if it has one."""
    text = _number(scale * row[name], digits)
    low, high = scale * row[f"{name}_low"], scale * row[f"{name}_high"]
    if not math.isfinite(low):
        return text
    return f"{text} [{_number(low, digits)}, {_number(high, digits)}]"


def _number(value: float, digits: int) -> str:
    return f"{value:.{digits}f}" if math.isfinite(value) else "–"
