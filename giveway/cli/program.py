"""The program ``giveway``: it builds and runs one command, whose end becomes an exit code."""

import contextlib
import io
import os
import sys
import tempfile
from collections.abc import Sequence

from giveway._start.environment import out_of_memory
from giveway.cli.exit import fail
from giveway.errors import GivewayError
from giveway.processes.garbage import rarely_collected
from giveway.processes.interrupts import (
    DeferredInterrupt,
    RaisedSignals,
    ended_by,
    exit_code_of,
    who_ended,
)

_SIGNALLED = 128  # Exit codes from here on tell of a signal
_NO_THREAD = "can't start new thread"  # Python's message, which has no exception class of its own


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and exit with its code.

    Args:
        arguments: Words after ``giveway``, or None for those of this process, which then ends: from
            the end of the command on, signals do nothing.
    """
    words = (sys.argv[1:] if arguments is None else list(arguments)) or ["--help"]
    signals = RaisedSignals()
    signals.__enter__()
    try:
        with rarely_collected():
            code = _code_of(words, signals)
    finally:
        if arguments is not None:
            signals.__exit__()
    sys.exit(code)


def _code_of(words: Sequence[str], signals: RaisedSignals) -> int:
    """Return the exit code of a command, after its message."""
    try:
        try:
            code = _run(words)
            if code == 0:  # else another handler has heard it
                signals.raise_put_off()
            return code
        finally:
            signals.raise_no_more()
    except Exception as error:
        if signals.raised is not None and getattr(error, "exit_code", 0) < _SIGNALLED:
            return _ended(signals.raised)  # a library has made another error of the signal
        return _failed(words, error)
    except KeyboardInterrupt as error:
        return _ended(error)


def _ended(error: KeyboardInterrupt) -> int:
    return fail(who_ended(error), exit_code_of(error))


def _failed(words: Sequence[str], error: Exception) -> int:
    """Return the exit code of a command that failed, after its message.

    Raises:
        Exception: a defect of giveway, whose traceback is shown.
    """
    if isinstance(error, GivewayError):
        return fail(str(error), error.exit_code)
    if isinstance(error, BrokenPipeError):  # the reader of the output has ended
        # the remaining output is dropped
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    if isinstance(error, MemoryError | OSError | ImportError) and out_of_memory(error):
        return fail("out of memory; free memory, or raise the limit (ulimit -v)", 1)
    if isinstance(error, OSError):
        return fail(_named(error), 1)
    if hasattr(error, "format_message"):
        return fail(_renamed(words) or f"{error.format_message()} See giveway --help.", 2)
    if str(error) == _NO_THREAD:
        return fail(
            "the system gives no more threads; end other processes, or raise the limit (ulimit -u)",
            1,
        )
    raise error


def _renamed(words: Sequence[str]) -> str | None:
    """Return the message about the first flag that no longer exists, or None."""
    from giveway.config.renamed import renamed_flag

    for word in words:
        instead = renamed_flag(word) if word.startswith("--") else None
        if instead is not None:
            return f"{word.partition('=')[0]}: no longer exists; {instead}"
    return None


def _named(error: OSError) -> str:
    """Return an error of the system with the file that it concerns, or the output."""
    where = "output" if error.filename is None else error.filename
    return f"{where}: {error.strerror or error}"


def _find_temporary_folder() -> None:
    """Let Python find its folder for temporary files.

    It tries it by a file, which a signal between two of its lines would leave there.

    Raises:
        KeyboardInterrupt: a signal has come.
    """
    with DeferredInterrupt() as interrupt, contextlib.suppress(OSError):
        tempfile.gettempdir()
    if interrupt.requested:
        raise ended_by(interrupt.latest)


def _run(words: Sequence[str]) -> int:
    """Run the command and return its exit code."""
    _find_temporary_folder()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal may lack some characters
    from giveway.cli.app import invoke

    return invoke(list(words))
