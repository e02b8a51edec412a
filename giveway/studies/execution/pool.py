"""A pool of worker processes: each slot is a thread with a process of its own.

The processes share nothing, no pipe and no lock, so that killing one at any instant harms no other.
(With Pebble's pool, whose processes share both, killing one of four workers every half a second
broke the pool within twenty seconds, in five trials of five.)

A worker is started by the thread that uses it, because Linux ends the worker together with that
thread.
"""

import itertools
import os
import queue
import socket
import threading
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Final

from fmus.archive.own_folder import OwnFolder
from giveway.studies.execution.executor import WorkerError
from giveway.studies.execution.limits import ATTEMPTS, Limits
from giveway.studies.execution.worker_process import (
    NotBegunError,
    RunDiedError,
    RunRaisedError,
    WorkerProcess,
)
from giveway.studies.record import CRASHED, FAILED, Computing, RunRecord, Task

Delivery = Callable[[RunRecord | Exception], None]

_IDLE_LIMIT: Final = 300.0  # Time [s] after which a worker without work is ended
# Failed starts in a row, without a finished run in between, after which the pool gives up
_MOST_FAILED_STARTS: Final = 5
# Pause [s] after the first failed start; it doubles, since memory may become free
_PAUSE: Final = 0.1
# Interval [s] at which a waiting caller checks whether the pool has been closed
_LOOK: Final = 1.0
_JOIN: Final = 10.0  # Time [s] for a slot to notice that its worker has been killed


class ClosedError(Exception):
    """The pool has been closed."""


class Pool:
    """Makes runs in processes of this machine; several threads may use it.

    Args:
        slots: Number of runs at a time.
        limits: Time limits of each run.
        place: Folder for temporary files. None: the system's folder for them.
    """

    def __init__(self, slots: int, limits: Limits, place: Path | None = None) -> None:
        self._limits = limits
        self._scratch, self._numbers = OwnFolder("giveway-workers-", place), itertools.count(1)
        self._jobs: queue.SimpleQueue[tuple[Task, Delivery] | None] = queue.SimpleQueue()
        self._lock = threading.Lock()
        self._closed = threading.Event()
        self._alive: set[WorkerProcess] = set()
        self._failed_starts = 0
        self._threads = [
            threading.Thread(target=self._serve, name=f"giveway-slot-{n}", daemon=True)
            for n in range(slots)
        ]
        for thread in self._threads:
            thread.start()

    def submit(self, task: Task, deliver: Delivery) -> None:
        """Let a worker make a run.

        Args:
            task: Run to be made.
            deliver: Function that is called once, from another thread, with the record, or with the
                error because of which no run can be made. It is not called after the pool is
                closed.
        """
        self._jobs.put((task, deliver))

    def perform(self, task: Task) -> RunRecord:
        """Let a worker make a run, and wait for its record.

        Raises:
            WorkerError: no run can be made.
            ClosedError: the pool was closed in the meantime.
        """
        answers: queue.SimpleQueue[RunRecord | Exception] = queue.SimpleQueue()
        self.submit(task, answers.put)
        while True:
            try:
                answer = answers.get(timeout=_LOOK)
            except queue.Empty:
                self._raise_if_closed()
                continue
            if isinstance(answer, Exception):
                raise answer
            return answer

    def close(self) -> None:
        """End every process at once, in any state, and remove its files."""
        self._closed.set()
        with self._lock:
            for worker in self._alive:
                worker.end()
        for _ in self._threads:
            self._jobs.put(None)
        for thread in self._threads:
            thread.join(_JOIN)
        self._scratch.cleanup()

    # --- in a slot's thread -------------------------------------------------------------------

    def _serve(self) -> None:
        worker: WorkerProcess | None = None
        while not self._closed.is_set():
            try:
                job = self._jobs.get(timeout=_IDLE_LIMIT)
            except queue.Empty:
                self._remove(worker)
                worker = None
                continue
            if job is None:
                break
            task, deliver = job
            try:
                worker, record = self._finish(task, worker)
            except ClosedError:
                break
            except Exception as error:
                worker = None
                deliver(error)
            else:
                deliver(record)
        self._remove(worker)

    def _finish(
        self, task: Task, worker: WorkerProcess | None
    ) -> tuple[WorkerProcess | None, RunRecord]:
        """Make the run, and replace its worker as often as needed."""
        attempt, retried = 1, ""
        while True:
            if worker is None:
                worker = self._start_worker()
            began = time.monotonic()
            try:
                record = worker.perform(task)
            except NotBegunError as error:
                self._remove(worker)
                worker, retried = None, str(error)
                self._note_failed_start(retried)
                continue
            except WorkerError:
                self._remove(worker)
                raise
            except (RunDiedError, RunRaisedError) as error:
                self._remove(worker)
                worker, retried = None, str(error)
                self._raise_if_closed()
                if attempt < ATTEMPTS:
                    attempt += 1
                    continue
                died = isinstance(error, RunDiedError)
                record = RunRecord(
                    task.run,
                    task.key,
                    CRASHED if died else FAILED,
                    failure=_named(task, str(error)),
                    computing=Computing(
                        seconds=round(time.monotonic() - began, 6),
                        worker=f"{socket.gethostname()}:{os.getpid()}",
                    ),
                )
            if worker is not None and worker.overgrown:
                self._remove(worker)
                worker = None
            self._failed_starts = 0
            computing = replace(record.computing, attempts=attempt, retried=retried)
            return worker, replace(record, computing=computing)

    def _start_worker(self) -> WorkerProcess:
        """Start a worker, and wait until it is ready.

        Raises:
            WorkerError: several workers in a row have ended before they could make a run.
            ClosedError: the pool has been closed.
        """
        while True:
            worker = None
            try:
                with self._lock:
                    self._raise_if_closed()
                    worker = WorkerProcess(
                        Path(self._scratch.name, str(next(self._numbers))), self._limits
                    )
                    self._alive.add(worker)
                worker.await_ready()
            except (NotBegunError, OSError) as error:
                self._remove(worker)
                self._note_failed_start(str(error))
            else:
                return worker

    def _note_failed_start(self, cause: str) -> None:
        """Count a worker that ended before it could make a run; then pause or give up."""
        self._raise_if_closed()
        self._failed_starts += 1
        if self._failed_starts >= _MOST_FAILED_STARTS:
            self._failed_starts = 0
            raise WorkerError(
                f"{_MOST_FAILED_STARTS} processes in turn have ended before they could make a run "
                f"({cause}); free memory, lower --jobs, or run 'giveway doctor'; what is finished "
                "stays"
            )
        self._closed.wait(_PAUSE * 2**self._failed_starts)

    def _raise_if_closed(self) -> None:
        if self._closed.is_set():
            raise ClosedError

    def _remove(self, worker: WorkerProcess | None) -> None:
        """End a worker, if there is one, and remove its files."""
        if worker is not None:
            with self._lock:
                self._alive.discard(worker)
            worker.remove()


def _named(task: Task, failure: str) -> str:
    """Return the failure, with the controller's name if the controller is a plug-in."""
    from giveway.config.files.foreign_code import named_in

    return named_in(failure, task.run_config)
