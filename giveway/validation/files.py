"""The files of a comparison: tables as CSV, and each picture as PNG and SVG."""

from collections.abc import Iterable, Mapping
from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

from giveway.errors import ResultsError
from giveway.figures.style import save_figure

_SUFFIXES = (".png", ".svg")
_DECIMALS = 6


def names_of(tables: Iterable[str], pictures: Iterable[str]) -> frozenset[str]:
    """Return the names of all files that :func:`write_files` writes."""
    return frozenset({*tables, *(name + suffix for name in pictures for suffix in _SUFFIXES)})


def write_files(
    folder: Path, tables: Mapping[str, pd.DataFrame], pictures: Mapping[str, Figure]
) -> None:
    """Write tables by their file names, and pictures by their names without a suffix.

    Raises:
        ResultsError: a file cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, table in tables.items():
            table.round(_DECIMALS).to_csv(folder / name, index=False, lineterminator="\n")
        for name, figure in pictures.items():
            for suffix in _SUFFIXES:
                save_figure(figure, folder / f"{name}{suffix}")
    except OSError as error:
        raise ResultsError(
            f"{folder}: cannot be written ({error.strerror}); name another folder with --out"
        ) from error
