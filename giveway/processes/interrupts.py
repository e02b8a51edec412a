"""Ctrl-C as a request that the loop honours between two steps.

A KeyboardInterrupt raised between a person's moveToXY and SUMO's step would crash the next
simulation, and one raised inside the recorder would tear a row.
"""

from __future__ import annotations

import signal
import threading
import time
from typing import TYPE_CHECKING, Any, Self

if TYPE_CHECKING:
    from types import FrameType, TracebackType

PATIENCE = 10.0  # [s]


class DeferredInterrupt:
    """While active, SIGINT and SIGTERM only set :attr:`requested`.

    So an impatient second Ctrl-C does not cost the rows that are being written; one that comes
    ``PATIENCE`` after the first acts at once, for a native call that hangs.

    Outside the main thread, where handlers cannot be set, nothing changes.
    """

    def __init__(self) -> None:
        self.requested = False
        self._first = 0.0
        self._previous: dict[int, Any] = {}

    def __enter__(self) -> Self:
        if threading.current_thread() is threading.main_thread():
            for number in (signal.SIGINT, signal.SIGTERM):
                self._previous[number] = signal.signal(number, self._note)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        for number, handler in self._previous.items():
            signal.signal(number, handler)
        self._previous.clear()

    def _note(self, number: int, _frame: FrameType | None) -> None:
        if self.requested and time.monotonic() - self._first > PATIENCE:
            signal.signal(number, signal.SIG_DFL)
            signal.raise_signal(number)
        if not self.requested:
            self._first = time.monotonic()
        self.requested = True
