"""The child's side of a supervised run: it reports its state, and ends with its supervisor."""

import contextlib
import faulthandler
import os
import signal
import sys
import threading
import time
from pathlib import Path
from typing import IO, Self

from giveway.processes.heartbeat import Heartbeat, Phase
from giveway.processes.interrupts import ENDING, RaisedSignals, exit_code_of

JOURNAL_VARIABLE = "GIVEWAY_JOURNAL"  # Environment variable that holds the journal's folder
TRACEBACK_FILE = "traceback.txt"  # traceback of Python at the death of native code
STDERR_FILE = "stderr.txt"  # output of native code, kept for its last messages
_ORPHAN_POLL = 1.0  # Time [s] between two checks for the supervisor
_PR_SET_PDEATHSIG = 1  # linux/prctl.h


def take_journal_folder() -> Path | None:
    """Return the folder that a supervisor has named to this process, or None without one.

    The variable is removed, since processes that this one starts are not the supervised run.
    """
    folder = os.environ.pop(JOURNAL_VARIABLE, None)
    return Path(folder) if folder and Path(folder).is_dir() else None


_supervised = False


def is_supervised() -> bool:
    """Return whether another process supervises this one, so that a crash costs one run only."""
    return _supervised


class Supervised:
    """The context, in the main thread, for all work of a supervised process.

    An end without leaving this context is a crash, even with exit code 0.

    Args:
        folder: Folder of the journal, from :func:`take_journal_folder`; with None the context does
            nothing.
    """

    def __init__(self, folder: Path | None) -> None:
        self._folder = folder
        self._heartbeat = Heartbeat(folder)
        self._traceback: IO[str] | None = None
        self._signals = RaisedSignals(once=True)

    def __enter__(self) -> Self:
        if self._folder is None:
            return self
        self._heartbeat.beat(Phase.LOADING)
        die_with(self._heartbeat.read().supervisor)
        with contextlib.suppress(OSError):  # without a traceback, the report is only shorter
            self._traceback = (self._folder / TRACEBACK_FILE).open("w", encoding="utf-8")
            faulthandler.enable(self._traceback)
        self._signals.__enter__()  # never left: a second signal may come during the end
        return self

    def __exit__(self, _kind: object, error: BaseException | None, _traceback: object) -> None:
        if self._folder is not None:
            self._signals.raise_no_more()
            self._heartbeat.finish(_exit_code(error))

    def listen(self) -> None:
        """Let through a signal that the supervisor has blocked while Python started.

        Raises:
            KeyboardInterrupt: such a signal has come.
        """
        if self._folder is not None and sys.platform != "win32":
            signal.pthread_sigmask(signal.SIG_UNBLOCK, ENDING)


def _exit_code(error: BaseException | None) -> int:
    """Return the exit code with which Python will end after ``error``."""
    if error is None:
        return 0
    if isinstance(error, SystemExit):
        return error.code if isinstance(error.code, int) else int(error.code is not None)
    if isinstance(error, KeyboardInterrupt):
        return exit_code_of(error)
    return 1


def die_with(supervisor: int) -> None:
    """End this process when its supervisor has been killed.

    The rows of the run are in the journal. On Linux the system ends this process as soon as the
    *thread* that started it ends, even while native code hangs. On other Unixes a thread of this
    process does so, and has to wait while native code keeps Python's lock. On Windows this process
    goes on.

    Args:
        supervisor: Process id of the supervisor, or 0 without one.
    """
    global _supervised
    _supervised = bool(supervisor)
    if not supervisor or not hasattr(os, "getppid") or sys.platform == "win32":
        return
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != supervisor:  # the supervisor died before the request
        os.kill(os.getpid(), signal.SIGKILL)
    if sys.platform != "linux":
        threading.Thread(target=_watch_parent, args=(supervisor,), daemon=True).start()


def _watch_parent(supervisor: int) -> None:
    while os.getppid() == supervisor:
        time.sleep(_ORPHAN_POLL)
    os.kill(os.getpid(), signal.SIGKILL)
