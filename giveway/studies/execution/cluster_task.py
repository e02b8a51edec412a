"""The task of a Dask worker in a study: it lets separate processes make runs.

The processes form a pool as on a single machine, so that a crash never ends the Dask worker.
Arguments and results are plain values, since the other side may have another giveway version.
"""

import signal
import threading
from pathlib import Path
from typing import Any, Final

from distributed import get_worker

from giveway.errors import GivewayError
from giveway.studies.execution.limits import Limits
from giveway.studies.execution.pool import ClosedError, Pool
from giveway.studies.record import Task

RECORD: Final = "record"
REFUSED: Final = "refused"

_POOLS: Final[dict[str, Pool]] = {}  # Pools of this Dask worker, by study
_LOCK: Final = threading.Lock()


def perform_there(study: str, limits: dict[str, float], task: dict[str, Any]) -> dict[str, str]:
    """Make a run.

    Args:
        study: Name of the study's pool.
        limits: Fields of :class:`Limits`.
        task: Fields of :class:`Task`.

    Returns:
        ``record``: the record as JSON; or ``refused``: why this worker makes no run of this study.
    """
    where = get_worker().address
    try:
        record = _pool(study, Limits(**limits)).perform(Task(**task))
    except (GivewayError, OSError) as error:
        return {REFUSED: f"{where}: {error}"}
    except ClosedError:
        return {REFUSED: f"{where}: the study has been ended"}
    return {RECORD: record.to_json()}


def close_pool(study: str) -> None:
    """End the study's processes on this worker."""
    with _LOCK:
        pool = _POOLS.pop(study, None)
    if pool is not None:
        pool.close()


def ignore_interrupts() -> None:
    """Ignore Ctrl-C in a Dask worker that shares the study's terminal."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _pool(study: str, limits: Limits) -> Pool:
    with _LOCK:
        if study not in _POOLS:
            # Dask removes its worker's folder, even if the worker has been killed.
            worker = get_worker()
            _POOLS[study] = Pool(worker.state.nthreads, limits, Path(worker.local_directory))
        return _POOLS[study]
