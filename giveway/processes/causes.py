"""How a process ended, in words: from its exit code, and from what it left in its folder.

The supervisor of a run and that of a study's workers both watch a child's heartbeat; what they say
about the end of a child, and how they let a hanging one speak, is the same and stands here.
"""

import os
import signal
import subprocess
from contextlib import suppress
from pathlib import Path

_LAST_WORDS = 2.0  # [s] for a hanging process to write its traceback
WINDOWS_CAUSES = {
    0xC0000005: "access violation",
    0xC000001D: "illegal instruction",
    0xC0000094: "integer division by zero",
    0xC00000FD: "stack overflow",
    0xC0000374: "heap corruption",
    0xC0000409: "abort",
}


def cause_of_end(returncode: int) -> str:
    """Return why a process ended that did not end by itself: "SIGSEGV", "exit(3) called ...".

    Args:
        returncode: as :mod:`subprocess` has it: minus the signal, or the exit code.
    """
    if returncode < 0:
        return _signal_name(-returncode)
    if returncode in WINDOWS_CAUSES:
        return WINDOWS_CAUSES[returncode]
    return f"exit({returncode}) called by native code"


def let_speak(process: subprocess.Popen[bytes]) -> None:
    """Let a hanging process write where it hangs, which takes a signal; it may survive that."""
    if os.name == "nt":
        return
    with suppress(OSError):
        process.send_signal(signal.SIGABRT)
    with suppress(subprocess.TimeoutExpired):
        process.wait(_LAST_WORDS)


def stood_still(seconds: float) -> str:
    """Return why a process was killed that had shown no sign of life for so many ``seconds``."""
    return f"no progress for {seconds:g} s"


def text_in(file: Path) -> str:
    """Return what a dead process has written into ``file``; empty without the file."""
    try:
        return file.read_text(encoding="utf-8", errors="replace").strip()
    except OSError:
        return ""


def _signal_name(number: int) -> str:
    try:
        name = signal.Signals(number).name
    except ValueError:  # a real-time signal
        return f"signal {number}"
    if name == "SIGKILL":
        return "SIGKILL (as a rule the system, out of memory)"
    return name
