"""The table of the benchmark in a terminal: a block per scene and people, close passes first."""

from collections.abc import Mapping
from typing import Any

import pandas as pd
from rich.console import Console

from giveway.cli.screen.printing import escape
from giveway.cli.screen.study_levels import print_level_table
from giveway.reports.tables.level_table import LevelTable, Mean, Row
from giveway.studies.benchmark import RECORDED, VERSION, texts

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
    return Row(context, f"{row['controller']}{mark}", tuple(map(Mean, texts(row))))
