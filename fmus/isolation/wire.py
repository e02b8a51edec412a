"""The messages between a vehicle or controller and its FMU's process.

Requests and replies have a fixed head, so that a step costs one write and one read on each side.
The number of values is agreed on at the beginning.

Replies of the FMU's process are not trusted, because an FMU can write into any open file. Nothing
is unpickled, every head must have the number of its request, and the text that follows it is JSON
of limited size.
"""

import json
import os
import socket
import struct
import sys
import weakref
from collections.abc import Sequence
from time import monotonic
from typing import Any, Final

LOAD: Final = b"load"  # without numbers
START: Final = b"strt"  # numbers of a vehicle: position [m], speed [m/s]
STEP: Final = b"step"  # numbers: the client's processor, then the inputs
QUIT: Final = b"quit"  # without numbers
DONE: Final = b"done"  # numbers: the state, e.g. position [m], speed [m/s], acceleration [m/s2]
FAILED: Final = b"fail"  # the same numbers; the text is the error
TEXT_LIMIT: Final = 1 << 16  # [bytes] largest text
START_WORKER: Final = b"fork"  # to the watchdog, with the worker's end of the connection
END_WORKER: Final = b"end"  # with the time [ms] to wait before the kill; the answer is the report
RETIRE: Final = b"retire"  # to the watchdog of a closed vehicle: end all, and wait for the next
SERVE: Final = b"serve"  # to a watchdog that waits, with the folder of the next vehicle
MESSAGE: Final = 4096  # [bytes] largest message from and to the watchdog
CONNECTION_LOST: Final = 113  # exit status of a process whose connection has been closed

_TURNS = 50  # number of tries to read a reply before waiting, about 50 us on an idle processor

Text = dict[str, Any]
Reply = tuple[bool, Sequence[float], Text]
"""A reply: True if the request was done, the numbers, the text."""


class GarbledError(Exception):
    """The bytes received are no reply."""


class Client:
    """The vehicle's or controller's end of the connection.

    Args:
        connection: Stream socket, which the client owns from now on.
        asked: Number of values in each request.
        answered: Number of values in each reply.
    """

    def __init__(self, connection: socket.socket, asked: int, answered: int) -> None:
        self._request = request_layout(asked)
        self._layout = reply_layout(answered)
        self._asked = asked
        self._connection = connection
        self._prompt = connection.dup()  # the same socket, for calls that do not wait
        self._prompt.settimeout(None)  # set once, so that the calls need not set it
        self._closing = weakref.finalize(self, _close, connection, self._prompt)
        self._number = 0
        self._timeout: float | None = None
        self._head = bytearray(self._layout.size)

    def ask(self, what: bytes, numbers: Sequence[float], timeout: float) -> Reply:
        """Send one request and return its reply.

        Args:
            what: Kind of the request.
            numbers: Values of the request; missing ones are 0.
            timeout: Time [s] within which the reply must come.

        Raises:
            TimeoutError: no reply came.
            EOFError: no reply will come, because the process has ended.
            GarbledError: the bytes received are no reply.
        """
        if timeout != self._timeout:  # set only if it differs
            self._connection.settimeout(timeout)
            self._timeout = timeout
        self._number = number = (self._number + 1) & 0xFFFFFFFF
        try:
            missing = self._asked - len(numbers)
            if missing:
                numbers = (*numbers, *missing * (0.0,))
            self._prompt.send(self._request.pack(what, number, *numbers))
            size = self._receive_head()
            if size != self._layout.size:
                self._fill(self._head, size, timeout)
            kind, echo, length, *state = self._layout.unpack(self._head)
            if echo != number or length > TEXT_LIMIT or (kind != DONE and kind != FAILED):
                raise GarbledError
            return kind == DONE, state, self._text(length, timeout) if length else {}
        except TimeoutError:
            raise
        except OSError as error:
            raise EOFError from error

    def close(self) -> None:
        """Close the connection, which ends the process."""
        self._closing()

    def _receive_head(self) -> int:
        """Return the number of bytes that have been read of the reply's head."""
        if sys.platform == "linux":
            for _ in range(_TURNS):  # let the FMU's process go first; see fmus.isolation.processor
                os.sched_yield()
                try:
                    return self._prompt.recv_into(self._head, 0, socket.MSG_DONTWAIT)
                except BlockingIOError:
                    continue
        return self._connection.recv_into(self._head)

    def _text(self, length: int, timeout: float) -> Text:
        buffer = bytearray(length)
        self._fill(buffer, self._connection.recv_into(buffer), timeout)
        try:
            text = json.loads(buffer)
        except (ValueError, RecursionError):
            raise GarbledError from None
        if not isinstance(text, dict):
            raise GarbledError
        return text

    def _fill(self, buffer: bytearray, got: int, timeout: float) -> None:
        """Fill the rest of a buffer after ``got`` bytes, within ``timeout`` [s]."""
        end, have = monotonic() + timeout, got
        self._timeout = None  # changed below
        while have < len(buffer):
            if got == 0:
                raise EOFError
            self._connection.settimeout(max(end - monotonic(), 1e-3))
            got = self._connection.recv_into(memoryview(buffer)[have:])
            have += got


def _close(*connections: socket.socket) -> None:
    for connection in connections:
        connection.close()


def request_layout(numbers: int) -> struct.Struct:
    """Return the layout of the head of requests: kind, number, and the numbers."""
    return struct.Struct(f"<4sI{numbers}d")


def reply_layout(numbers: int) -> struct.Struct:
    """Return the layout of the head of replies: status, request's number, text size, numbers."""
    return struct.Struct(f"<4sII{numbers}d")


def receive(
    connection: socket.socket, layout: struct.Struct
) -> tuple[bytes, int, Sequence[float]] | None:
    """Receive the next request in the FMU's process, or None if the connection is closed."""
    head = connection.recv(layout.size, socket.MSG_WAITALL)
    if len(head) != layout.size:
        return None
    what, number, *numbers = layout.unpack(head)
    return what, number, numbers


def reply(
    connection: socket.socket,
    kind: bytes,
    number: int,
    state: Sequence[float],
    layout: struct.Struct,
    text: Text | None = None,
) -> None:
    """Answer a request with DONE or FAILED."""
    if not text:
        connection.sendall(layout.pack(kind, number, 0, *state))
        return
    body = json.dumps(text).encode()
    connection.sendall(layout.pack(kind, number, len(body), *state) + body)
