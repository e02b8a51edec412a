"""The report of how an FMU's process ended, as numbers and in words."""

import json
import signal
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

from fmus.isolation.wire import CONNECTION_LOST
from fmus.text import printable

_WORDS: Final = {
    "SIGSEGV": "a segmentation fault (SIGSEGV: a bad address, or the stack overflowed)",
    "SIGBUS": "a bus error (SIGBUS: a bad address, or the stack overflowed)",
    "SIGABRT": "abort (SIGABRT: it gave up itself, or its memory is corrupted)",
    "SIGFPE": "an arithmetic trap (SIGFPE: division by zero or a floating-point exception)",
    "SIGILL": "an illegal instruction (SIGILL: built for another processor, or a trap)",
}
_TAIL: Final = 4096  # [bytes]


@dataclass(frozen=True)
class ExitReport:
    """The way in which a process ended.

    Attributes:
        code: Exit status of the process, or minus the signal that killed it. None if it is unknown
            because the watchdog is dead, too.
        killed: True if giveway killed it.
        oom: True if the system killed a process for lack of memory in the meantime.
        printed: Last line that it printed; empty without one.
    """

    code: int | None
    killed: bool
    oom: bool
    printed: str

    def encoded(self) -> bytes:
        """Return the report as bytes, for :func:`decode_report`."""
        return json.dumps(asdict(self)).encode()

    @property
    def cause(self) -> str:
        """Return a predicate such as 'died of ...', to follow a subject."""
        if self.code is None:
            return "killed the process that watches over it"
        if self.killed or self.code == CONNECTION_LOST:
            return "closed files that are not its own, or ended giveway's Python"
        if self.code >= 0:
            return f"ended itself: exit({self.code}) was called"
        try:
            name = signal.Signals(-self.code).name
        except ValueError:
            name = f"signal {-self.code}"
        if name == "SIGKILL" and self.oom:
            return "was killed by the system for lack of memory (SIGKILL)"
        return f"died of {_WORDS.get(name, name)}"

    @property
    def after_printing(self) -> str:
        """Return a clause ', after printing ...', or an empty text if nothing was printed."""
        return f", after printing '{self.printed}'" if self.printed else ""


def decode_report(message: bytes) -> ExitReport:
    """Return the report from the bytes of :meth:`ExitReport.encoded`."""
    return ExitReport(**json.loads(message))


class PrintedTail:
    """Keeps the end of what a process has printed."""

    def __init__(self) -> None:
        self._end = b""

    def add(self, piece: bytes) -> None:
        """Add another piece of output."""
        self._end = (self._end + piece)[-_TAIL:]

    def last_line(self) -> str:
        """Return the last line that is not blank, made fit for a message, or an empty text."""
        lines = (
            printable(line) for line in reversed(self._end.decode("utf-8", "replace").splitlines())
        )
        return next((line for line in lines if line.strip()), "")


def out_of_memory_kills() -> int:
    """Count the processes that this system killed for lack of memory; 0 if unknown."""
    try:
        text = Path("/proc/vmstat").read_text(encoding="ascii")
    except OSError:
        return 0
    counts = (line.split() for line in text.splitlines() if line.startswith("oom_kill "))
    return next((int(count[1]) for count in counts), 0)
