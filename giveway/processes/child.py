"""The child's half of a supervised run: it says where it stands, and dies with its supervisor."""

from __future__ import annotations

import contextlib
import faulthandler
import os
import signal
import sys
import threading
import time
from pathlib import Path
from typing import IO, TYPE_CHECKING, Self

from giveway.processes.heartbeat import Heartbeat, Phase

if TYPE_CHECKING:
    from types import FrameType

JOURNAL_VARIABLE = "GIVEWAY_JOURNAL"  # names the journal's folder to the child
TRACEBACK_FILE = "traceback.txt"  # where Python stood when native code died
STDERR_FILE = "stderr.txt"  # what native code printed, kept here so that its last words are read
_PATIENCE = 10.0  # [s] after which a second Ctrl-C ends a process that did not heed the first
_ORPHAN_POLL = 1.0  # [s]
_PR_SET_PDEATHSIG = 1  # linux/prctl.h


def take_journal_folder() -> Path | None:
    """The folder a supervisor has named to this process; None: nobody supervises it.

    The variable is taken away: processes that this one starts are not the supervised run.
    """
    folder = os.environ.pop(JOURNAL_VARIABLE, None)
    return Path(folder) if folder and Path(folder).is_dir() else None


class Supervised:
    """The context, in the main thread, round everything that a supervised process does.

    An end that is not reported by leaving this context is a crash, even one with exit code 0.

    Args:
        folder: of the journal, from :func:`take_journal_folder`; with None the context does
            nothing.
    """

    def __init__(self, folder: Path | None) -> None:
        self._folder = folder
        self._heartbeat = Heartbeat(folder)
        self._traceback: IO[str] | None = None
        self._interrupted_at: float | None = None

    def __enter__(self) -> Self:
        if self._folder is None:
            return self
        self._heartbeat.beat(Phase.LOADING)
        die_with(self._heartbeat.read().supervisor)
        with contextlib.suppress(OSError):  # without a traceback the report is only shorter
            self._traceback = (self._folder / TRACEBACK_FILE).open("w", encoding="utf-8")
            faulthandler.enable(self._traceback)
        if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            signal.signal(signal.SIGINT, self._interrupt_once)
        return self

    def __exit__(self, _kind: object, error: BaseException | None, _traceback: object) -> None:
        if self._folder is not None:
            self._heartbeat.finish(_exit_code(error))

    def listen(self) -> None:
        """Let a Ctrl-C through that the supervisor has held back while Python started.

        Raises:
            KeyboardInterrupt: there has been one.
        """
        if self._folder is not None and sys.platform != "win32":
            signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})

    def _interrupt_once(self, number: int, frame: FrameType | None) -> None:
        """Ctrl-C reaches us from the terminal and again from the supervisor: it counts once."""
        now = time.monotonic()
        if self._interrupted_at is None:
            self._interrupted_at = now
            signal.default_int_handler(number, frame)
        elif now - self._interrupted_at > _PATIENCE:
            signal.signal(number, signal.SIG_DFL)
            signal.raise_signal(number)


def _exit_code(error: BaseException | None) -> int:
    """What Python will make of ``error`` when it ends the process."""
    if error is None:
        return 0
    if isinstance(error, SystemExit):
        return error.code if isinstance(error.code, int) else int(error.code is not None)
    return 1


def die_with(supervisor: int) -> None:
    """End this process at once when its supervisor has been killed; its rows are journalled.

    Linux does it itself, even while native code hangs, when the *thread* that started this process
    ends. On other Unixes a thread of this process does it, which has to wait while native code
    keeps Python's lock; Windows has no such relation between processes.

    Args:
        supervisor: its process id; 0 means that there is none.
    """
    if not supervisor or not hasattr(os, "getppid") or sys.platform == "win32":
        return
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != supervisor:  # it died before we asked
        os.kill(os.getpid(), signal.SIGKILL)
    if sys.platform != "linux":
        threading.Thread(target=_watch_parent, args=(supervisor,), daemon=True).start()


def _watch_parent(supervisor: int) -> None:
    while os.getppid() == supervisor:
        time.sleep(_ORPHAN_POLL)
    os.kill(os.getpid(), signal.SIGKILL)
