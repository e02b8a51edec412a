"""The runs of one call on a Dask cluster: submitted, submitted again, and fetched."""

import queue
from collections import deque
from collections.abc import Iterable, Iterator
from typing import Any, Final, Protocol

from giveway.studies.execution.executor import WorkerError
from giveway.studies.execution.limits import ATTEMPTS
from giveway.studies.record import CRASHED, Computing, RunRecord, Task

Future = Any  # Class of Dask, most of whose methods have no types

_AHEAD: Final = 3  # Runs submitted per worker, so that no worker waits for the network
_LOOK: Final = 1.0  # Time [s] between two checks of the cluster and of Ctrl-C
_FETCH: Final = 30.0  # Time [s] for a result to arrive; after it the worker counts as dead


class Cluster(Protocol):
    """A client that submits runs to workers, and knows whether there are any."""

    @property
    def workers(self) -> int:
        """The number of runs that are made at a time."""

    def submit(self, task: Task, name: str) -> Future:
        """Submit a run, and return the future of its record."""

    def is_there(self) -> bool:
        """True if the cluster has workers."""

    def abandon(self, futures: Iterable[Future]) -> None:
        """Cancel runs, also those that are being made."""


class ClusterRuns:
    """The runs of one call of :meth:`giveway.studies.execution.executor.Executor.run`.

    Args:
        cluster: Cluster that makes them.
        tasks: Runs to be made.
    """

    def __init__(self, cluster: Cluster, tasks: Iterable[Task]) -> None:
        self._cluster = cluster
        self._source = iter(tasks)
        self._again: deque[Task] = deque()
        # number of times that Dask gave up each run because it killed workers
        self._killed: dict[str, int] = {}
        self._under_way: dict[str, tuple[Task, Future]] = {}
        self._finished: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._number = 0

    def run(self) -> Iterator[RunRecord]:
        """Make the runs as :meth:`giveway.studies.execution.executor.Executor.run` describes."""
        try:
            while True:
                there = self._cluster.is_there()
                if there and not self._submit_runs():
                    return
                try:
                    name = self._finished.get(timeout=_LOOK)
                except queue.Empty:
                    continue
                task, future = self._under_way.pop(name)
                record = self._record(task, future)
                if record is None:
                    self._again.append(task)
                else:
                    yield record
        finally:
            if self._under_way:
                self._cluster.abandon(future for _, future in self._under_way.values())

    def _submit_runs(self) -> bool:
        """Submit as many runs as may wait, and return False if there is nothing more to do."""
        while len(self._under_way) < _AHEAD * self._cluster.workers:
            task = self._again.popleft() if self._again else next(self._source, None)
            if task is None:
                break
            self._number += 1
            name = f"{task.run}-{self._number}"
            try:
                future = self._cluster.submit(task, name)
            # many kinds of errors, which the next check of the cluster tells apart
            except Exception:
                self._again.append(task)
                return True
            self._under_way[name] = (task, future)
            future.add_done_callback(lambda _, name=name: self._finished.put(name))
        return bool(self._under_way)

    def _record(self, task: Task, future: Future) -> RunRecord | None:
        """Return the record of a run, or None if the run is to be submitted again.

        Raises:
            WorkerError: a worker refuses this study.
        """
        from distributed.scheduler import KilledWorker

        from giveway.studies.execution.cluster_task import RECORD, REFUSED

        if future.status not in {"finished", "error"}:
            return None  # the connection was lost
        try:
            answer: dict[str, str] = future.result(timeout=_FETCH)
        except KilledWorker as error:
            return self._died(task, error)
        except Exception as error:
            if future.status != "error":  # the worker died before the result could be fetched
                return None
            reason = " ".join(f"{type(error).__name__}: {error}".split())
            raise WorkerError(
                f"a worker cannot make runs ({reason}); install this giveway on every machine"
            ) from error
        finally:
            future.release()
        if REFUSED in answer:
            raise WorkerError(answer[REFUSED])
        return RunRecord.from_json(answer[RECORD])

    def _died(self, task: Task, error: Any) -> RunRecord | None:
        count = self._killed[task.run] = self._killed.get(task.run, 0) + 1
        if count < ATTEMPTS:
            return None
        deaths = (error.allowed_failures + 1) * count
        failure = f"{deaths} Dask workers ended while they had this run, the last on "
        failure += f"{error.last_worker.address}; look at their logs"
        return RunRecord(
            task.run, task.key, CRASHED, failure=failure, computing=Computing(attempts=count)
        )
