"""Exit codes of the command line, and its errors, which are one line."""

import contextlib
import sys

INTERRUPTED = 130  # 128 + SIGINT, as shells have it


def fail(message: str, code: int) -> int:
    """Print one line on stderr, and return the exit code."""
    with contextlib.suppress(OSError):  # its terminal has been closed
        sys.stderr.write(f"error: {' '.join(message.split())}\n")
    return code
