"""A table of the report, and its cells."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from giveway.reports.wording import number


@dataclass(frozen=True)
class Cell:
    """One cell of a table.

    Attributes:
        text: Text of the cell.
        kind: Style class: number, better, worse, none, na, code.
        link: Link of the text, relative to the report.
    """

    text: str
    kind: str = ""
    link: str = ""


@dataclass(frozen=True)
class Table:
    """A table of the report.

    Attributes:
        name: Id of the table on the page.
        caption: Caption that says what the table shows.
        headings: Headings of the columns.
        rows: Rows, with as many cells as headings.
        filters: Columns with values by which rows can be chosen.
        note: Note beneath the table.
    """

    name: str
    caption: str
    headings: Sequence[str]
    rows: Sequence[Sequence[Cell]]
    filters: tuple[int, ...] = ()
    note: str = ""

    @property
    def numeric(self) -> list[bool]:
        """Flags of the columns that hold numbers."""
        return [
            bool(self.rows) and all(row[k].kind in {"number", "na"} for row in self.rows)
            for k in range(len(self.headings))
        ]


def number_cell(value: float, digits: int = 2) -> Cell:
    """Return a number as a cell, or N.A. if it is missing."""
    return Cell(number(value, digits), "number" if math.isfinite(value) else "na")


def whole_cell(value: object) -> Cell:
    """Return a whole number of any type as a cell."""
    return Cell(f"{int(str(value).partition('.')[0]):,}", "number")


def verdict_cell(verdict: str) -> Cell:
    """Return a verdict as a cell in its colour: better, worse, no difference shown, N.A."""
    kinds = {"better": "better", "worse": "worse"}
    return Cell(verdict, kinds.get(verdict, "none"))
