"""One run of a study once more, with everything that a single run leaves behind."""

import math
from collections.abc import Collection
from pathlib import Path
from typing import Any

from giveway.api import run_checked
from giveway.config.files.loading import load
from giveway.cosimulation.preflight import CheckedRun, preflight
from giveway.errors import GivewayError
from giveway.results.run_result import RunResult
from giveway.run_data.progress import Ending, Watcher
from giveway.studies.execution.perform import rows_of
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.record import RunRecord, Scalar

_PERHAPS = "other software or scenario files since then? Compare its manifest.json"
PREDICTIONS = 0.25  # Time [s] between two predicted positions that are kept


class OtherNumbersError(GivewayError):
    """A run that was made again does not give the study's row; its results are written."""


def checked_run(
    study: StudyFolder, run_id: str, *, predictions: bool = False, trusted: Collection[str] = ()
) -> CheckedRun:
    """A run of a study, ready to be made again.

    Args:
        study: Study that has the run.
        run_id: Such as ``c2-s17``.
        predictions: The predicted positions are to be kept, for the replay.
        trusted: Code, as module:Class, that the study may have imported.

    Raises:
        GivewayError: there is no such run, or its scenario is no longer there.
    """
    cell, seed = study.cell_of(run_id)
    origin = str(study.path / "study.toml")
    config, scenario = load([cell.layer(origin, study.definition)], trusted)
    changes: dict[str, Any] = {"seed": seed}
    if predictions:
        changes["record"] = config.record.model_copy(update={"predictions": PREDICTIONS})
    return preflight(config.model_copy(update=changes), scenario)


def rerun(
    study: StudyFolder,
    run_id: str,
    out: Path | None,
    *,
    checked: CheckedRun | None = None,
    force: bool = False,
    pictures: bool = True,
    watcher: Watcher | None = None,
    journal: Path | None = None,
) -> RunResult:
    """Make one run of a study once more, in this process.

    Args:
        study: Its folder.
        run_id: Such as ``c2-s17``.
        out: Folder for its results; None writes nothing.
        checked: The run, where it is known already; None: as :func:`checked_run` gives it.
        force: Replace the results that are there.
        pictures: also draw the state figure and the top view.
        watcher: told of every control step.
        journal: An empty folder for the rows, to be read should this process die.

    Raises:
        OtherNumbersError: its numbers are not the study's.
        GivewayError: it cannot be made, or fails.
    """
    result = run_checked(
        checked or checked_run(study, run_id),
        results=out,
        force=force,
        pictures=pictures,
        watcher=watcher,
        journal=journal,
    )
    record = study.record(run_id)
    if record is not None and not record.failed and result.ending is not Ending.INTERRUPTED:
        require_same_rows(result, record, study)
    return result


def require_same_rows(result: RunResult, record: RunRecord, study: StudyFolder) -> None:
    """Make sure that a run gives the numbers of its record.

    Raises:
        OtherNumbersError: it does not; the message names the first difference.
    """
    rows = rows_of(result)
    if len(rows) != len(record.rows):
        raise OtherNumbersError(
            f"run {record.run}: {len(rows)} egos where {study.path} has {len(record.rows)}; "
            f"{_PERHAPS}"
        )
    for ours, theirs in zip(rows, record.rows, strict=True):
        for name, value in theirs.items():
            if not _same(ours.get(name), value):
                raise OtherNumbersError(
                    f"run {record.run}: {name} = {ours.get(name)} where {study.path} has {value}; "
                    f"{_PERHAPS}"
                )


def _same(a: Any, b: Scalar) -> bool:
    if isinstance(a, float) and isinstance(b, float) and math.isnan(a) and math.isnan(b):
        return True
    return bool(a == b)
