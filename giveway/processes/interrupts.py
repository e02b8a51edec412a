"""Ctrl-C as a request that the loop honours between two steps.

A KeyboardInterrupt raised between a person's moveToXY and SUMO's step would crash the next
simulation, and one raised inside the recorder would leave half a row.
"""

from __future__ import annotations

import signal
import threading
import time
from typing import TYPE_CHECKING, Any, Self

if TYPE_CHECKING:
    from collections.abc import Iterable
    from types import FrameType

PATIENCE = 10.0  # [s] after which a second interrupt acts at once


class SignalHandler:
    """While active, signals are handed to :meth:`handle`; their former handlers come back after it.

    Outside the main thread, where handlers cannot be set, nothing changes.

    Args:
        numbers: of the signals.
    """

    def __init__(self, numbers: Iterable[int]) -> None:
        self._numbers = numbers
        self._previous: dict[int, Any] = {}

    def __enter__(self) -> Self:
        if threading.current_thread() is threading.main_thread():
            for number in self._numbers:
                self._previous[number] = signal.signal(number, self.handle)
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._previous.items():
            signal.signal(number, handler)
        self._previous.clear()

    def handle(self, number: int, _frame: FrameType | None) -> None:
        """A signal has come."""
        raise NotImplementedError


class DeferredInterrupt(SignalHandler):
    """While active, SIGINT and SIGTERM only set :attr:`requested`.

    So an impatient second Ctrl-C does not cost the rows that are being written. One that comes
    ``PATIENCE`` after the first acts at once: a native call may hang.
    """

    def __init__(self) -> None:
        super().__init__((signal.SIGINT, signal.SIGTERM))
        self.requested = False
        self._first = 0.0

    def handle(self, number: int, _frame: FrameType | None) -> None:
        """Note the first signal; act on one that comes long after it."""
        if self.requested and time.monotonic() - self._first > PATIENCE:
            signal.signal(number, signal.SIG_DFL)
            signal.raise_signal(number)
        if not self.requested:
            self._first = time.monotonic()
        self.requested = True
