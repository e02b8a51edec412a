"""The repetition of one run of a study, with all the files of a single run."""

import math
from collections.abc import Collection
from pathlib import Path
from typing import Any, Protocol

from giveway.api import run_checked
from giveway.config.files.layers import Layer
from giveway.config.files.loading import load
from giveway.cosimulation.preflight import CheckedRun, preflight
from giveway.errors import GivewayError
from giveway.results.folder import NOWHERE, Destination
from giveway.results.inputs import require_recorded
from giveway.results.run_result import RunResult
from giveway.run_data.progress import Ending, Watcher
from giveway.studies.execution.perform import rows_of
from giveway.studies.record import RunRecord, Scalar

_PERHAPS = "other software or scenario files since then? Compare its manifest.json"
PREDICTIONS = 0.25  # Time [s] between two predicted positions that are kept


class OtherNumbersError(GivewayError):
    """A repeated run does not give the study's row; its results are written anyway."""


class Runs(Protocol):
    """A folder whose runs can be made again."""

    @property
    def path(self) -> Path:
        """The path of the folder."""

    def layer_of(self, run: str) -> Layer:
        """Return the settings of a run."""

    def record(self, run: str) -> RunRecord | None:
        """Return the record of a run, or None if the run has not been made."""

    def key_of(self, run: str) -> str:
        """Return the key of a run's record."""


def checked_run(
    study: Runs, run_id: str, *, predictions: bool = False, trusted: Collection[str] = ()
) -> CheckedRun:
    """Return a run of a study, ready to be made again.

    Args:
        study: Study that has the run.
        run_id: Id of the run, such as ``c2-s17``.
        predictions: True to keep the predicted positions, for the replay.
        trusted: Code, as module:Class, that the study may import.

    Raises:
        GivewayError: there is no such run, or its scenario no longer exists.
    """
    config, scenario = load([study.layer_of(run_id)], trusted)
    require_recorded(study.path, config, scenario)
    if predictions:
        record = config.record.model_copy(update={"predictions": PREDICTIONS})
        config = config.model_copy(update={"record": record})
    return preflight(config, scenario)


def rerun(
    study: Runs,
    run_id: str,
    destination: Destination = NOWHERE,
    *,
    checked: CheckedRun | None = None,
    watcher: Watcher | None = None,
    journal: Path | None = None,
) -> RunResult:
    """Make one run of a study again, in this process.

    Args:
        study: Folder of the study.
        run_id: Id of the run, such as ``c2-s17``.
        destination: Folder and files of the results.
        checked: The run, or None to find it by :func:`checked_run`.
        watcher: Watcher that is called at every control step.
        journal: Empty folder for the rows, which can be read if this process dies.

    Raises:
        OtherNumbersError: the numbers differ from the study's.
        GivewayError: the run cannot be made, or fails.
    """
    result = run_checked(
        checked or checked_run(study, run_id),
        destination,
        watcher=watcher,
        journal=journal,
    )
    record = study.record(run_id)
    if record is not None and not record.failed and result.ending is not Ending.INTERRUPTED:
        require_same_rows(result, record, study)
    return result


def require_same_rows(result: RunResult, record: RunRecord, study: Runs) -> None:
    """Make sure that a run gives the numbers of its record.

    Raises:
        OtherNumbersError: a number differs; the message names the first one.
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
