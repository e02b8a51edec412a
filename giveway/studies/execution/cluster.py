"""Runs on a Dask cluster: one giveway process per thread of its workers.

Dask distributes the runs, and gives those of a worker that dies to the others. Each run is made
in a separate process (:mod:`giveway.studies.execution.cluster_task`). If the connection is lost,
the runs that were under way are submitted again.
"""

import logging
import re
import sys
import threading
import time
import uuid
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import asdict
from functools import partial
from typing import Any, Final, Self

from giveway.studies.execution.cluster_probe import reason_against
from giveway.studies.execution.cluster_runs import ClusterRuns
from giveway.studies.execution.executor import WorkerError
from giveway.studies.execution.limits import Limits
from giveway.studies.record import RunRecord, Task

Client = Any  # Dask's classes, whose methods mostly have no types
Cluster = Any

PATIENCE: Final = 300.0  # Time [s] to wait for a worker to come back
# Time [s] to wait for the scheduler to come back; it then has lost all tasks
_SCHEDULER_PATIENCE: Final = 5.0
_LOCAL: Final = re.compile(r"local(?::([1-9]\d*))?")
_REMOTE: Final = re.compile(r"(?!local:)([\w.+-]+://\S+|[\w.-]+:\d+)")
_LOCAL_WORKERS: Final = 2
_LOOK: Final = 1.0  # Time [s] between two checks of the cluster
_CONNECT: Final = 5.0  # Time limit [s] of one attempt to connect
_CLOSING: Final = 5.0  # Time [s] for the workers to end the study's processes
_LEAVING: Final = 1.0  # Time [s] to leave a cluster that does not answer any more


class ClusterExecutor:
    """The :class:`giveway.studies.execution.executor.Executor` of a Dask cluster.

    Args:
        address: Address of the scheduler; ``local`` or ``local:N``.
        limits: Time limits of each run.
        tell: Function that takes one line when the cluster has to be waited for, or None for
            standard error.
        patience: Time [s] to wait for workers; for the scheduler it is 5 s at most.

    Raises:
        WorkerError: Dask is not installed, or the address is invalid.
    """

    def __init__(
        self,
        address: str,
        limits: Limits,
        tell: Callable[[str], None] | None = None,
        *,
        patience: float = PATIENCE,
    ) -> None:
        _require_dask()
        local = _LOCAL.fullmatch(address)
        if local is None and not _REMOTE.fullmatch(address):
            raise WorkerError(
                f"cluster '{address}': expected tcp://host:port of a Dask scheduler, or local:N"
            )
        self._address = address
        self._local = 0 if local is None else int(local.group(1) or _LOCAL_WORKERS)
        self._limits = limits
        self._tell = tell or _to_stderr
        self._patience = patience
        self._study = uuid.uuid4().hex  # identifies the study's pools for the workers
        self._cluster: Cluster | None = None
        self._client: Client | None = None
        self._threads = 0
        self._missed = 0.0  # Time [s] at which the last worker was lost; 0 while there is one
        self._looked = 0.0
        # Sign of life of each Dask worker as the scheduler tells it, and our time [s] of it
        self._signs: dict[str, tuple[float, float]] = {}

    @property
    def workers(self) -> int:
        """The number of runs that are made at the same time."""
        return max(self._threads, self._local, 1)

    def run(self, tasks: Iterable[Task]) -> Iterator[RunRecord]:
        """Make the runs as :class:`~giveway.studies.execution.executor.Executor` describes."""
        return ClusterRuns(self, tasks).run()

    def __enter__(self) -> Self:
        self._connect()
        return self

    def __exit__(self, *_: object) -> None:
        from giveway.studies.execution.cluster_task import close_pool

        client, self._client = self._client, None
        cluster, self._cluster = self._cluster, None
        if client is not None:
            limit = _CLOSING if client.status == "running" else _LEAVING
            if cluster is None:  # a local cluster ends its processes itself
                _try_briefly(lambda: client.run(close_pool, self._study, on_error="ignore"), limit)
            _try_briefly(lambda: client.close(timeout=limit), limit)
        if cluster is not None:
            _try_briefly(lambda: cluster.close(timeout=_CLOSING))

    # --- for ClusterRuns ----------------------------------------------------------------------

    def submit(self, task: Task, name: str) -> Any:
        """Submit a run.

        Returns:
            Dask's future.

        Raises:
            Exception: any error means that the cluster cannot be reached.
        """
        from giveway.studies.execution.cluster_task import perform_there

        limits = {"hang": self._limits.hang, "run": self._limits.run}
        return self._open().submit(
            perform_there,
            self._study,
            limits,
            asdict(task),
            key=f"giveway-{self._study[:8]}-{name}",
            pure=False,
        )

    def is_there(self) -> bool:
        """Return whether the cluster had workers when it was last checked.

        Raises:
            WorkerError: there has been no worker for too long.
        """
        now = time.monotonic()
        if now - self._looked < _LOOK and not self._missed:
            return True
        self._looked = now
        missing, patience = self._missing()
        if not missing:
            self._missed = 0.0
            return True
        if not self._missed:
            self._missed = now
            self._tell(f"{missing}; waiting {patience:g} s for it, nothing is lost")
        if time.monotonic() - self._missed > patience:
            raise WorkerError(
                f"{missing}, for {patience:g} s; start it again and go on with --resume"
            )
        return False

    def abandon(self, futures: Iterable[Any]) -> None:
        """Cancel runs, including those that are being made."""
        from giveway.studies.execution.cluster_task import close_pool

        client, wanted = self._client, list(futures)
        if client is not None:
            _try_briefly(lambda: client.cancel(wanted, force=True))
            _try_briefly(lambda: client.run(close_pool, self._study, on_error="ignore"))
            self._study = uuid.uuid4().hex

    def _missing(self) -> tuple[str, float]:
        """Return what the cluster lacks, and for how long [s] to wait for it.

        The text is empty if the cluster can work.
        """
        client = self._client
        try:
            if client is None or client.status == "closed":
                self._client = None
                client = self._open()
            if client.status == "running":
                workers = _workers(client)
                self._threads = sum(worker["nthreads"] for worker in workers.values())
                lacking = "" if self._threads else f"cluster {self._address}: it has no worker"
                if workers and not self._leave_frozen(client, workers):
                    lacking = f"cluster {self._address}: each of its workers stands still"
                return lacking, self._patience
        except (OSError, ValueError, WorkerError):
            pass
        lacking = f"cluster {self._address}: its scheduler does not answer"
        return lacking, min(self._patience, _SCHEDULER_PATIENCE)

    def _leave_frozen(self, client: Client, workers: Mapping[str, Any]) -> bool:
        """Take workers without a sign of life out of the cluster; Dask gives their runs to others.

        Returns:
            False if no worker has given a sign of life within the hang limit.
        """
        now = time.monotonic()
        signs = {address: worker["last_seen"] for address, worker in workers.items()}
        known = self._signs
        self._signs = {
            address: known[address] if known.get(address, (None,))[0] == sign else (sign, now)
            for address, sign in signs.items()
        }
        frozen = [w for w, (_, since) in self._signs.items() if now - since > self._limits.hang]
        if len(frozen) == len(signs):
            return False
        for worker in frozen:
            told = f"worker {worker} has stood still for {self._limits.hang:g} s"
            self._tell(f"cluster {self._address}: {told}; its runs go to others")
            leave = partial(client.sync, client.scheduler.unregister, address=worker)
            _try_briefly(partial(leave, stimulus_id=f"giveway-{worker}"))
        return True

    def _open(self) -> Client:
        return self._client or self._connect()

    def _connect(self) -> Client:
        import distributed

        from giveway.studies.execution.cluster_task import ignore_interrupts

        dask: Any = distributed
        # giveway's own messages report a lost connection
        logging.getLogger("distributed.client").setLevel(logging.CRITICAL)
        reason = "" if self._local else reason_against(self._address, _CONNECT)
        if reason:
            raise self._unreachable(reason)
        try:
            if self._local and self._cluster is None:
                self._cluster = dask.LocalCluster(
                    n_workers=self._local,
                    threads_per_worker=1,
                    dashboard_address=None,
                    silence_logs=logging.CRITICAL,
                )
            where = self._cluster or self._address
            self._client = dask.Client(where, timeout=_CONNECT, set_as_default=False)
            if self._cluster is not None:
                self._client.run(ignore_interrupts)
            self._threads = sum(w["nthreads"] for w in _workers(self._client).values())
        except (OSError, ValueError, RuntimeError) as error:
            reason = " ".join(str(error).split()) or type(error).__name__
            raise self._unreachable(reason) from error
        return self._client

    def _unreachable(self, reason: str) -> WorkerError:
        return WorkerError(
            f"cluster '{self._address}': cannot be reached ({reason}); is 'dask scheduler' up?"
        )


def _require_dask() -> None:
    try:
        import distributed  # noqa: F401
    except ImportError as error:
        raise WorkerError(
            f"a cluster needs Dask ({error}); pip install 'giveway[cluster]'"
        ) from error


def _workers(client: Client) -> dict[str, Any]:
    """Return what the scheduler says of each Dask worker.

    Raises:
        OSError: it does not answer.
    """
    asked = client.sync(client.scheduler.identity, callback_timeout=_CONNECT)
    return dict(asked["workers"])


def _try_briefly(call: Callable[[], Any], limit: float = _CLOSING) -> None:
    """Make a call, but wait for ``limit`` [s] at most, since the other side may not answer."""

    def attempt() -> None:
        with suppress(Exception):
            call()

    thread = threading.Thread(target=attempt, daemon=True)
    thread.start()
    thread.join(limit)


def _to_stderr(line: str) -> None:
    sys.stderr.write(f"{line}\n")
