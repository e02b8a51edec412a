"""The tables of a study as CSV files, and the data package that describes them."""

import json
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from giveway.gate import fingerprint
from giveway.results.folder import package_of
from giveway.run_data.columns import Column
from giveway.studies.folder.atomic_files import write_atomically
from giveway.studies.folder.folder_contents import PACKAGE, SHA256
from giveway.studies.folder.frames import (
    COMPUTING_COLUMNS,
    EXECUTION_COLUMNS,
    FAILURE_COLUMNS,
    as_written,
)
from giveway.studies.folder.sealing import sealed
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.identity import software_identity
from giveway.studies.statistics.rounding import PROBABILITIES, tabulated
from giveway.studies.table_columns import (
    COMPARISON_COLUMNS,
    FRONT_COLUMNS,
    LEVEL_COLUMNS,
    SITUATION_COLUMNS,
)

TABLES = (
    "runs",
    "cells",
    "levels",
    "fronts",
    "comparison",
    "situations",
    "execution",
    "computing",
    "failures",
)
# Tables that take some seconds to compute
_LONG = frozenset({"comparison", "levels", "fronts", "situations"})
_COUNTS = (
    Column("runs", "integer", None, "runs of the cell that are there"),
    Column("failed", "integer", None, "of these without a result"),
)
_COUNTED = (*_COUNTS, *COMPUTING_COLUMNS, *COMPARISON_COLUMNS, *SITUATION_COLUMNS)
_DESCRIBED: dict[str, tuple[Column, ...]] = {"levels": LEVEL_COLUMNS, "fronts": FRONT_COLUMNS}
_TYPES: dict[str, Any] = {"b": "boolean", "i": "integer", "f": "number"}


def write_tables(study: StudyFolder, *, whole: bool) -> None:
    """Write the tables into the study's folder.

    Args:
        study: Folder of the study.
        whole: True to write also the tables that take some seconds to compute.

    Raises:
        ResultsError: the disk is full or not writable.
    """
    names = [name for name in TABLES if whole or name not in _LONG]
    if whole and study.fronts.empty:  # there are no counterfactual runs
        names.remove("fronts")
    name = f"giveway-study-{study.definition.name}"
    title = study.definition.description or f"giveway study {study.definition.name}"
    tables = {name: (getattr(study, name), _columns(study, name)) for name in names}
    write_described(study.path, name, title, tables)


def write_described(
    folder: Path,
    name: str,
    title: str,
    tables: Mapping[str, tuple[pd.DataFrame, Sequence[Column]]],
    probabilities: Collection[str] = PROBABILITIES,
) -> None:
    """Write tables, and the data package that describes and seals them.

    Args:
        folder: Folder of the study or risk.
        name: Name of the data package.
        title: Title of the data package.
        tables: Each table with its columns, by name.
        probabilities: Names of the columns that are rounded as probabilities.

    Raises:
        ResultsError: the disk is full or not writable.
    """
    seals = {}
    for table, (content, columns) in tables.items():
        frame = as_written(content, columns)
        floats = [column for column in frame.columns if frame[column].dtype == np.float64]
        text = tabulated(frame, floats, probabilities).to_csv(index=False, lineterminator="\n")
        write_atomically(folder / f"{table}.csv", text)
        seal = fingerprint(text.encode("utf-8"))
        seals[table] = {"bytes": seal["bytes"], "hash": f"{SHA256}{seal['sha256']}"}
    package = package_of(name, title, {table: columns for table, (_, columns) in tables.items()})
    for resource in package["resources"]:
        resource |= seals[resource["name"]]
    text = json.dumps(sealed(package, software_identity()), indent=2, ensure_ascii=False) + "\n"
    write_atomically(folder / PACKAGE, text)


def _columns(study: StudyFolder, name: str) -> Sequence[Column]:
    if name == "runs":
        return study.runs_columns
    if name == "execution":
        return EXECUTION_COLUMNS
    if name == "failures":
        return FAILURE_COLUMNS
    frame: pd.DataFrame = getattr(study, name)
    known = {column.name: column for column in study.runs_columns}
    described = {column.name: column for column in _DESCRIBED.get(name, _COUNTED)}
    return [
        described.get(column)
        or known.get(column)
        or Column(column, _TYPES.get(frame[column].dtype.kind, "string"), None, column)
        for column in frame.columns
    ]
