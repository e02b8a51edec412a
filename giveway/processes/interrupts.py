"""Ctrl-C, and the other signals by which a user ends a process.

In the loop they are requests, which are obeyed between two steps. A KeyboardInterrupt between a
person's moveToXY and SUMO's step would crash the next simulation, and one inside the recorder would
leave half a row. Everywhere else they are raised as exceptions, so that all open resources are
closed: temporary folders are removed, and the user reads a message.
"""

import signal
import threading
import time
from collections.abc import Iterable
from types import FrameType
from typing import Any, Self

PATIENCE = 10.0  # Time [s] after which a second interrupt acts at once
ENDING = frozenset(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)
"""Signals by which a user ends a process: Ctrl-C, ``kill``, a terminal that is closed."""


class TerminatedError(KeyboardInterrupt):
    """The user has asked this process to end, by a signal other than Ctrl-C's.

    Args:
        number: Number of the signal.
    """

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


def who_ended(error: KeyboardInterrupt) -> str:
    """Return how the user has ended the process: "interrupted", or "ended by SIGTERM"."""
    if isinstance(error, TerminatedError):
        return f"ended by {signal.Signals(error.number).name}"
    return "interrupted"


def exit_code_of(error: KeyboardInterrupt) -> int:
    """Return the exit code, 128 + the signal, as shells do."""
    return 128 + (error.number if isinstance(error, TerminatedError) else signal.SIGINT)


class SignalHandler:
    """The context in which :meth:`handle` receives signals instead of the former handlers.

    Signals that this process was told to ignore, as nohup does, are still ignored. Outside the
    main thread, where handlers cannot be set, nothing changes.

    Args:
        numbers: Numbers of the signals.
    """

    def __init__(self, numbers: Iterable[int]) -> None:
        self._numbers = numbers
        self._previous: dict[int, Any] = {}

    def __enter__(self) -> Self:
        if threading.current_thread() is threading.main_thread():
            for number in self._numbers:
                if signal.getsignal(number) is not signal.SIG_IGN:
                    self._previous[number] = signal.signal(number, self.handle)
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._previous.items():
            signal.signal(number, handler)
        self._previous.clear()

    def handle(self, number: int, _frame: FrameType | None) -> None:
        """Receive a signal."""
        raise NotImplementedError


class RaisedSignals(SignalHandler):
    """The context in which a signal to end is raised as an exception in the main thread.

    Args:
        once: True to raise only the first signal. A signal that comes ``PATIENCE`` after it acts at
            once, and those in between do nothing. A supervised process gets the signal from the
            terminal and from its supervisor, and the second must not disturb the clean-up.
    """

    def __init__(self, *, once: bool = False) -> None:
        super().__init__(ENDING)
        self._once = once
        self._first: float | None = None

    def handle(self, number: int, frame: FrameType | None) -> None:
        """Raise the exception for a signal.

        Raises:
            KeyboardInterrupt: the signal was Ctrl-C.
            TerminatedError: the signal was another one.
        """
        now = time.monotonic()
        if self._once and self._first is not None:
            if now - self._first > PATIENCE:
                signal.signal(number, signal.SIG_DFL)
                signal.raise_signal(number)
            return
        self._first = now
        if number == signal.SIGINT:
            signal.default_int_handler(number, frame)
        raise TerminatedError(number)


class DeferredInterrupt(SignalHandler):
    """The context in which a signal to end only sets :attr:`requested`.

    Therefore an impatient second Ctrl-C does not lose the rows that are being written. One that
    comes ``PATIENCE`` after the first acts at once, since a native call may hang.
    """

    def __init__(self) -> None:
        super().__init__(ENDING)
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
