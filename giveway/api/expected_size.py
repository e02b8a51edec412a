"""The size of a run's longest table and of its journal, which is told before the run."""

import shutil
from pathlib import Path
from typing import Final

import numpy as np

from giveway.config import RunConfig
from giveway.cosimulation.preflight import CheckedRun
from giveway.crowd.ways import middle_of
from giveway.errors import ResultsError
from giveway.run_data.seal import Form

_TOLD: Final = 1e9  # Size [bytes] from which on a file is announced
_ROW: Final[dict[Form, float]] = {"csv": 82.0, "csv.gz": 30.0, "parquet": 18.0}
"""Measured size [bytes] of a row in each form; benchmarks/speed/an_hour.py prints it."""
_JOURNAL_ROW: Final = 48.0  # Size [bytes] of a row of the crowd in the journal


def size_note(checked: CheckedRun, form: Form, journal: Path | None) -> str:
    """Return a sentence on large files that a run will write, or "" without any.

    People of the scenario itself are not counted: nobody knows yet how long they will be there.

    Args:
        checked: Run that has passed the preflight.
        form: Form of the table of trajectories.
        journal: Folder of the journal, or None without one.

    Raises:
        ResultsError: the disk of the journal is too small for it.
    """
    record, thin = checked.config.record, bool(checked.egos)
    thin |= record.far_period is not None
    period = record.longest_period if thin else checked.time_step
    people = _person_seconds(checked.config, _duration(checked))
    rows = people / period
    table, kept = rows * _ROW[form], rows * _JOURNAL_ROW
    if max(table, 0.0 if journal is None else kept) < _TOLD:
        return ""
    note = f"some {rows / 1e6:.0f} million rows of people: trajectories.{form} of {_size(table)}"
    if journal is not None:
        free = shutil.disk_usage(journal).free
        if kept > free:
            raise ResultsError(
                f"{journal.parent}: the journal needs {_size(kept)}, {_size(free)} are free there; "
                "set TMPDIR to a larger disk, or record fewer rows (--record-far-period)"
            )
        note += f", and meanwhile a journal of {_size(kept)} in {journal.parent}"
    if form == "csv":
        note += f"; --trajectories parquet has {_size(rows * _ROW['parquet'])}"
    if not thin:
        note += f"; --record-far-period 1 keeps one row in {1.0 / period:.0f}"
    return note


def _duration(checked: CheckedRun) -> float:
    """Return the longest time [s] that the run can take; inf if nothing limits it."""
    limit, files = checked.config.time_limit, checked.files
    ends = [np.inf if limit is None else limit, (files.end or np.inf) - files.begin]
    return float(min(ends))


def _person_seconds(config: RunConfig, duration: float) -> float:
    """Return the time [s] for which people walk whom giveway adds, summed over them."""
    crowd = config.crowd
    speed = crowd.desired_speed_mean
    walk = min(duration, float(np.hypot(*crowd.walk)) / speed)
    total = crowd.pedestrians * walk
    for flow in crowd.flow:
        places = [flow.start, *flow.via, flow.to]
        legs = np.diff([middle_of(place) for place in places], axis=0)
        each = float(np.hypot(legs[:, 0], legs[:, 1]).sum()) / speed
        lasts = min(duration, np.inf if flow.end is None else flow.end) - flow.begin
        total += flow.rate / 3600.0 * max(0.0, lasts) * min(each, duration)
    return total if np.isfinite(total) else 0.0


def _size(size: float) -> str:
    return f"{size / 1e9:.2g} GB" if size < 1e10 else f"{size / 1e9:.0f} GB"
