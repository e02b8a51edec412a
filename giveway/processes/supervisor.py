"""The supervision of a run in a process of its own, so that its crash can be reported.

SUMO, the FMU and the solvers are native code: they can end their process by a signal or by an
``exit()`` in the middle of a step, or never return. The supervisor starts the run as a child that
shares its terminal, waits, and reports how it ended. The rows are in the journal. This module
imports little, since it only waits.
"""

import contextlib
import errno
import math
import os
import shutil
import stat
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Self

from giveway.processes.causes import WINDOWS_CAUSES, cause_of_end, let_speak, stood_still, text_in
from giveway.processes.child import JOURNAL_VARIABLE, STDERR_FILE, TRACEBACK_FILE
from giveway.processes.heartbeat import LOOP, SETTING_UP, Heartbeat, Phase, Pulse, Stillness
from giveway.processes.interrupts import DeferredInterrupt, deaf_children
from giveway.processes.locks import in_use, locked
from giveway.processes.relay import Relay

HANG_LIMIT = 120.0  # Wall-clock limit [s] without a sign of life from the loop
_PREFIX = "giveway-journal-"
# Time [s] for which the journal of a killed supervisor is kept for "giveway recover"
_KEPT = 7 * 86400.0
# Time limit [s] from "done" to the process's end, since native destructors may hang
_TEARDOWN_LIMIT = 10.0
_POLL = 1.0  # Time [s] between two readings of the heartbeat
_SIGNALLED = 128  # the exit code in a shell of a process that died of signal n is 128 + n
_SHOW_CURSOR = "\r\x1b[2K\x1b[?25h"  # shows the cursor that a progress bar has hidden


@dataclass(frozen=True)
class Verdict:
    """The end of a supervised process.

    Attributes:
        code: Exit code to pass on: the child's own, or 128 + n for a signal, as in a shell. It is
            never 0 after a crash.
        crashed: True if it ended without reporting its end; its recorded rows are in the journal.
        interrupted: True if it ended by a signal that the user sent, or after one.
        cause: "SIGSEGV", "no progress for 120 s", ...; empty unless it crashed.
        pulse: Last state of its heartbeat.
        traceback: Traceback of Python by faulthandler; empty without one.
        last_words: Output of native code on the standard error of the child, if kept.
        signal: Number of the first signal that the user has sent, or 0 without one.
    """

    code: int
    crashed: bool
    interrupted: bool
    cause: str
    pulse: Pulse
    traceback: str
    last_words: str
    signal: int = 0

    @property
    def message(self) -> str:
        """The cause and place on one line: "SIGSEGV inside SUMO's step from 12.30 s (step 246)"."""
        return f"{self.cause} {self.pulse.place}" if self.crashed else ""


@contextlib.contextmanager
def journal_folder() -> Iterator[Path]:
    """Provide a folder for a journal, which is removed unless its heartbeat asks to keep it.

    It is a local temporary folder and not the results folder. That may be on a network disk (the
    journal is written at every control step), and it is not known before the configuration has been
    read.

    Raises:
        OSError: the folder cannot be made.
    """
    place = journal_place()
    _sweep(place)
    folder = place / f"{_PREFIX}{os.urandom(6).hex()}"
    try:
        folder.mkdir(mode=0o700)
        with locked(folder):
            yield folder
    finally:
        with DeferredInterrupt():
            kept = False
            with contextlib.suppress(OSError):
                kept = Heartbeat(folder).kept
            shutil.rmtree(temporary_in(folder) if kept else folder, ignore_errors=True)


def journal_place() -> Path:
    """Return the folder of all journals.

    ``TMPDIR`` comes first, then ``/var/tmp``, then ``/tmp``, which often is in memory that the run
    needs.
    """
    large = Path("/var/tmp")
    named = os.environ.get("TMPDIR") or not os.access(large, os.W_OK)
    return Path(tempfile.gettempdir()) if named else large


def journals() -> list[Path]:
    """Return the folders of this user's journals whose supervisors are gone, oldest first."""
    found: list[tuple[float, Path]] = []
    for folder in journal_place().glob(f"{_PREFIX}*"):
        with contextlib.suppress(OSError):
            if _is_own(folder) and not in_use(folder):
                found.append((folder.stat().st_mtime, folder))
    return [folder for _, folder in sorted(found)]


def _is_own(folder: Path) -> bool:
    """Return whether a path is a folder of this user, and not a link to one.

    Raises:
        OSError: it cannot be examined.
    """
    found = folder.lstat()
    return stat.S_ISDIR(found.st_mode) and found.st_uid == getattr(os, "getuid", lambda: 0)()


def verdict_on_left(journal: Path) -> Verdict:
    """Return the verdict on a process whose supervisor was killed, too.

    Raises:
        OSError: the folder cannot be read.
    """
    pulse = Heartbeat(journal).read()
    traceback, last_words = (text_in(journal / name) for name in (TRACEBACK_FILE, STDERR_FILE))
    return Verdict(1, True, False, "killed, with its supervisor,", pulse, traceback, last_words)


def _sweep(place: Path) -> None:
    """Remove the journals that have not been used for a week; those in use are locked."""
    with contextlib.suppress(OSError):
        for folder in place.glob(f"{_PREFIX}*"):
            if not _is_own(folder):
                continue
            written = max((file.lstat().st_mtime for file in folder.iterdir()), default=math.inf)
            if time.time() - written > _KEPT and not in_use(folder):
                shutil.rmtree(folder, ignore_errors=True)


def own_command() -> list[str]:
    """Return the command of this process, with interpreter options."""
    return [sys.executable, *sys.orig_argv[1:]]


def supervise(
    command: Sequence[str],
    journal: Path,
    *,
    hang_limit: float = HANG_LIMIT,
    output: int | None = None,
) -> Verdict:
    """Run ``command`` as a child on the same terminal and wait for its end.

    The child enters :class:`giveway.processes.child.Supervised`. Signals that ask this process to
    end are passed on. A child in native code, such as SUMO that loads a network, does not hear
    them: after 2 s the user is told so, and a second one kills it. If this process is killed, so is
    the child.

    Args:
        command: Program and arguments; the child finds the journal in ``GIVEWAY_JOURNAL``.
        journal: Existing folder for the journal.
        hang_limit: Wall-clock time [s] without a sign of life from the loop after which the child
            is killed; infinity waits for ever.
        output: File descriptor for standard output and standard error of the child, which then
            reads nothing; None for those of this process.

    Raises:
        OSError: the child cannot be started, or the heartbeat cannot be made.
    """
    heartbeat = Heartbeat.supervised_by(os.getpid(), journal)
    environment = os.environ | {JOURNAL_VARIABLE: str(journal), **_temporary(journal)}
    with Relay() as relay:
        # Like any program on this terminal: same process group, same files (also <(...)).
        with deaf_children():  # until `Supervised.listen`
            child = subprocess.Popen(
                command,
                env=environment,
                close_fds=False,
                stdin=None if output is None else subprocess.DEVNULL,
                stdout=output,
                stderr=output,
            )
        try:
            with _Watchdog(child, heartbeat, hang_limit, relay) as watchdog:
                relay.connect(child)
                child.wait()
        except BaseException:  # a child without a supervisor must not stay
            child.kill()
            child.wait()
            raise
    pulse = heartbeat.read()
    verdict = _judge(child.returncode, pulse, watchdog, relay, journal)
    if verdict.crashed and sys.stdout.isatty():
        with contextlib.suppress(OSError):
            sys.stdout.write(_SHOW_CURSOR)
            sys.stdout.flush()
    return verdict


def temporary_in(journal: Path) -> Path:
    """Return the temporary folder of the process that writes the journal."""
    return journal / "tmp"


def _temporary(journal: Path) -> dict[str, str]:
    """Return variables that name the child's temporary folder, removed with the journal."""
    folder = temporary_in(journal)
    folder.mkdir(exist_ok=True)
    return dict.fromkeys(("TMPDIR", "TEMP", "TMP"), str(folder))


class _Watchdog:
    """Reads the heartbeat once a second, and kills a child whose loop stands still.

    Attributes:
        waited: Time [s] without a sign of life before the kill, or 0 if the child was not killed.
    """

    def __init__(
        self,
        child: subprocess.Popen[bytes],
        heartbeat: Heartbeat,
        hang_limit: float,
        relay: Relay,
    ) -> None:
        self.waited = 0.0
        self._relay = relay
        self._child = child
        self._heartbeat = heartbeat
        self._hang_limit = hang_limit
        self._poll = min(_POLL, hang_limit / 4)
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)

    def __enter__(self) -> Self:
        try:
            self._thread.start()
        except RuntimeError as error:  # Python's error if the system gives no thread
            raise OSError(errno.EAGAIN, os.strerror(errno.EAGAIN)) from error
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self._thread.join()

    def _limit(self, phase: Phase) -> float:
        if phase in LOOP:
            return self._hang_limit
        set_up = SETTING_UP * self._hang_limit
        return {Phase.LOADING: set_up, Phase.DONE: _TEARDOWN_LIMIT}.get(phase, math.inf)

    def _watch(self) -> None:
        stillness = Stillness(self._heartbeat)
        while not self._over.wait(self._poll):
            pulse, quiet = stillness.look(self._poll)
            self._relay.tell(pulse.place)
            if quiet >= self._limit(pulse.phase):
                self.waited = quiet
                let_speak(self._child)
                self._child.kill()
                return


def _judge(
    returncode: int, pulse: Pulse, watchdog: _Watchdog, relay: Relay, journal: Path
) -> Verdict:
    interrupted = relay.first is not None
    if pulse.phase is Phase.DONE:
        code = pulse.code or max(returncode, 0)
        return Verdict(code, False, interrupted, "", pulse, "", "", relay.first or 0)
    if pulse.phase is Phase.STARTING and 0 < returncode < min(WINDOWS_CAUSES):
        # Python ended before it came to giveway's code, and has printed the reason.
        return Verdict(returncode, False, interrupted, "", pulse, "", "", relay.first or 0)
    return Verdict(
        code=_passed_on(returncode, relay),
        crashed=True,
        interrupted=interrupted and not watchdog.waited,
        cause=_cause(returncode, watchdog, relay),
        pulse=pulse,
        traceback=text_in(journal / TRACEBACK_FILE),
        last_words=text_in(journal / STDERR_FILE),
        signal=relay.first or 0,
    )


def _passed_on(returncode: int, relay: Relay) -> int:
    if relay.first is not None:
        return _SIGNALLED + relay.first
    if returncode < 0:
        return _SIGNALLED - returncode
    return returncode if 0 < returncode < _SIGNALLED else 1


def _cause(returncode: int, watchdog: _Watchdog, relay: Relay) -> str:
    if relay.killed:
        return "killed by a second interrupt"
    if watchdog.waited:
        return stood_still(watchdog.waited)
    return cause_of_end(returncode)
