"""The keeper with a guardian process, which imports what is needed while others go on (Linux)."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
from contextlib import suppress
from typing import TYPE_CHECKING, Final

from fmus.isolation.cleanup import kill_marked
from fmus.isolation.exit_report import Death, decoded
from fmus.isolation.spawning import (
    DEATH_TIMEOUT,
    IMPORT_TIMEOUT,
    kill_group,
    no_process,
    spawn,
)
from fmus.isolation.wire import BURY, FORK, MESSAGE

if TYPE_CHECKING:
    from pathlib import Path

_LOST: Final = Death(None, killed=False, oom=False, printed="")


class GuardedKeeper:
    """Forks of a guardian process; see :mod:`fmus.isolation.watchdog`.

    Args:
        path: of the FMU.
        folder: temporary; the guardian removes it when this process is gone.
    """

    def __init__(self, path: Path, folder: Path) -> None:
        self._path, self._folder = path, folder
        self._owner = os.getpid()
        self._log = folder / "guardian.log"
        self._employ()

    def begin(self) -> socket.socket:
        """See :class:`fmus.isolation.process_host.Keeper`."""
        try:
            return self._begin()
        except OSError:
            proven = self._proven
            self._dismiss()
        if proven:  # the FMU of the last episode has killed it
            self._employ()
            with suppress(OSError):
                return self._begin()
        raise no_process(self._path, self._log.read_bytes() if self._log.exists() else b"")

    def bury(self, patience: float = 0.0) -> Death:
        """See :class:`fmus.isolation.process_host.Keeper`."""
        try:
            ms = b"%d" % round(1e3 * patience)
            return decoded(self._ask(BURY, ms, patience + DEATH_TIMEOUT))
        except (OSError, ValueError, TypeError):
            kill_marked(self._folder)
            return _LOST

    def close(self) -> None:
        """See :class:`fmus.isolation.process_host.Keeper`."""
        self._dismiss()

    def _employ(self) -> None:
        """Have a guardian."""
        self._number = 0  # of the last question
        self._proven = False  # it has answered
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

    def _dismiss(self) -> None:
        """Have none: it ends, with all that it watches over, when the socket is closed."""
        self._wake()
        self._control.close()
        if not self._proven:  # still importing
            self._process.kill()
        try:
            self._process.wait(DEATH_TIMEOUT)
        except subprocess.TimeoutExpired:
            kill_group(self._process)
        if self._process.returncode:  # it was killed itself
            kill_marked(self._folder)

    def _wake(self) -> None:
        """An FMU may have stopped it."""
        with suppress(OSError):
            self._process.send_signal(signal.SIGCONT)

    def _begin(self) -> socket.socket:
        here, there = socket.socketpair()
        try:
            with there:
                self._ask(FORK, b"0", IMPORT_TIMEOUT, there.fileno())
        except BaseException:
            here.close()
            raise
        self._proven = True
        return here

    def _ask(self, what: bytes, argument: bytes, timeout: float, *files: int) -> bytes:
        """The guardian's answer; those to questions that were interrupted are passed over."""
        self._number += 1
        self._wake()
        self._control.settimeout(timeout)
        socket.send_fds(self._control, [b"%d %s %s" % (self._number, what, argument)], files)
        while True:
            message = self._control.recv(MESSAGE)
            number, _, answer = message.partition(b" ")
            if not message:
                raise ConnectionResetError
            if int(number) == self._number:
                return answer
