"""Tables of scripts as Markdown, so that pages take them over as they are printed."""

from __future__ import annotations

import pandas as pd


def markdown(table: pd.DataFrame, digits: int = 1) -> str:
    """A table as Markdown: missing numbers are empty, and a first name that repeats stands once.

    Args:
        table: Table.
        digits: Digits behind the point of numbers that are not whole.
    """
    texts = table.map(lambda value: _text(value, digits))
    first = texts.iloc[:, 0]
    texts.isetitem(0, first.mask(first == first.shift(), ""))
    rows = [list(map(str, table.columns)), *texts.to_numpy().tolist()]
    lines = [f"| {' | '.join(row)} |".replace("|  |", "| |") for row in rows]
    return "\n".join([lines[0], "|" + "---|" * len(table.columns), *lines[1:]])


def _text(value: object, digits: int) -> str:
    if not isinstance(value, float):
        return str(value)
    return "" if value != value else f"{value:.{digits}f}"
