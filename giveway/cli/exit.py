"""How the command line ends: its exit codes and its one line of error."""

from __future__ import annotations

import sys

INTERRUPTED = 130  # 128 + SIGINT, as shells have it


def fail(message: str, code: int) -> int:
    """Print one line on stderr and hand back the exit code."""
    sys.stderr.write(f"error: {' '.join(message.split())}\n")
    return code
