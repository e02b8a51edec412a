"""What the vehicle here and its FMU's process say to each other.

Requests and replies have a fixed head, so that a step costs one write and one read on each side.
What comes from the FMU's process is not trusted: an FMU can write whatever it likes into any open
file. So nothing of it is unpickled, every head must carry the number of its request, and what
follows it is JSON of bounded size.
"""

from __future__ import annotations

import json
import socket
import struct
import weakref
from time import monotonic
from typing import Any, Final

LOAD: Final = b"load"  # 0, 0
START: Final = b"strt"  # position [m], speed [m/s]
STEP: Final = b"step"  # force [N], 0
QUIT: Final = b"quit"  # 0, 0
DONE: Final = b"done"  # position [m], speed [m/s], acceleration [m/s2]
FAILED: Final = b"fail"  # likewise; the text is the error
REQUEST: Final = struct.Struct("<4sIdd")  # what, number, two values
REPLY: Final = struct.Struct("<4sIIddd")  # what, number of the request, size of the text, values
TEXT_LIMIT: Final = 1 << 16  # [bytes]
FORK: Final = b"fork"  # to the guardian, with the worker's end of the connection
BURY: Final = b"bury"  # with a patience [ms], then the worker is killed; answered by its death
MESSAGE: Final = 4096  # [bytes] from and to the guardian at most
LOST: Final = 113  # exit status of a process whose connection is gone

Text = dict[str, Any]
Reply = tuple[bool, float, float, float, Text]
"""Done and not failed, three values, the text."""


class GarbledError(Exception):
    """What came is no reply."""


class Line:
    """The vehicle's end of the connection.

    Args:
        connection: a stream socket, owned by the line from now on.
    """

    def __init__(self, connection: socket.socket) -> None:
        self._connection = connection
        self._closing = weakref.finalize(self, connection.close)
        self._number = 0
        self._timeout: float | None = None
        self._head = bytearray(REPLY.size)

    def ask(self, what: bytes, first: float, second: float, timeout: float) -> Reply:
        """One request, and its reply within ``timeout`` [s].

        Raises:
            TimeoutError: none came.
            EOFError: none will come, the process is gone.
            GarbledError: what came is none.
        """
        connection = self._connection
        if timeout != self._timeout:  # a system call saved in every step
            connection.settimeout(timeout)
            self._timeout = timeout
        self._number = number = (self._number + 1) & 0xFFFFFFFF
        try:
            connection.send(REQUEST.pack(what, number, first, second))
            size = connection.recv_into(self._head)
            if size != REPLY.size:
                self._fill(self._head, size, timeout)
            kind, echo, length, x, v, a = REPLY.unpack(self._head)
            if echo != number or length > TEXT_LIMIT or (kind != DONE and kind != FAILED):
                raise GarbledError
            return kind == DONE, x, v, a, self._text(length, timeout) if length else {}
        except TimeoutError:
            raise
        except OSError as error:
            raise EOFError from error

    def close(self) -> None:
        """The process ends when it finds the connection closed."""
        self._closing()

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
        """Read on until a buffer is full, ``timeout`` [s] in all, after ``got`` bytes came."""
        end, have = monotonic() + timeout, got
        self._timeout = None  # changed below
        while have < len(buffer):
            if got == 0:
                raise EOFError
            self._connection.settimeout(max(end - monotonic(), 1e-3))
            got = self._connection.recv_into(memoryview(buffer)[have:])
            have += got


def receive(connection: socket.socket) -> tuple[bytes, int, float, float] | None:
    """The next request, in the FMU's process; None: nobody is there any more."""
    head = connection.recv(REQUEST.size, socket.MSG_WAITALL)
    return REQUEST.unpack(head) if len(head) == REQUEST.size else None


def reply(
    connection: socket.socket,
    kind: bytes,
    number: int,
    state: tuple[float, float, float],
    text: Text | None = None,
) -> None:
    """Answer a request with DONE or FAILED."""
    body = json.dumps(text).encode() if text else b""
    connection.sendall(REPLY.pack(kind, number, len(body), *state) + body)
