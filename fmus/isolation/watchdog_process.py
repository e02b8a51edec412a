"""The watchdog processes as their clients see them: of a vehicle, or waiting for one (Linux)."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from fmus.isolation.cleanup import LOG, kill_marked
from fmus.isolation.spawning import END_TIMEOUT, IMPORT_TIMEOUT, kill_group, spawn
from fmus.isolation.wire import MESSAGE, RETIRE, SERVE

_waiting: Final[list[WatchdogProcess]] = []
_scopes: Final[list[None]] = []


class WatchdogProcess:
    """A watchdog process (:mod:`fmus.isolation.watchdog`), which imports while its vehicle goes on.

    Args:
        path: Path of the FMU, for errors.
        folder: Temporary folder of the vehicle, which the watchdog removes when this process has
            ended.

    Attributes:
        process: Process of the watchdog.
        has_answered: True after its first answer.

    Raises:
        FmuCrashError: the watchdog cannot be started.
    """

    def __init__(self, path: Path, folder: Path) -> None:
        self.has_answered = False
        self._number = 0  # number of the last request
        self._owner, self._setting = os.getpid(), _setting()
        self._folders = [folder]  # the folder whose TMPDIR it was started with, and the present one
        self._control, control = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        arguments = ("watchdog", control.fileno(), self._owner, folder)
        with control, (folder / LOG).open("wb") as log:
            self.process = spawn(
                path, *arguments, folder=folder, output=log, pass_fds=(control.fileno(),)
            )

    def ask(self, what: bytes, argument: bytes, timeout: float, *files: int) -> bytes:
        """Return the answer to a request; answers to earlier, interrupted requests are skipped.

        Args:
            what: Kind of the request.
            argument: Argument of the request.
            timeout: Time limit [s].
            files: Files to be handed over.

        Raises:
            OSError: there is no answer.
        """
        self._number += 1
        self._resume()
        self._control.settimeout(timeout)
        socket.send_fds(self._control, [b"%d %s %s" % (self._number, what, argument)], files)
        while True:
            message = self._control.recv(MESSAGE)
            number, _, answer = message.partition(b" ")
            if not message:
                raise ConnectionResetError
            if int(number) == self._number:
                self.has_answered = True
                return answer

    def end(self) -> None:
        """End the watchdog by closing its socket; this ends all processes that it watches, too."""
        self._resume()
        self._control.close()
        if not self.has_answered:  # it is still importing and would not notice the closed socket
            self.process.kill()
        try:
            self.process.wait(END_TIMEOUT)
        except subprocess.TimeoutExpired:
            kill_group(self.process)
        if self.process.returncode:  # it was killed, so it could not clean up
            self.kill_workers()

    def kill_workers(self) -> None:
        """Kill the processes that the watchdog watches, without its help."""
        for folder in self._folders:
            kill_marked(folder)

    def serve(self, folder: Path) -> bool:
        """Serve another vehicle in its ``folder``; return False if the watchdog must be ended."""
        if self._setting != _setting() or self.process.poll() is not None:
            return False
        self._folders[1:] = [folder]
        return self._does(SERVE, os.fsencode(folder), IMPORT_TIMEOUT)

    def retire(self) -> bool:
        """End the vehicle's process and remove its folder; the result is as for :meth:`serve`."""
        return self._does(RETIRE, b"", END_TIMEOUT)

    def is_ours(self) -> bool:
        """Return whether this process has started the watchdog, and is not a fork of it."""
        return self._owner == os.getpid()

    def _does(self, what: bytes, argument: bytes, timeout: float) -> bool:
        try:
            self.ask(what, argument, timeout)
        except (OSError, ValueError):
            return False
        return True

    def _resume(self) -> None:
        """Let the watchdog go on, since an FMU may have stopped it with a signal."""
        with suppress(OSError):
            self.process.send_signal(signal.SIGCONT)


def _setting() -> object:
    """Return the settings that a watchdog takes over from the process that starts it."""
    return dict(os.environ), list(sys.path)


@contextmanager
def processes_reused() -> Iterator[None]:
    """Reuse watchdogs within this context: the watchdog of a closed vehicle serves the next one.

    The watchdog has imported everything and has never run an FMU; each start of an FMU is a new
    process. The watchdog of an FMU that has crashed, hung or broken its connection is ended. All
    waiting watchdogs end with the outermost context. Other systems than Linux have no watchdogs.
    """
    _scopes.append(None)
    try:
        yield
    finally:
        _scopes.pop()
        while not _scopes and _waiting:
            one = _waiting.pop()
            if one.is_ours():
                one.end()


def watchdog_for(path: Path, folder: Path) -> WatchdogProcess:
    """Return a watchdog for a vehicle: a waiting one, or a new one."""
    while _waiting:
        one = _waiting.pop()
        if one.is_ours():
            if one.serve(folder):
                return one
            one.end()
    return WatchdogProcess(path, folder)


def let_wait(watchdog: WatchdogProcess) -> bool:
    """Let the watchdog of a closed vehicle wait for the next; return False if it must be ended."""
    if not (_scopes and watchdog.is_ours() and watchdog.retire()):
        return False
    _waiting.append(watchdog)
    return True
