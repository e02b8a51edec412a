"""Rows and tables as pandas' tables, which is imported late."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from giveway.run_data.columns import Column

if TYPE_CHECKING:
    import pandas as pd


def stacked(
    tables: "list[pd.DataFrame]", names: list[str], by: str | None = None
) -> "pd.DataFrame":
    """Return the tables one below the other, with the columns ``names``, sorted by ``by``."""
    import pandas as pd

    if not tables:
        return pd.DataFrame(columns=names)
    table = tables[0] if len(tables) == 1 else pd.concat(tables, ignore_index=True)
    if by is not None and len(tables) > 1:
        table = table.sort_values(by, kind="stable", ignore_index=True)
    return table[names]


def framed(rows: Sequence[Any], columns: Sequence[Column]) -> "pd.DataFrame":
    """Return rows as a table with these columns."""
    import pandas as pd

    return pd.DataFrame(rows, columns=[column.name for column in columns])
