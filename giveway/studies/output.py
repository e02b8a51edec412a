"""The tables of a study as files: CSV, each whole, and the data package that describes them."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from giveway.records.columns import Column
from giveway.results.folder import package_of
from giveway.studies.atomic_files import write_whole
from giveway.studies.frames import (
    COMPUTING_COLUMNS,
    EXECUTION_COLUMNS,
    FAILURE_COLUMNS,
    runs_columns,
    written,
)

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
_LONG = frozenset({"comparison", "levels", "situations"})  # these take their time
_DECIMALS = 6
_SIGNIFICANT = frozenset({"p_value", "q_value"})  # of these the first six digits count
_TYPES: dict[str, Any] = {"b": "boolean", "i": "integer", "f": "number"}


def write_tables(study: StudyFolder, *, whole: bool) -> None:
    """Write the tables into the study's folder.

    Args:
        study: whose.
        whole: the comparison too, which takes some seconds.

    Raises:
        ResultsError: the disk is full or not writable.
    """
    names = [name for name in TABLES if whole or name not in _LONG]
    columns = {name: _columns(study, name) for name in names}
    for name in names:
        frame = written(getattr(study, name), columns[name])
        text = _rounded(frame).to_csv(index=False, lineterminator="\n")
        write_whole(study.path / f"{name}.csv", text)
    name = f"giveway-study-{study.definition.name}"
    title = study.definition.description or f"giveway study {study.definition.name}"
    package = package_of(name, title, columns)
    text = json.dumps(package, indent=2, ensure_ascii=False) + "\n"
    write_whole(study.path / PACKAGE, text)


def _columns(study: StudyFolder, name: str) -> Sequence[Column]:
    if name == "runs":
        return runs_columns(study.design)
    if name == "execution":
        return EXECUTION_COLUMNS
    if name == "failures":
        return FAILURE_COLUMNS
    frame: pd.DataFrame = getattr(study, name)
    known = {column.name: column for column in runs_columns(study.design)}
    described = _described(name)
    return [
        described.get(column)
        or known.get(column)
        or Column(column, _TYPES.get(frame[column].dtype.kind, "string"), None, column)
        for column in frame.columns
    ]


def _described(name: str) -> dict[str, Column]:
    from giveway.studies.statistics import COMPARISON_COLUMNS, LEVEL_COLUMNS, SITUATION_COLUMNS

    if name == "levels":
        return {c.name: c for c in LEVEL_COLUMNS}

    counts = (
        Column("runs", "integer", None, "runs of the cell that are there"),
        Column("failed", "integer", None, "of these without a result"),
    )
    return {
        c.name: c for c in (*counts, *COMPUTING_COLUMNS, *COMPARISON_COLUMNS, *SITUATION_COLUMNS)
    }


def _rounded(frame: pd.DataFrame) -> pd.DataFrame:
    """Floats to six decimals, probabilities to six digits; no negative zeros."""
    frame = frame.copy()
    for name in frame.columns:
        if frame[name].dtype != np.float64:
            continue
        values = frame[name].to_numpy()
        if name in _SIGNIFICANT:
            frame[name] = [float(f"{value:.6g}") for value in values]
        else:
            frame[name] = np.round(values, _DECIMALS) + 0.0
    return frame
