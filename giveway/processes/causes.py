"""The cause of a process's end in words, from its exit code and the files that it left.

The supervisor of a run and that of a study's workers both watch a child's heartbeat. They use the
same words for the end of a child, and the same way to let a hanging child report its place.
"""

import os
import signal
import subprocess
from contextlib import suppress
from pathlib import Path

from giveway.gate import RefusedFileError, read_bytes

_LAST_WORDS = 2.0  # Time [s] for a hanging process to write its traceback
WINDOWS_CAUSES = {
    0xC0000005: "access violation",
    0xC000001D: "illegal instruction",
    0xC0000094: "integer division by zero",
    0xC00000FD: "stack overflow",
    0xC0000374: "heap corruption",
    0xC0000409: "abort",
}


def cause_of_end(returncode: int) -> str:
    """Return the cause of a process's end: "SIGSEGV", "exit(3) called ...".

    Args:
        returncode: Return code of :mod:`subprocess`: minus the signal, or the exit code.
    """
    if returncode < 0:
        return _signal_name(-returncode)
    if returncode in WINDOWS_CAUSES:
        return WINDOWS_CAUSES[returncode]
    return f"exit({returncode}) called by native code"


def let_speak(process: subprocess.Popen[bytes]) -> None:
    """Let a hanging process write its traceback, by a signal that it may survive."""
    if os.name == "nt":
        return
    with suppress(OSError):
        process.send_signal(signal.SIGABRT)
    with suppress(subprocess.TimeoutExpired):
        process.wait(_LAST_WORDS)


def stood_still(seconds: float) -> str:
    """Return the reason for killing a process without a sign of life for ``seconds`` [s]."""
    return f"no progress for {seconds:g} s"


def text_in(file: Path) -> str:
    """Return the text that a dead process left in ``file``, or "" without the file."""
    try:
        return read_bytes(file).decode("utf-8", errors="replace").strip()
    except (OSError, RefusedFileError):
        return ""


def _signal_name(number: int) -> str:
    try:
        name = signal.Signals(number).name
    except ValueError:  # a real-time signal
        return f"signal {number}"
    if name == "SIGKILL":
        return "SIGKILL (as a rule the system, out of memory)"
    return name
