"""A worker as its study sees it: given runs, watched, ended, and asked how it died."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Final

from fmus.text import printable
from giveway.processes.causes import cause_of_end, stood_still, text_in
from giveway.processes.child import STDERR_FILE, TRACEBACK_FILE
from giveway.processes.heartbeat import LOOP, Heartbeat, Phase, Stillness
from giveway.studies.execution.errors import WorkerError
from giveway.studies.execution.starting import START_LIMIT, start
from giveway.studies.execution.wire import (
    ERROR,
    READY,
    RECORD,
    REFUSED,
    TASK,
    GarbledError,
    Line,
)
from giveway.studies.execution.worker import SUMO_FILE
from giveway.studies.record import RunRecord

if TYPE_CHECKING:
    from giveway.studies.execution.limits import Limits
    from giveway.studies.record import Task

_POLL: Final = 0.25  # [s] between two looks at a worker that does not say anything
_DYING_WORDS: Final = 2.0  # [s] for a hanging worker to write where it hangs
_DYING: Final = 2.0  # [s] from a connection's end to that of its process
_MOST_PRINTED: Final = 1 << 26  # [bytes] after which what it prints is forgotten
_TAIL: Final = 4096  # [bytes] of which the last line is of interest
_GROWTH: Final = 256.0  # [MB] that a worker may hold more than after its first run
_FRAME: Final = re.compile(r'File "([^"]+)", line (\d+) in (\w+)')


class NotStartedError(Exception):
    """A worker has ended before it could do anything; the message tells what it printed."""


class IdleDeathError(Exception):
    """A worker has ended while it had nothing to do, or before it had begun with the run."""


class RunDiedError(Exception):
    """The run took its worker along; the message is the cause, on one line."""


class RunRaisedError(Exception):
    """The run has raised what no run raises on purpose; the message is one line."""


class WorkerProcess:
    """A process that makes one run at a time; for one thread, which lives longer than it.

    Args:
        folder: for this worker; made here, gone with it.
        limits: of its runs.

    Raises:
        OSError: it cannot be started.
    """

    def __init__(self, folder: Path, limits: Limits) -> None:
        self._limits = limits
        self._folder = folder
        self._poll = min(_POLL, limits.hang / 4, limits.run / 4)
        self._first_memory: float | None = None
        self._grown = False
        self._buried = False
        temporary = folder / "tmp"
        temporary.mkdir(parents=True)
        self._heartbeat = Heartbeat.supervised_by(os.getpid(), folder)
        self._printed = folder / STDERR_FILE
        self._printed_by_sumo = folder / SUMO_FILE
        # Appended to, so that it may be emptied while it is open.
        with self._printed.open("ab") as printed:
            self._process, connection = start(folder, temporary, printed)
        self._line = Line(connection)

    def await_ready(self) -> None:
        """Wait until it has imported everything.

        Raises:
            NotStartedError: it will not.
        """
        waited = 0.0
        try:
            while (message := self._line.receive(self._poll)) is None:
                waited += self._poll
                if self._process.poll() is not None:
                    raise EOFError
                if waited > START_LIMIT:
                    msg = f"it was not ready after {waited:g} s"
                    raise NotStartedError(msg)
            if message[0] != READY:
                raise GarbledError
        except (EOFError, GarbledError):
            cause = self._cause_of_death()
            raise NotStartedError(self._last_words() or cause) from None

    def perform(self, task: Task) -> RunRecord:
        """Make a run.

        Raises:
            IdleDeathError: the worker is dead, and the run had not begun.
            RunDiedError: the worker is dead, and the run is why.
            RunRaisedError: the worker lives, but should not be trusted any more.
            WorkerError: the worker would not make the run that was planned.
        """
        self._heartbeat.beat(Phase.STARTING)
        for printed in (self._printed, self._printed_by_sumo):
            with suppress(OSError):
                os.truncate(printed, 0)
        try:
            self._line.send(TASK, json.dumps(asdict(task)).encode())
            kind, payload = self._answer()
            if kind == REFUSED:
                raise WorkerError(payload.decode("utf-8", "replace"))
            if kind == ERROR:
                raise RunRaisedError(printable(payload.decode("utf-8", "replace")))
            if kind != RECORD:
                raise GarbledError
            record = RunRecord.from_json(payload.decode())
        except (EOFError, OSError):
            cause = self._cause_of_death()
        except (GarbledError, ValueError):
            cause = "native code wrote into files that are not its own"
            self.end()
        else:
            self._weigh(record.computing.memory)
            return record
        if self._heartbeat.read().phase is Phase.STARTING:
            raise IdleDeathError(cause)
        raise RunDiedError(self._obituary(cause))

    @property
    def overgrown(self) -> bool:
        """Whether it holds so much more memory than at first that a new one is better."""
        return self._grown

    def end(self) -> None:
        """Kill it, and its process group where there are groups; any number of times."""
        if self._buried:
            return  # its number may be somebody else's by now
        with suppress(OSError):
            if sys.platform == "win32":
                self._process.kill()
            else:
                os.killpg(self._process.pid, signal.SIGKILL)

    def bury(self) -> None:
        """End it, and remove what it has left; in its own thread."""
        self.end()
        self._process.wait()
        self._buried = True
        self._line.close()
        shutil.rmtree(self._folder, ignore_errors=True)

    def _answer(self) -> tuple[bytes, bytes]:
        """Wait for it; a worker whose run stands still or takes too long is killed."""
        stillness = Stillness(self._heartbeat)
        taken = 0.0
        while (message := self._line.receive(self._poll)) is None:
            taken += self._poll
            pulse, quiet = stillness.look(self._poll)
            if quiet >= self._limits.quiet(pulse.phase):
                self._kill(stood_still(quiet))
            elif taken >= self._limits.run:
                self._kill(f"not finished within {taken:g} s, the limit of a run,")
            if self._process.poll() is not None:  # what it has started may hold the connection
                raise EOFError
            with suppress(OSError):
                if self._printed.stat().st_size > _MOST_PRINTED:
                    os.truncate(self._printed, 0)
        return message

    def _kill(self, cause: str) -> None:
        """Let it say where it hangs, which takes a signal, then kill it.

        Raises:
            RunDiedError: always.
        """
        obituary = cause
        if sys.platform != "win32":
            with suppress(OSError):
                self._process.send_signal(signal.SIGABRT)
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(_DYING_WORDS)
        obituary = self._obituary(cause)
        self.end()
        raise RunDiedError(obituary)

    def _cause_of_death(self) -> str:
        """Why it has died, or why it has to be taken for dead."""
        try:
            code = self._process.wait(_DYING)
        except subprocess.TimeoutExpired:
            self.end()
            return "native code closed files that are not its own"
        self.end()  # whatever it has started
        return cause_of_end(code)

    def _obituary(self, cause: str) -> str:
        """Cause, place and last words, on one line."""
        pulse = self._heartbeat.read()
        place = "" if pulse.phase in LOOP else self._python_place()
        words = self._last_words()
        if not words and pulse.phase in {Phase.LOADING, Phase.SUMO}:
            words = self._last_words(self._printed_by_sumo)
        said = f", after printing '{words}'" if words else ""
        return f"{cause} {pulse.place}{place}{said}"

    def _python_place(self) -> str:
        """Where Python stood, if it could tell."""
        found = _FRAME.search(text_in(self._folder / TRACEBACK_FILE))
        if found is None:
            return ""
        file, line, function = found.groups()
        return f" (Python was in {function}, {Path(file).name} line {line})"

    def _last_words(self, printed: Path | None = None) -> str:
        """The last line that it printed."""
        printed = printed or self._printed
        try:
            with printed.open("rb") as file:
                file.seek(max(0, printed.stat().st_size - _TAIL))
                text = file.read().decode("utf-8", "replace")
        except OSError:
            return ""
        lines = (printable(line) for line in reversed(text.splitlines()))
        return next((line for line in lines if line), "")

    def _weigh(self, memory: float) -> None:
        if self._first_memory is None:
            self._first_memory = memory
        self._grown = memory > self._first_memory + _GROWTH
