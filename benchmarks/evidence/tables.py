"""Markdown tables of a study: means of each cell, with signs, sums and paired differences."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal, NamedTuple

import pandas as pd

SIGNS = {"better": " **+**", "worse": " **−**"}


class Column(NamedTuple):
    """A column of a table.

    Attributes:
        metric: Name of a column of summary.csv.
        title: Title with the unit.
        digits: Digits behind the point.
        show: "mean", with a sign where the difference from the baseline is beyond chance;
            "interval", the same with half the 95 % interval; "sum" over all runs; "less", the
            mean paired difference from the baseline and its 95 % interval.
        scale: Factor of the numbers that are shown.
    """

    metric: str
    title: str
    digits: int = 1
    show: Literal["mean", "interval", "sum", "less"] = "mean"
    scale: float = 1.0


FRONTAL = Column("frontal_contacts", "frontal", 0, "sum")
SIDE = Column("side_contacts", "side", 0, "sum")


class Tables:
    """The tables of a study's folder."""

    def __init__(self, folder: Path) -> None:
        self.runs = pd.read_csv(folder / "runs.csv", low_memory=False)
        self.cells = pd.read_csv(folder / "cells.csv")
        self.levels = pd.read_csv(folder / "levels.csv")
        self.situations = pd.read_csv(folder / "comparison.csv")
        self.compared = self.situations[self.situations.situation == "general"]
        names = [c for c in self.cells.columns if c not in {"cell", "ego", "runs", "failed"}]
        self.factors: list[str] = names
        self.context = [name for name in names if name in self.situations.columns]
        self.factor = next(name for name in names if name not in self.context)

    @functools.cached_property
    def _intervals(self) -> pd.DataFrame:
        return self.levels.set_index([*self.factors, "metric"]).sort_index()

    @functools.cached_property
    def _differences(self) -> pd.DataFrame:
        return self.compared.set_index([*self.context, "treatment", "metric"]).sort_index()

    def entry(self, column: Column, cell: Any) -> str:
        """Text of one column of one cell."""
        runs = self.runs.loc[self.runs.cell == cell.cell, column.metric]
        if column.show == "sum":
            return str(int(runs.sum()))
        context = [getattr(cell, name) for name in self.context]
        key = (*context, getattr(cell, self.factor), column.metric)
        difference = self._differences.loc[key] if key in self._differences.index else None
        if column.show == "less":
            return difference_text(difference, column)
        if runs.notna().sum() == 0:
            return "-"
        text = f"{column.scale * runs.mean():.{column.digits}f}"
        if column.show == "interval":
            found = self._intervals.loc[
                (*(getattr(cell, name) for name in self.factors), column.metric)
            ]
            if pd.notna(found.ci_low):
                half = column.scale * (found.ci_high - found.ci_low) / 2
                text += f" ±{half:.{column.digits}f}"
        return text + ("" if difference is None else SIGNS.get(str(difference.verdict), ""))

    def means(self, columns: Sequence[Column]) -> list[str]:
        """Markdown with one line for each cell; a name that repeats stands once."""
        lines = header([*self.factors, *(column.title for column in columns)])
        last: tuple[Any, ...] = ()
        for cell in self.cells.itertuples():
            names = tuple(getattr(cell, name) for name in self.factors)
            same = 0
            while same < len(last) - 1 and last[same] == names[same]:
                same += 1
            shown = [""] * same + [str(name) for name in names[same:]]
            lines.append(row([*shown, *(self.entry(column, cell) for column in columns)]))
            last = names
        return lines


def difference_text(difference: Any, column: Column) -> str:
    """Text of a paired difference with its interval and its sign."""
    if difference is None or pd.isna(difference.mean_difference):
        return ""
    k = column.scale
    text = f"{k * difference.mean_difference:+.{column.digits}f}"
    if pd.notna(difference.ci_low):
        ends = (f"{k * end:+.{column.digits}f}" for end in (difference.ci_low, difference.ci_high))
        text += f" [{', '.join(ends)}]"
    return text + SIGNS.get(str(difference.verdict), "")


def header(titles: Sequence[str]) -> list[str]:
    """The two lines above a table's rows."""
    return [row(titles), "|" + "---|" * len(titles)]


def row(texts: Sequence[str]) -> str:
    """One line of a table."""
    return "| " + " | ".join(texts) + " |"
