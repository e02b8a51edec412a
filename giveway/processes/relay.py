"""The signals by which a user ends a supervised run, passed on to its process."""

import contextlib
import os
import signal
import subprocess
import sys
import time
from types import FrameType

from giveway.processes.interrupts import ENDING, SignalHandler

# Time [s] for a child to end after a signal; then the user is told that a second one kills it
_PATIENCE = 2.0


class Relay(SignalHandler):
    """Passes the signals by which a user ends a run to the child, which decides when to end.

    Attributes:
        first: First such signal.
        killed: True if a second one had to kill the child.
    """

    def __init__(self) -> None:
        super().__init__(ENDING)
        self.first: int | None = None
        self.killed = False
        self._at = 0.0
        self._told = False
        self._child: subprocess.Popen[bytes] | None = None

    def connect(self, child: subprocess.Popen[bytes]) -> None:
        """Name the child, and pass on a signal that came before."""
        self._child = child
        if self.first is not None:
            self._send(self.first)

    def handle(self, number: int, _frame: FrameType | None) -> None:
        """Pass on the first signal; one that comes after the user was told kills the child."""
        if self.first is None:
            self.first, self._at = number, time.monotonic()
            self._send(number)
        elif self._child is not None and self._told:
            self.killed = True
            self._child.kill()

    def tell(self, place: str) -> None:
        """Tell the user once that the child has not ended, and what a second signal does.

        Args:
            place: Phase of the child in words.
        """
        if self.first is None or self._told or time.monotonic() - self._at < _PATIENCE:
            return
        self._told = True  # before the note, whose reader may be quick
        name = signal.Signals(self.first).name
        with contextlib.suppress(OSError):
            sys.stderr.write(
                f"note: {name} has not been heard yet {place}; a second one kills the run, whose "
                "recorded rows are kept\n"
            )

    def _send(self, number: int) -> None:
        # a Windows console tells all processes itself
        if self._child is not None and os.name != "nt":
            self._child.send_signal(number)
