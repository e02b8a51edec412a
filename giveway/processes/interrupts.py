"""Ctrl-C, and the other signals by which a user ends a process.

In the loop they are requests, which are obeyed between two steps. A KeyboardInterrupt between a
person's moveToXY and SUMO's step would crash the next simulation, and one inside the recorder would
leave half a row. Everywhere else they are raised as exceptions, so that all open resources are
closed: temporary folders are removed, and the user reads a message.
"""

import _thread
import contextlib
import signal
import sys
import threading
import time
from collections.abc import Iterable, Iterator
from types import FrameType
from typing import Any, ClassVar, Self

PATIENCE = 10.0  # Time [s] after which a second interrupt acts at once
_IMPORT = 5.0  # Time [s] after which a signal interrupts an import
_MOMENT = 0.01  # Time [s] after which a signal that could not be raised is tried again
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


def ended_by(number: int) -> KeyboardInterrupt:
    """Return the exception for a signal: KeyboardInterrupt for Ctrl-C, else TerminatedError."""
    return KeyboardInterrupt() if number == signal.SIGINT else TerminatedError(number)


def exit_code_of(error: KeyboardInterrupt) -> int:
    """Return the exit code, 128 + the signal, as shells do."""
    return 128 + (error.number if isinstance(error, TerminatedError) else signal.SIGINT)


@contextlib.contextmanager
def deaf_children() -> Iterator[None]:
    """Start children in this context that hear no signal to end until they unblock it.

    While Python itself starts, a Ctrl-C would end in a traceback, and other signals without a
    message.
    """
    if sys.platform == "win32":
        yield
        return
    previous = signal.pthread_sigmask(signal.SIG_BLOCK, ENDING)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, previous)


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

    It is not raised where it would get lost or become another error: inside an import, where a
    native module answers with an ImportError, and in a destructor or a callback of native code,
    which can raise nothing. There it is raised a moment later; an import that hangs is interrupted.

    Args:
        once: True to raise only the first signal. A signal that comes ``PATIENCE`` after it acts at
            once, and those in between do nothing. A supervised process gets the signal from the
            terminal and from its supervisor, and the second must not disturb the clean-up.

    Attributes:
        raised: Exception that was raised last, or None.
    """

    def __init__(self, *, once: bool = False) -> None:
        super().__init__(ENDING)
        self.raised: KeyboardInterrupt | None = None
        self._once = once
        self._first: float | None = None
        self._put_off = 0  # signal that an import puts off
        self._since = 0.0
        self._hook: Any = None

    def __enter__(self) -> Self:
        self._hook, sys.unraisablehook = sys.unraisablehook, self._raise_later
        return super().__enter__()

    def __exit__(self, *error: object) -> None:
        super().__exit__(*error)
        sys.unraisablehook = self._hook

    def raise_no_more(self) -> None:
        """Treat the work as done: signals do nothing, or act ``PATIENCE`` after the first."""
        self._once = True
        self._first = self._first or time.monotonic()

    def raise_put_off(self) -> None:
        """Raise the exception for a signal that has been put off; do nothing without one.

        Raises:
            KeyboardInterrupt: there is one.
        """
        if self._put_off:
            self.raised, self._put_off = ended_by(self._put_off), 0
            raise self.raised

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
        if not self._put_off:
            self._put_off, self._since = number, now
        if _imports(frame) and now - self._since < _IMPORT:
            _send_later(number)
            return
        self._first = now
        self.raise_put_off()

    def _raise_later(self, lost: Any) -> None:
        """Receive an exception that nobody can catch; one of ours is raised again elsewhere."""
        if self.raised is None or lost.exc_value is not self.raised:
            self._hook(lost)
            return
        self._first = None
        _send_later(exit_code_of(self.raised) - 128)


def _imports(frame: FrameType | None) -> bool:
    """Return whether a frame belongs to an import."""
    while frame is not None:
        if frame.f_code.co_filename.startswith("<frozen importlib"):
            return True
        frame = frame.f_back
    return False


def _send_later(number: int) -> None:
    """Let the main thread receive a signal once more in a moment."""

    def send() -> None:
        time.sleep(_MOMENT)
        if not callable(signal.getsignal(number)):  # the context has been left
            return
        if sys.platform == "win32":
            _thread.interrupt_main(signal.Signals(number))
        else:  # which also wakes a main thread that waits
            signal.pthread_kill(threading.main_thread().ident or 0, number)

    # not by `threading`, whose locks the interrupted code may hold
    _thread.start_new_thread(send, ())


class DeferredInterrupt(SignalHandler):
    """The context in which a signal to end only sets :attr:`requested`.

    Therefore an impatient second Ctrl-C does not lose the rows that are being written. One that
    comes ``PATIENCE`` after the first acts at once, since a native call may hang.

    Attributes:
        requested: True after a signal.
        latest: Number of the latest signal that this process has deferred.
    """

    latest: ClassVar[int] = signal.SIGINT

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
            DeferredInterrupt.latest = number
        self.requested = True
