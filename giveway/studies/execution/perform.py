"""One run of a study, in this process: from a task to its record."""

import math
import os
import socket
from dataclasses import replace
from pathlib import Path
from time import perf_counter

import numpy as np

from fmus.text import printable
from giveway.api import simulate
from giveway.cosimulation.preflight import preflight
from giveway.errors import GivewayError
from giveway.journal.journal import Journal
from giveway.processes.heartbeat import Phase
from giveway.results.folder import rounded_row
from giveway.results.provenance import processor
from giveway.results.run_result import RunResult
from giveway.run_data.tracks import Timings
from giveway.studies.record import FAILED, Computing, RunRecord, Scalar, Task
from sumo_scenarios import find

_LONGEST_FAILURE = 2000  # Largest number of characters of a failure's message
_STATM = Path("/proc/self/statm")


def perform(
    task: Task, journal: Journal | None = None, native_log: Path | None = None
) -> RunRecord:
    """Make the run and return its record.

    An error on the way is part of the record.

    Args:
        task: Run to make.
        journal: Journal whose heartbeat shows the progress to another process.
        native_log: File for what SUMO prints, which is read if this process dies.
    """
    began = perf_counter()
    journal = journal or Journal(None)
    config = task.run_config
    try:
        checked = preflight(config, find(config.scenario))
        result = simulate(checked, journal=journal, native_log=native_log)
        if result.error is not None:
            raise result.error
    except GivewayError as error:
        failure = printable(error, _LONGEST_FAILURE)
        return RunRecord(task.run, task.key, FAILED, failure=failure, computing=_since(began))
    journal.heartbeat.beat(Phase.MEASURING)
    rows = rows_of(result)
    median, longest = control_times(result.timings)
    return RunRecord(
        run=task.run,
        key=task.key,
        ending=str(result.ending),
        rows=rows,
        remarks=tuple(result.remarks),
        columns=result.egos[0].measured.columns if result.egos else (),
        computing=replace(
            _since(began), control_median=median, control_max=longest, twin=twin_time(result)
        ),
    )


def control_times(timings: Timings) -> tuple[float, float]:
    """Return the median and largest time [ms] of a control step: prediction and controller.

    The first step is left out, since it fills caches. The times are nan without a second one.
    """
    columns = [timings.NAMES.index(name) for name in ("prediction", "control")]
    steps = 1000.0 * timings.seconds[1:, columns].sum(axis=1)
    if not steps.size:
        return math.nan, math.nan
    return round(float(np.median(steps)), 6), round(float(steps.max()), 6)


def twin_time(result: RunResult) -> float:
    """Return the time [s] of a run's counterfactual run, or nan without one."""
    return math.nan if result.effect is None else round(result.effect.seconds, 6)


def rows_of(result: RunResult) -> tuple[dict[str, Scalar], ...]:
    """Return the run's summary, one row per ego, rounded as in ``summary.csv``."""
    return tuple(rounded_row(row) for row in result.summary_rows) or (rounded_row(result.head),)


def _since(began: float) -> Computing:
    return Computing(
        seconds=round(perf_counter() - began, 6),
        worker=f"{socket.gethostname()}:{os.getpid()}",
        processor=printable(processor()["name"]),
        memory=resident_memory(),
    )


def resident_memory() -> float:
    """Return the memory [MB] that this process holds, or nan if the system does not report it."""
    try:
        pages = int(_STATM.read_text(encoding="ascii").split()[1])
    except (OSError, ValueError, IndexError):
        return math.nan
    return round(pages * os.sysconf("SC_PAGE_SIZE") / 1e6, 1)
