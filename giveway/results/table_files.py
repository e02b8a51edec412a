"""The writing of tables, also of those that are too long for the memory, piece by piece."""

import contextlib
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from giveway.errors import ResultsError
from giveway.results.json_text import DECIMALS
from giveway.results.names import LONGEST

if TYPE_CHECKING:
    import pandas as pd

_GZIP = {"method": "gzip", "compresslevel": 6, "mtime": 0}  # no time, so that equal runs are equal
_FINE = 2.0**20  # Parquet's numbers are multiples of 1 / _FINE: six decimals are as in CSV


def require_parquet() -> None:
    """Make sure, before anything is computed, that Parquet can be written.

    Raises:
        ResultsError: pyarrow is missing.
    """
    try:
        import pyarrow  # noqa: F401
    except ImportError as error:
        raise ResultsError(
            "--parquet needs pyarrow; install it with: pip install 'giveway[parquet]'"
        ) from error


def _rounded(frame: "pd.DataFrame") -> "pd.DataFrame":
    """Return the frame with floats of six decimals and no negative zeros: equal on every system."""
    frame = frame.copy()
    for name in frame.columns:
        if frame[name].dtype == np.float64:
            frame[name] = np.round(frame[name].to_numpy(), DECIMALS) + 0.0
    return frame


def write_csv(pieces: "Callable[[], Iterable[pd.DataFrame]]", path: Path) -> None:
    """Write the rows that come in pieces; each is a member of its own in a .gz file."""
    for number, frame in enumerate(pieces()):
        _rounded(frame).to_csv(
            path,
            index=False,
            header=not number,
            mode="a" if number else "w",
            lineterminator="\n",
            compression=_GZIP if path.suffix == ".gz" else None,
        )


def write_parquet(pieces: "Callable[[], Iterable[pd.DataFrame]]", path: Path) -> None:
    """Write the rows that come in pieces, each as a row group.

    The longest table's numbers are rounded to binary digits: decimal ones cannot be compressed.
    """
    import pyarrow
    import pyarrow.parquet

    with contextlib.ExitStack() as stack:
        writer, schema, floats = None, None, list[str]()
        for frame in pieces():
            frame = _rounded(frame)
            names = list(map(str, frame))
            if writer is None:
                floats = [name for name in names if frame[name].dtype == np.float64]
                floats = floats if path.stem == LONGEST else []
            for name in floats:
                frame[name] = np.round(frame[name].to_numpy() * _FINE) / _FINE
            table = pyarrow.Table.from_pandas(frame, schema=schema, preserve_index=False)
            if writer is None:
                schema = table.schema
                rest = [name for name in names if name not in floats]
                writer = stack.enter_context(
                    pyarrow.parquet.ParquetWriter(
                        path,
                        schema,
                        compression="zstd",
                        use_dictionary=rest,
                        column_encoding=dict.fromkeys(floats, "BYTE_STREAM_SPLIT") or None,
                    )
                )
            writer.write_table(table)
