"""A worker's process as its study sees it: it is given runs, watched and ended."""

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
from typing import Final

from fmus.text import printable
from giveway.processes.causes import cause_of_end, let_speak, stood_still, text_in
from giveway.processes.child import STDERR_FILE, TRACEBACK_FILE
from giveway.processes.heartbeat import LOOP, Heartbeat, Phase, Stillness
from giveway.studies.execution.executor import WorkerError
from giveway.studies.execution.limits import Limits
from giveway.studies.execution.worker_messages import (
    ERROR,
    READY,
    RECORD,
    REFUSED,
    TASK,
    GarbledError,
    Line,
)
from giveway.studies.execution.worker_program import SUMO_FILE
from giveway.studies.execution.worker_start import START_LIMIT, start
from giveway.studies.record import RunRecord, Task

_POLL: Final = 0.25  # Time [s] between two checks of a worker that sends nothing
_ENDING: Final = 2.0  # Time [s] between the end of a connection and the end of its process
_MOST_PRINTED: Final = 1 << 26  # Size [bytes] of the output at which it is dropped
_TAIL: Final = 4096  # Bytes at the end in which the last line is searched
# Growth [MB] of a worker's memory after its first run at which it is replaced
_GROWTH: Final = 256.0
_FRAME: Final = re.compile(r'File "([^"]+)", line (\d+) in (\w+)')


class NotBegunError(Exception):
    """A worker ended before it began a run; the message gives the reason."""


class RunDiedError(Exception):
    """The run ended its worker; the message is the cause, on one line."""


class RunRaisedError(Exception):
    """The run has raised an unexpected exception; the message is one line."""


class WorkerProcess:
    """A process that makes one run at a time; one thread uses it, and ends after it.

    Args:
        folder: Folder for this worker; it is made here, and removed with the worker.
        limits: Time limits of its runs.

    Attributes:
        overgrown: True if the worker's memory has grown so much that it should be replaced.

    Raises:
        OSError: the process cannot be started.
    """

    def __init__(self, folder: Path, limits: Limits) -> None:
        self._limits = limits
        self._folder = folder
        self._poll = min(_POLL, limits.hang / 4, limits.run / 4)
        self._first_memory: float | None = None
        self.overgrown = False
        self._removed = False
        temporary = folder / "tmp"
        temporary.mkdir(parents=True)
        self._heartbeat = Heartbeat.supervised_by(os.getpid(), folder)
        self._printed = folder / STDERR_FILE
        self._printed_by_sumo = folder / SUMO_FILE
        # Opened for appending, so that the file may be emptied while it is open.
        with self._printed.open("ab") as printed:
            self._process, connection = start(folder, temporary, printed)
        self._line = Line(connection)

    def await_ready(self) -> None:
        """Wait until the worker has finished its imports.

        Raises:
            NotBegunError: the worker has ended, or takes too long.
        """
        waited = 0.0
        try:
            while (message := self._line.receive(self._poll)) is None:
                waited += self._poll
                if self._process.poll() is not None:
                    raise EOFError
                if waited > (self._limits.hang if self._is_stopped() else START_LIMIT):
                    raise NotBegunError(f"it was not ready after {waited:g} s")
            if message[0] != READY:
                raise GarbledError
        except (EOFError, GarbledError):
            cause = self._cause_of_end()
            raise NotBegunError(self._last_printed() or cause) from None

    def perform(self, task: Task) -> RunRecord:
        """Make a run.

        Raises:
            NotBegunError: the worker has ended before the run began.
            RunDiedError: the run has ended the worker.
            RunRaisedError: the run has raised an exception; the worker should not be used again.
            WorkerError: the worker would make another run than the planned one.
        """
        self._heartbeat.beat(Phase.STARTING)
        for printed in (self._printed, self._printed_by_sumo):
            with suppress(OSError):
                os.truncate(printed, 0)
        try:
            self._line.send(TASK, json.dumps(asdict(task)).encode(), self._limits.hang)
            kind, payload = self._answer()
            if kind == REFUSED:
                raise WorkerError(payload.decode("utf-8", "replace"))
            if kind == ERROR:
                raise RunRaisedError(printable(payload.decode("utf-8", "replace")))
            if kind != RECORD:
                raise GarbledError
            record = RunRecord.from_json(payload.decode())
        except TimeoutError:
            self.end()
            cause = stood_still(self._limits.hang)
        except (EOFError, OSError):
            cause = self._cause_of_end()
        except (GarbledError, ValueError):
            cause = "native code wrote into files that are not its own"
            self.end()
        else:
            self._note_memory(record.computing.memory)
            return record
        if self._heartbeat.read().phase is Phase.STARTING:
            raise NotBegunError(cause)
        raise RunDiedError(self._failure(cause))

    def end(self) -> None:
        """Kill the worker, with its process group if the system has groups.

        It may be called repeatedly.
        """
        if self._removed:
            return  # another process may have this process id by now
        with suppress(OSError):
            if sys.platform == "win32":
                self._process.kill()
            else:
                os.killpg(self._process.pid, signal.SIGKILL)

    def remove(self) -> None:
        """End the worker, and remove its folder.

        It has to be called in the thread that uses the worker.
        """
        self.end()
        self._process.wait()
        self._removed = True
        self._line.close()
        shutil.rmtree(self._folder, ignore_errors=True)

    def _answer(self) -> tuple[bytes, bytes]:
        """Wait for the answer, and kill a worker whose run stands still or takes too long."""
        stillness = Stillness(self._heartbeat)
        taken = 0.0
        while (message := self._line.receive(self._poll)) is None:
            taken += self._poll
            pulse, quiet = stillness.look(self._poll)
            if quiet >= self._limits.quiet(pulse.phase, stopped=self._is_stopped()):
                self._kill(stood_still(quiet))
            elif taken >= self._limits.run:
                self._kill(f"not finished within {taken:g} s, the limit of a run,")
            # a child of the worker may hold the connection open
            if self._process.poll() is not None:
                raise EOFError
            with suppress(OSError):
                if self._printed.stat().st_size > _MOST_PRINTED:
                    os.truncate(self._printed, 0)
        return message

    def _is_stopped(self) -> bool:
        """Return whether somebody has stopped the process, as SIGSTOP does."""
        with suppress(AttributeError, ChildProcessError):  # some systems cannot tell
            options = os.WSTOPPED | os.WNOHANG | os.WNOWAIT
            return os.waitid(os.P_PID, self._process.pid, options) is not None
        return False

    def _kill(self, cause: str) -> None:
        """Let the worker write where it hangs, then kill it.

        Raises:
            NotBegunError: the worker had not taken the run.
            RunDiedError: it had.
        """
        if not self._is_stopped():
            let_speak(self._process)
        failure = self._failure(cause)
        begun = self._heartbeat.read().phase is not Phase.STARTING
        self.end()
        raise (RunDiedError if begun else NotBegunError)(failure)

    def _cause_of_end(self) -> str:
        """Return the reason why the worker has ended, or counts as ended."""
        try:
            code = self._process.wait(_ENDING)
        except subprocess.TimeoutExpired:
            self.end()
            return "native code closed files that are not its own"
        self.end()  # also ends the processes that the worker has started
        return cause_of_end(code)

    def _failure(self, cause: str) -> str:
        """Return the cause, the place and the last printed line as one line."""
        pulse = self._heartbeat.read()
        place = "" if pulse.phase in LOOP else self._python_place()
        words = self._last_printed()
        if not words and pulse.phase in {Phase.LOADING, Phase.SUMO}:
            words = self._last_printed(self._printed_by_sumo)
        said = f", after printing '{words}'" if words else ""
        return f"{cause} {pulse.place}{place}{said}"

    def _python_place(self) -> str:
        """Return the last Python frames before the end, if Python could write them."""
        found = _FRAME.search(text_in(self._folder / TRACEBACK_FILE))
        if found is None:
            return ""
        file, line, function = found.groups()
        return f" (Python was in {function}, {Path(file).name} line {line})"

    def _last_printed(self, printed: Path | None = None) -> str:
        """Return the last line that the worker printed."""
        printed = printed or self._printed
        try:
            with printed.open("rb") as file:
                file.seek(max(0, printed.stat().st_size - _TAIL))
                text = file.read().decode("utf-8", "replace")
        except OSError:
            return ""
        lines = (printable(line) for line in reversed(text.splitlines()))
        return next((line for line in lines if line), "")

    def _note_memory(self, memory: float) -> None:
        if self._first_memory is None:
            self._first_memory = memory
        self.overgrown = memory > self._first_memory + _GROWTH
