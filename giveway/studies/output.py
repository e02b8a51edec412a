"""The tables of a study as CSV files, and the data package that describes them."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from giveway.records.columns import Column
from giveway.results.folder import package_of
from giveway.studies.atomic_files import write_atomically
from giveway.studies.columns import COMPARISON_COLUMNS, LEVEL_COLUMNS, SITUATION_COLUMNS
from giveway.studies.frames import (
    COMPUTING_COLUMNS,
    EXECUTION_COLUMNS,
    FAILURE_COLUMNS,
    as_written,
    runs_columns,
)
from giveway.studies.statistics.rounding import tabulated

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd

    from giveway.studies.folder import StudyFolder

TABLES = (
    "runs",
    "cells",
    "levels",
    "comparison",
    "situations",
    "execution",
    "computing",
    "failures",
)
PACKAGE = "datapackage.json"
_LONG = frozenset({"comparison", "levels", "situations"})  # these take some seconds
_COUNTS = (
    Column("runs", "integer", None, "runs of the cell that are there"),
    Column("failed", "integer", None, "of these without a result"),
)
_COUNTED = (*_COUNTS, *COMPUTING_COLUMNS, *COMPARISON_COLUMNS, *SITUATION_COLUMNS)
_DESCRIBED: dict[str, tuple[Column, ...]] = {"levels": LEVEL_COLUMNS}
_TYPES: dict[str, Any] = {"b": "boolean", "i": "integer", "f": "number"}


def write_tables(study: StudyFolder, *, whole: bool) -> None:
    """Write the tables into the study's folder.

    Args:
        study: its folder.
        whole: also those tables that take some seconds to compute.

    Raises:
        ResultsError: the disk is full or not writable.
    """
    names = [name for name in TABLES if whole or name not in _LONG]
    columns = {name: _columns(study, name) for name in names}
    for name in names:
        frame = as_written(getattr(study, name), columns[name])
        floats = [column for column in frame.columns if frame[column].dtype == np.float64]
        text = tabulated(frame, floats).to_csv(index=False, lineterminator="\n")
        write_atomically(study.path / f"{name}.csv", text)
    name = f"giveway-study-{study.definition.name}"
    title = study.definition.description or f"giveway study {study.definition.name}"
    package = package_of(name, title, columns)
    text = json.dumps(package, indent=2, ensure_ascii=False) + "\n"
    write_atomically(study.path / PACKAGE, text)


def _columns(study: StudyFolder, name: str) -> Sequence[Column]:
    if name == "runs":
        return runs_columns(study.design)
    if name == "execution":
        return EXECUTION_COLUMNS
    if name == "failures":
        return FAILURE_COLUMNS
    frame: pd.DataFrame = getattr(study, name)
    known = {column.name: column for column in runs_columns(study.design)}
    described = {column.name: column for column in _DESCRIBED.get(name, _COUNTED)}
    return [
        described.get(column)
        or known.get(column)
        or Column(column, _TYPES.get(frame[column].dtype.kind, "string"), None, column)
        for column in frame.columns
    ]
