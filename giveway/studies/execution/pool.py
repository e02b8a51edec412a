"""Workers that are kept at work: each slot is a thread with a process of its own.

Nothing is shared between the processes, no pipe and no lock, so that one that is killed at
whatever instant harms nobody else. (A pool with shared ones, Pebble's, was tried: with four
workers, killing one every half a second breaks it within twenty seconds, five times of five.)

A worker is started by the thread that uses it, because Linux ends it together with that thread.
"""

from __future__ import annotations

import os
import queue
import socket
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

from giveway.studies.execution.executor import WorkerError
from giveway.studies.execution.limits import ATTEMPTS, Limits
from giveway.studies.execution.scratch import Scratch
from giveway.studies.execution.worker_process import (
    IdleDeathError,
    NotStartedError,
    RunDiedError,
    RunRaisedError,
    WorkerProcess,
)
from giveway.studies.record import CRASHED, FAILED, Computing, RunRecord, Task

if TYPE_CHECKING:
    from pathlib import Path

Delivery = Callable[[RunRecord | Exception], None]

_IDLE_LIMIT: Final = 300.0  # [s] after which a worker without work gives its memory back
_VAIN_STARTS: Final = 5  # deaths without a finished run in between: it is not by accident
_PAUSE: Final = 0.1  # [s] after the first of them; it doubles: memory may become free
_LOOK: Final = 1.0  # [s] after which a waiting caller looks whether the pool has been closed
_JOIN: Final = 10.0  # [s] for a slot to notice that its worker has been killed


class ClosedError(Exception):
    """The pool has been closed."""


@dataclass(frozen=True)
class _Job:
    task: Task
    deliver: Delivery


class Pool:
    """Makes runs in processes of this machine; may be used by several threads.

    Args:
        slots: how many at a time.
        limits: of each run.
        place: for temporary files; None: where they usually are.
    """

    def __init__(self, slots: int, limits: Limits, place: Path | None = None) -> None:
        self.slots = slots
        self._limits = limits
        self._scratch = Scratch(place)
        self._jobs: queue.SimpleQueue[_Job | None] = queue.SimpleQueue()
        self._lock = threading.Lock()
        self._closed = threading.Event()
        self._alive: set[WorkerProcess] = set()
        self._vain_starts = 0
        self._threads = [
            threading.Thread(target=self._serve, name=f"giveway-slot-{n}", daemon=True)
            for n in range(slots)
        ]
        for thread in self._threads:
            thread.start()

    def submit(self, task: Task, deliver: Delivery) -> None:
        """Have a run made.

        Args:
            task: the run.
            deliver: called once, from another thread, with the record, or with the error for
                which no run can be made; not called any more once the pool is closed.
        """
        self._jobs.put(_Job(task, deliver))

    def perform(self, task: Task) -> RunRecord:
        """Have a run made, and wait for it.

        Raises:
            WorkerError: no run can be made.
            ClosedError: the pool was closed meanwhile.
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
        """End every process at once, whatever it is doing, and remove what they leave."""
        self._closed.set()
        with self._lock:
            for worker in self._alive:
                worker.end()
        for _ in self._threads:
            self._jobs.put(None)
        for thread in self._threads:
            thread.join(_JOIN)
        self._scratch.remove()

    # --- in a slot's thread -------------------------------------------------------------------

    def _serve(self) -> None:
        worker: WorkerProcess | None = None
        while not self._closed.is_set():
            try:
                job = self._jobs.get(timeout=_IDLE_LIMIT)
            except queue.Empty:
                self._let_go(worker)
                worker = None
                continue
            if job is None:
                break
            try:
                worker, record = self._finish(job.task, worker)
            except ClosedError:
                break
            except Exception as error:
                worker = None
                job.deliver(error)
            else:
                job.deliver(record)
        self._let_go(worker)

    def _finish(
        self, task: Task, worker: WorkerProcess | None
    ) -> tuple[WorkerProcess | None, RunRecord]:
        """Make the run, however often its worker has to be replaced."""
        attempt = 1
        while True:
            if worker is None:
                worker = self._employ()
            began = time.monotonic()
            try:
                record = worker.perform(task)
            except IdleDeathError as error:
                self._let_go(worker)
                worker = None
                self._note_vain(str(error))
                continue
            except WorkerError:
                self._let_go(worker)
                raise
            except (RunDiedError, RunRaisedError) as error:
                self._let_go(worker)
                worker = None
                self._raise_if_closed()
                if attempt < ATTEMPTS:
                    attempt += 1
                    continue
                died = isinstance(error, RunDiedError)
                record = RunRecord(
                    task.run,
                    task.key,
                    CRASHED if died else FAILED,
                    failure=str(error),
                    computing=Computing(
                        seconds=round(time.monotonic() - began, 6),
                        worker=f"{socket.gethostname()}:{os.getpid()}",
                    ),
                )
            if worker is not None and worker.overgrown:
                self._let_go(worker)
                worker = None
            self._vain_starts = 0
            return worker, replace(record, computing=replace(record.computing, attempts=attempt))

    def _employ(self) -> WorkerProcess:
        """A worker that is ready.

        Raises:
            WorkerError: several in turn have died without having done anything.
            ClosedError: there is no need for one any more.
        """
        while True:
            worker = None
            try:
                with self._lock:
                    self._raise_if_closed()
                    worker = WorkerProcess(self._scratch.folder(), self._limits)
                    self._alive.add(worker)
                worker.await_ready()
            except (NotStartedError, OSError) as error:
                self._let_go(worker)
                self._note_vain(str(error))
            else:
                return worker

    def _note_vain(self, cause: str) -> None:
        """A worker has died for nothing: pause, or give up."""
        self._raise_if_closed()
        self._vain_starts += 1
        if self._vain_starts >= _VAIN_STARTS:
            self._vain_starts = 0
            msg = (
                f"{_VAIN_STARTS} processes in turn have ended before they could make a run "
                f"({cause}); free memory, lower --jobs, or run 'giveway doctor'; what is finished "
                "stays"
            )
            raise WorkerError(msg)
        self._closed.wait(_PAUSE * 2**self._vain_starts)

    def _raise_if_closed(self) -> None:
        if self._closed.is_set():
            raise ClosedError

    def _let_go(self, worker: WorkerProcess | None) -> None:
        """Bury it, if there is one."""
        if worker is not None:
            with self._lock:
                self._alive.discard(worker)
            worker.bury()
