"""The process host of Linux: a watchdog process forks the FMU's processes.

The watchdog imports what they need while the vehicle's own process goes on with other things.
"""

import os
import signal
import socket
import subprocess
from contextlib import suppress
from pathlib import Path
from typing import Final

from fmus.isolation.cleanup import kill_marked
from fmus.isolation.exit_report import ExitReport, decode_report
from fmus.isolation.spawning import (
    END_TIMEOUT,
    IMPORT_TIMEOUT,
    kill_group,
    no_process,
    spawn,
)
from fmus.isolation.wire import END_WORKER, MESSAGE, START_WORKER

_UNKNOWN_END: Final = ExitReport(None, killed=False, oom=False, printed="")


class LinuxHost:
    """Has a watchdog process fork the FMU's processes; see :mod:`fmus.isolation.watchdog`.

    Args:
        path: of the FMU.
        folder: temporary; the watchdog removes it when this process has ended.
    """

    def __init__(self, path: Path, folder: Path) -> None:
        self._path, self._folder = path, folder
        self._owner = os.getpid()
        self._log = folder / "watchdog.log"
        self._start_watchdog()

    def start_process(self) -> socket.socket:
        """See :class:`fmus.isolation.process_host.ProcessHost`."""
        try:
            return self._request_worker()
        except OSError:
            proven = self._has_answered
            self._stop_watchdog()
        if proven:  # it has worked before, so the FMU of the last episode has killed it
            self._start_watchdog()
            with suppress(OSError):
                return self._request_worker()
        raise no_process(self._path, self._log.read_bytes() if self._log.exists() else b"")

    def end_process(self, patience: float = 0.0) -> ExitReport:
        """See :class:`fmus.isolation.process_host.ProcessHost`."""
        try:
            ms = b"%d" % round(1e3 * patience)
            return decode_report(self._ask(END_WORKER, ms, patience + END_TIMEOUT))
        except (OSError, ValueError, TypeError):
            kill_marked(self._folder)
            return _UNKNOWN_END

    def close(self) -> None:
        """See :class:`fmus.isolation.process_host.ProcessHost`."""
        self._stop_watchdog()

    def _start_watchdog(self) -> None:
        """Start a watchdog process."""
        self._number = 0  # of the last request
        self._has_answered = False  # at least once
        self._control, control = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        arguments = ("watchdog", control.fileno(), self._owner, self._folder)
        with control, self._log.open("wb") as log:
            self._process = spawn(
                self._path,
                *arguments,
                folder=self._folder,
                output=log,
                pass_fds=(control.fileno(),),
            )

    def _stop_watchdog(self) -> None:
        """End the watchdog: closing its socket ends it and all that it watches over."""
        self._resume_watchdog()
        self._control.close()
        if not self._has_answered:  # it is still importing and would not notice the closed socket
            self._process.kill()
        try:
            self._process.wait(END_TIMEOUT)
        except subprocess.TimeoutExpired:
            kill_group(self._process)
        if self._process.returncode:  # it was killed, so it could not clean up
            kill_marked(self._folder)

    def _resume_watchdog(self) -> None:
        """Let the watchdog go on: an FMU may have stopped it with a signal."""
        with suppress(OSError):
            self._process.send_signal(signal.SIGCONT)

    def _request_worker(self) -> socket.socket:
        here, there = socket.socketpair()
        try:
            with there:
                self._ask(START_WORKER, b"0", IMPORT_TIMEOUT, there.fileno())
        except BaseException:
            here.close()
            raise
        self._has_answered = True
        return here

    def _ask(self, what: bytes, argument: bytes, timeout: float, *files: int) -> bytes:
        """The watchdog's answer; answers to earlier, interrupted requests are skipped."""
        self._number += 1
        self._resume_watchdog()
        self._control.settimeout(timeout)
        socket.send_fds(self._control, [b"%d %s %s" % (self._number, what, argument)], files)
        while True:
            message = self._control.recv(MESSAGE)
            number, _, answer = message.partition(b" ")
            if not message:
                raise ConnectionResetError
            if int(number) == self._number:
                return answer
