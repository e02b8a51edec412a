"""One run of a study, in this process: from a task to its record."""

from __future__ import annotations

import os
import socket
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from giveway.api import simulate
from giveway.config import RunConfig
from giveway.errors import GivewayError
from giveway.results import rounded_row
from giveway.studies.record import FAILED, Computing, RunRecord, Scalar, Task
from sumo_scenarios import find

if TYPE_CHECKING:
    from giveway.journal import Journal
    from giveway.run_result import RunResult


def perform(task: Task, journal: Journal | None = None) -> RunRecord:
    """Make the run and keep its summary; an error on the way is part of the record.

    Args:
        task: what to run.
        journal: whose heartbeat tells another process where the run stands.
    """
    began = perf_counter()
    config = RunConfig.model_validate_json(task.config)
    try:
        result = simulate(config, find(config.scenario), journal=journal)
        if result.error is not None:
            raise result.error
    except GivewayError as error:
        failure = " ".join(str(error).split())
        return RunRecord(task.run, task.key, FAILED, failure=failure, computing=_since(began))
    rows = rows_of(result)
    return RunRecord(
        run=task.run,
        key=task.key,
        ending=str(result.ending),
        rows=rows,
        remarks=tuple(result.remarks),
        computing=_since(began),
    )


def rows_of(result: RunResult) -> tuple[dict[str, Scalar], ...]:
    """The run's summary, one row per ego, rounded as ``summary.csv`` is."""
    rows = result.summary_table.to_dict("records")
    return tuple(rounded_row(row) for row in rows) or (rounded_row(result.head),)


def _since(began: float) -> Computing:
    return Computing(
        seconds=round(perf_counter() - began, 6),
        worker=f"{socket.gethostname()}:{os.getpid()}",
        memory=resident_memory(),
    )


def resident_memory() -> float:
    """The memory [MB] that this process holds; nan where the system does not tell."""
    try:
        with open("/proc/self/statm", encoding="ascii") as file:  # noqa: PTH123 - not a file
            pages = int(file.read().split()[1])
    except (OSError, ValueError, IndexError):
        return float(np.nan)
    return round(pages * os.sysconf("SC_PAGE_SIZE") / 1e6, 1)
