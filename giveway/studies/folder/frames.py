"""The tables of a study, made from its records."""

from collections.abc import Iterable, Mapping
from dataclasses import asdict
from typing import Any

import pandas as pd

from giveway.metrics.ego_fields import EGO_FIELDS
from giveway.run_data.columns import Column
from giveway.studies.design import Cell, Design, Level
from giveway.studies.record import CRASHED, RunRecord, run_id

_HEAD = (
    Column("run", "string", None, "id of the run: c2-s17 is cell 2, seed 17"),
    Column("cell", "integer", None, "number of the cell, as in cells.csv"),
    Column("seed", "integer", None, "seed of the crowd; equal in paired runs"),
)
_EGO = (
    Column("ego", "string", None, "SUMO id of the ego; empty without one"),
    Column("ending", "string", None, "why it ended; failed and crashed runs have no numbers"),
)
EXECUTION_COLUMNS = (
    Column("run", "string", None, "id of the run"),
    Column("seconds", "number", "s", "wall clock of the run: set-up, loop, metrics"),
    Column("attempts", "integer", None, "how often it was tried"),
    Column("worker", "string", None, "host and process that made it"),
    Column("memory", "number", "MB", "memory that this process held afterwards"),
    Column("control_median", "number", "ms", "of one control step: prediction and controller"),
    Column("control_max", "number", "ms", "the longest control step but the first"),
    Column("twin", "number", "s", "wall clock of these seconds that the twin took; empty: no twin"),
)
COMPUTING_COLUMNS = (
    Column("seconds", "number", "s", "median wall clock of the cell's runs"),
    Column("control_median", "number", "ms", "median of the runs' median control steps"),
    Column("control_max", "number", "ms", "the longest control step of any of the runs"),
    Column("twin", "number", "s", "median wall clock of the runs' twins; empty: no twins"),
)
FAILURE_COLUMNS = (
    Column("run", "string", None, "id of the run"),
    Column("cell", "integer", None, "number of the cell"),
    Column("seed", "integer", None, "seed of the crowd"),
    Column("ending", "string", None, "failed (an error that was reported) or crashed (it died)"),
    Column("cause", "string", None, "what happened, and where"),
    Column("reproduce", "string", None, "the command that makes the run again"),
)


def runs_columns(design: Design, measured: Iterable[Column] = ()) -> tuple[Column, ...]:
    """Return the columns of ``runs.csv``.

    Args:
        design: Design of the study.
        measured: Columns of metrics of other packages.
    """
    factors = tuple(
        Column(f.name, _type_of(f.levels), f.unit, f"level of the factor {f.name}")
        for f in design.factors
    )
    return (*_HEAD, *factors, *_EGO, *EGO_FIELDS, *measured)


def measured_columns(records: Iterable[RunRecord]) -> tuple[Column, ...]:
    """Return the columns that metrics of other packages have added to the records, each once."""
    return tuple({own.name: own for record in records for own in record.columns}.values())


def _type_of(levels: Iterable[Level]) -> Any:
    kinds = {type(level.value) for level in levels}
    if kinds == {bool}:
        return "boolean"
    if kinds == {int}:
        return "integer"
    return "number" if kinds <= {int, float} else "string"


def runs_frame(records: Iterable[tuple[Cell, int, RunRecord]], design: Design) -> pd.DataFrame:
    """Return ``runs.csv``: one row per run and ego, ordered by cell, seed and ego.

    Args:
        records: Records with the cell and the seed of each.
        design: Design of the study.
    """
    records = list(records)
    measured = measured_columns(record for _, _, record in records)
    numbers = [column.name for column in (*EGO_FIELDS, *measured)]
    rows: list[dict[str, Any]] = []
    for cell, seed, record in records:
        head = {"run": run_id(cell.number, seed), "cell": cell.number, "seed": seed}
        head |= {name: level.value for name, level in cell.levels.items()}
        for row in record.rows or ({"ending": record.ending},):
            known = {name: row[name] for name in numbers if name in row}
            rows.append(head | {"ego": row.get("ego", ""), "ending": row["ending"]} | known)
    columns = runs_columns(design, measured)
    frame = pd.DataFrame(rows, columns=[column.name for column in columns])
    frame = frame.sort_values(["cell", "seed", "ego"], kind="stable", ignore_index=True)
    return _typed(frame, columns)


def _typed(frame: pd.DataFrame, columns: Iterable[Column]) -> pd.DataFrame:
    """Return ``frame`` with typed columns.

    Whole numbers become floats where some are missing (nan).
    """
    plain: dict[str, Any] = {"integer": "int64", "boolean": "bool"}
    for column in columns:
        if column.type == "number" or (column.type in plain and frame[column.name].isna().any()):
            frame[column.name] = frame[column.name].astype(float)
        elif column.type in plain:
            frame[column.name] = frame[column.name].astype(plain[column.type])
    return frame


def as_written(frame: pd.DataFrame, columns: Iterable[Column]) -> pd.DataFrame:
    """Return ``frame`` as in a CSV file: whole numbers stay whole where others are missing."""
    nullable = {"integer": "Int64", "boolean": "boolean"}
    kinds = {c.name: nullable[c.type] for c in columns if c.type in nullable}
    present = {name: kind for name, kind in kinds.items() if name in frame.columns}
    return frame.astype(present)


def cells_frame(cells: Iterable[Cell], records: Mapping[int, list[RunRecord]]) -> pd.DataFrame:
    """Return ``cells.csv``: each cell's levels, and the number of its runs.

    Args:
        cells: Cells of the design.
        records: Records by the cell's number.
    """
    rows = []
    for cell in cells:
        made = records.get(cell.number, [])
        rows.append(
            {
                "cell": cell.number,
                **{name: level.value for name, level in cell.levels.items()},
                "runs": len(made),
                "failed": sum(record.failed for record in made),
            }
        )
    return pd.DataFrame(rows)


def execution_frame(records: Iterable[RunRecord]) -> pd.DataFrame:
    """Return ``execution.csv``: how each run was computed.

    It differs between equal studies.
    """
    names = [column.name for column in EXECUTION_COLUMNS]
    rows = [{"run": record.run, **asdict(record.computing)} for record in records]
    return pd.DataFrame(rows, columns=names)


def computing_frame(cells: Iterable[Cell], records: Mapping[int, list[RunRecord]]) -> pd.DataFrame:
    """Return ``computing.csv``: the computing time of each cell's runs.

    It differs between equal studies.

    Args:
        cells: Cells of the design.
        records: Records by the cell's number; those without a result are left out.
    """
    rows = []
    for cell in cells:
        made = [record for record in records.get(cell.number, []) if not record.failed]
        times = pd.DataFrame([asdict(record.computing) for record in made])
        row = {"cell": cell.number, **{name: level.value for name, level in cell.levels.items()}}
        if made:
            row |= {
                "seconds": times["seconds"].median(),
                "control_median": times["control_median"].median(),
                "control_max": times["control_max"].max(),
                "twin": times["twin"].median(),
            }
        rows.append(row | {"runs": len(made)})
    factors = [name for cell in cells for name in cell.levels]
    names = ["cell", *dict.fromkeys(factors), "runs", *(c.name for c in COMPUTING_COLUMNS)]
    return pd.DataFrame(rows, columns=names).astype({c.name: float for c in COMPUTING_COLUMNS})


def failures_frame(records: Iterable[tuple[Cell, int, RunRecord]], command: str) -> pd.DataFrame:
    """Return ``failures.csv``: the runs without a result, the reason, and how to repeat them.

    Args:
        records: Records with the cell and the seed of each; those that did not fail are left out.
        command: Command that makes a run of this study again, without the run's id.
    """
    rows = [
        {
            "run": record.run,
            "cell": cell.number,
            "seed": seed,
            "ending": record.ending or CRASHED,
            "cause": record.failure,
            "reproduce": f"{command} {record.run}",
        }
        for cell, seed, record in records
        if record.failed
    ]
    return pd.DataFrame(rows, columns=[column.name for column in FAILURE_COLUMNS])
