"""The process host of Linux: a watchdog process forks the FMU's processes.

The watchdog imports the needed modules while the vehicle's own process does other work.
"""

import socket
from contextlib import suppress
from pathlib import Path
from typing import Final

from fmus.isolation.cleanup import LOG
from fmus.isolation.exit_report import ExitReport, decode_report
from fmus.isolation.spawning import END_TIMEOUT, IMPORT_TIMEOUT, no_process
from fmus.isolation.watchdog_process import WatchdogProcess, let_wait, watchdog_for
from fmus.isolation.wire import END_WORKER, START_WORKER

_UNKNOWN_END: Final = ExitReport(None, killed=False, oom=False, printed="")


class LinuxHost:
    """A host whose watchdog process forks the FMU's processes; see :mod:`fmus.isolation.watchdog`.

    Args:
        path: Path of the FMU.
        folder: Temporary folder, which the watchdog removes when this process has ended.

    Attributes:
        sound: True as long as the FMU has not crashed, hung or broken its connection.
    """

    def __init__(self, path: Path, folder: Path) -> None:
        self.sound = True
        self._path, self._folder = path, folder
        self._watchdog = watchdog_for(path, folder)

    def start_process(self) -> socket.socket:
        """Start a new process, as :class:`fmus.isolation.portable_host.PortableHost` does."""
        try:
            return self._request_worker()
        except OSError:
            proven = self._watchdog.has_answered
            self._watchdog.end()
        if proven:  # it has worked before, so the FMU of the last episode has killed the watchdog
            self._watchdog = WatchdogProcess(self._path, self._folder)
            with suppress(OSError):
                return self._request_worker()
        log = self._folder / LOG
        raise no_process(self._path, log.read_bytes() if log.exists() else b"")

    def end_process(self, patience: float = 0.0) -> ExitReport:
        """End the process, as :class:`fmus.isolation.portable_host.PortableHost` does."""
        try:
            ms = b"%d" % round(1e3 * patience)
            return decode_report(self._watchdog.ask(END_WORKER, ms, patience + END_TIMEOUT))
        except (OSError, ValueError, TypeError):
            self.sound = False
            self._watchdog.kill_workers()
            return _UNKNOWN_END

    def close(self) -> None:
        """End everything and wait until it has ended."""
        if not (self.sound and let_wait(self._watchdog)):
            self._watchdog.end()

    def _request_worker(self) -> socket.socket:
        here, there = socket.socketpair()
        try:
            with there:
                self._watchdog.ask(START_WORKER, b"0", IMPORT_TIMEOUT, there.fileno())
        except BaseException:
            here.close()
            raise
        return here
