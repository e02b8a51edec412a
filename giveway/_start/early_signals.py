"""The signals that come while the program ``giveway`` is being imported: each ends it at once.

Nothing is open yet, so that nothing has to be closed. This module is imported before all others and
itself imports only modules that Python has loaded. In a program of somebody else that imports
giveway, it does nothing.
"""

import _signal  # type: ignore[import-not-found]  # what `signal` wraps in enums, which take time
import os
import sys

# Numbers of the signals, and how each has ended the program
_ENDED = {
    getattr(_signal, name): words
    for name, words in (
        ("SIGINT", "interrupted"),
        ("SIGTERM", "ended by SIGTERM"),
        ("SIGHUP", "ended by SIGHUP"),
    )
    if hasattr(_signal, name)
}


def is_program() -> bool:
    """Return whether this process is the command line: ``giveway``, or ``python -m giveway``."""
    name = getattr(sys, "argv", None) or [""]
    if name[0] == "-m":  # Python still looks for the module
        words = sys.orig_argv
        return "-m" in words and words[words.index("-m") + 1 :][:1] == ["giveway"]
    return os.path.basename(name[0]) in {"giveway", "giveway.exe"}  # noqa: PTH119 - os is loaded


def _end(number: int, _frame: object) -> None:
    os.write(2, f"error: {_ENDED[number]}\n".encode())
    os._exit(128 + number)


def end_at_once() -> None:
    """Let each signal end this process with its line and its exit code, if it is the program."""
    if is_program():
        for number in _ENDED:
            if _signal.getsignal(number) is not _signal.SIG_IGN:  # as nohup does
                _signal.signal(number, _end)


end_at_once()
