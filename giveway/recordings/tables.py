"""The rows of a file of tracks as a table of text or numbers, for each format of files."""

import json
import warnings
from collections.abc import Callable, Iterator, Mapping
from itertools import chain
from math import inf
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from pandas.errors import ParserWarning

from giveway.errors import DatasetError
from giveway.recordings.dataset import TrackTable

_FARTHEST = 1e7  # Largest number in a column; a place in UTM [m] has less
_TEXTS = frozenset({"id", "kind"})
_SHOWN = 40  # Number of characters of a wrong value in a message
# Number of lines of a file before its first row
LINES_BEFORE = {"csv": 2, "text": 1}


def read_table(file: Path, table: TrackTable) -> pd.DataFrame:
    """Return the rows of a file under giveway's names: texts id and kind, numbers else.

    Args:
        file: File of the data set.
        table: Description of its format and columns.

    Raises:
        DatasetError: the file cannot be read, or a column, row or number is not as it should be.
    """
    raw = _raw(file, table)
    given = table.columns.given
    missing = [name for name in given.values() if name not in raw.columns]
    if missing:
        expected = ",".join(given.values())
        raise DatasetError(f"{file}: column '{missing[0]}' is missing; expected {expected}")
    if raw.empty:
        raise DatasetError(f"{file}: no rows; take the file from the dataset again")
    line = LINES_BEFORE.get(table.format)
    return pd.DataFrame(
        {
            name: _texts(file, raw[column], column, line, name)
            if name in _TEXTS
            else _numbers(file, raw[column], column, line, name)
            for name, column in given.items()
            if not (name == "time" and table.columns.frame)
        }
    )


def read_csv(file: Path) -> pd.DataFrame:
    """Return the rows of a CSV file as texts.

    Raises:
        DatasetError: the file cannot be read.
    """
    return _reading(file, "CSV", lambda: pd.read_csv(file, dtype=str, keep_default_na=False))


def _raw(file: Path, table: TrackTable) -> pd.DataFrame:
    if table.format == "csv" and not table.header:
        return read_csv(file)
    if table.format in {"csv", "text"}:
        split = "," if table.format == "csv" else r"\s+"
        names = list(table.header)
        return _reading(
            file,
            "text in columns",
            lambda: pd.read_csv(
                file,
                sep=split,
                header=None,
                names=names,
                index_col=False,
                comment="#",
                dtype=str,
                keep_default_na=False,
            ),
        )
    if table.format == "parquet":
        return _reading(file, "Parquet", lambda: _parquet(file))
    rows = _json_rows if table.format == "json" else _xml_rows
    return _reading(file, table.format.upper(), lambda: pd.DataFrame(list(rows(file, table))))


def _reading(file: Path, what: str, read: Callable[[], pd.DataFrame]) -> pd.DataFrame:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", ParserWarning)  # rows longer than the header
            return read()
    # errors of pandas, JSON, Unicode and Parquet are ValueErrors
    except (OSError, ValueError, ElementTree.ParseError, RecursionError, ParserWarning) as error:
        told = isinstance(error, OSError) and error.strerror
        reason = told or (str(error).splitlines() or [type(error).__name__])[0]
        raise DatasetError(
            f"{file}: cannot be read as {what} ({reason}); take the file from the dataset again"
        ) from error


def _parquet(file: Path) -> pd.DataFrame:
    try:
        return pd.read_parquet(file)
    except ImportError:
        raise DatasetError(
            f"{file}: Parquet needs pyarrow, which is not installed; pip install 'giveway[parquet]'"
        ) from None


def _json_rows(file: Path, table: TrackTable) -> Iterator[dict[str, Any]]:
    """Return the rows below the table's key, with all that stands beside them."""
    content = json.loads(file.read_text(encoding="utf-8"))
    key = table.rows[0] if table.rows else ""
    rows = content.get(key) if isinstance(content, dict) else None
    if not isinstance(rows, dict | list):
        raise ValueError(f"key '{key}' is missing; expected a table of rows")
    beside = dict(_flat({name: value for name, value in content.items() if name != key}))
    for row in rows.values() if isinstance(rows, dict) else rows:
        yield beside | dict(_flat(row))


def _flat(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Return the leaves of a JSON value, under names like ``coordinates.0``."""
    if isinstance(value, Mapping | list):
        items = value.items() if isinstance(value, Mapping) else enumerate(value)
        yield from chain.from_iterable(
            _flat(child, f"{path}.{key}" if path else str(key)) for key, child in items
        )
    else:
        yield path, value


def _xml_rows(file: Path, table: TrackTable) -> Iterator[dict[str, str]]:
    """Return the attributes of the named elements, and those of the element around each."""
    around: list[ElementTree.Element] = []
    for event, element in ElementTree.iterparse(file, events=("start", "end")):
        if event == "start":
            around.append(element)
            continue
        around.pop()
        if element.tag in table.rows and around:
            yield {**around[-1].attrib, **element.attrib, "element": element.tag}
        elif len(around) == 1:
            around[0].clear()  # the file may be larger than the memory


def _texts(
    file: Path, column: "pd.Series[Any]", name: str, head: int | None, ours: str
) -> "pd.Series[str]":
    """Return a column as texts; an id is neither empty nor an infinite number."""
    texts = column.astype(str).str.strip()
    if ours == "id":
        infinite = np.isinf(pd.to_numeric(texts, errors="coerce").to_numpy(dtype=np.float64))
        bad = (column.isna() | (texts == "")).to_numpy() | infinite
        require_good(file, column, name, head, bad, "a word or a finite number")
    return texts


def _numbers(
    file: Path, column: "pd.Series[Any]", name: str, head: int | None, ours: str
) -> NDArray[np.float64]:
    """Return a column as finite numbers."""
    whole = ours == "frame"
    largest = {"frame": 1e9, "time": inf}.get(ours, _FARTHEST)
    values = pd.to_numeric(column, errors="coerce").to_numpy(dtype=np.float64)
    with np.errstate(invalid="ignore"):
        bad = ~(np.abs(values) <= largest) | np.isinf(values)
        bad |= whole & (values != np.floor(values))
    require_good(file, column, name, head, bad, "a whole number" if whole else "a finite number")
    return values


def require_good(
    file: Path,
    column: "pd.Series[Any]",
    name: str,
    head: int | None,
    bad: NDArray[np.bool_],
    expected: str,
) -> None:
    """Make sure that no value of a column is bad.

    Args:
        file: File of the data set.
        column: Values as they stand in it.
        name: Name of the column.
        head: Number of lines before the first row, plus one; None if the file has no lines.
        bad: True where a value is bad.
        expected: Description of good values.

    Raises:
        DatasetError: one is; the message names the first one.
    """
    if bad.any():
        row = int(bad.argmax())
        place = f"row {row + 1}" if head is None else f"line {row + head}"
        raise DatasetError(
            f"{file}: {place}: {name} = {str(column.iloc[row])[:_SHOWN]!r}: expected {expected}; "
            "correct it, or take the file from the dataset again"
        )
