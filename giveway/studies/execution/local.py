"""Runs in processes of this machine."""

import queue
from collections.abc import Iterable, Iterator
from typing import Final, Self

from giveway.errors import remedy
from giveway.studies.execution.executor import WorkerError
from giveway.studies.execution.limits import Limits
from giveway.studies.execution.pool import Pool
from giveway.studies.record import RunRecord, Task

_AHEAD: Final = 2  # Runs taken from the plan per worker, so that no worker waits
_LOOK: Final = 1.0  # Length [s] of one wait; some systems notice Ctrl-C only after it


class LocalExecutor:
    """The :class:`giveway.studies.execution.executor.Executor` of this machine.

    Args:
        jobs: Number of runs at the same time.
        limits: Time limits of each run.

    Raises:
        WorkerError: ``jobs`` is not above 0.
    """

    def __init__(self, jobs: int, limits: Limits) -> None:
        if jobs < 1:
            raise WorkerError(
                f"jobs = {jobs}: expected at least 1 process; the number of cores is a good one"
            )
        self._jobs = jobs
        self._limits = limits
        self._pool: Pool | None = None

    @property
    def workers(self) -> int:
        """The number of runs that are made at the same time."""
        return self._jobs

    def run(self, tasks: Iterable[Task]) -> Iterator[RunRecord]:
        """Make the runs as :class:`~giveway.studies.execution.executor.Executor` describes."""
        pool = self._open()
        source = iter(tasks)
        finished: queue.SimpleQueue[RunRecord | Exception] = queue.SimpleQueue()
        under_way = 0
        try:
            while True:
                while under_way < _AHEAD * self._jobs:
                    task = next(source, None)
                    if task is None:
                        break
                    pool.submit(task, finished.put)
                    under_way += 1
                if not under_way:
                    return
                outcome = _wait(finished)
                under_way -= 1
                if isinstance(outcome, Exception):
                    raise outcome
                yield outcome
        finally:
            if under_way:  # the caller has stopped early
                self._close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._close()

    def _open(self) -> Pool:
        if self._pool is None:
            try:
                self._pool = Pool(self._jobs, self._limits)
            except OSError as error:
                raise WorkerError(
                    f"{error}: the workers' temporary folder; {remedy(error)} (TMPDIR)"
                ) from error
            except RuntimeError as error:  # no more threads can be started
                raise WorkerError(
                    f"{self._jobs} workers: {error}; free memory or lower --jobs"
                ) from error
        return self._pool

    def _close(self) -> None:
        pool, self._pool = self._pool, None
        if pool is not None:
            pool.close()


def _wait(finished: queue.SimpleQueue[RunRecord | Exception]) -> RunRecord | Exception:
    while True:
        try:
            return finished.get(timeout=_LOOK)
        except queue.Empty:
            continue
