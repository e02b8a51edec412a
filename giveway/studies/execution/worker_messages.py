"""Messages between a study and a worker: frames over a socket.

A worker's messages are not trusted, since an FMU in its process can write into any open file.
Therefore nothing is unpickled, and a message that is incomplete or out of order is refused.
"""

from __future__ import annotations

import struct
import zlib
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    import socket

READY: Final = b"redy"  # the worker has finished its imports
TASK: Final = b"task"  # JSON of a Task
RECORD: Final = b"recd"  # JSON of a RunRecord
ERROR: Final = b"eror"  # an unexpected exception, one line
REFUSED: Final = b"rfsd"  # one line: why the run would differ from the planned one
_KINDS: Final = {READY, TASK, RECORD, ERROR, REFUSED}
_HEAD: Final = struct.Struct("<4sIII")  # kind, number, bytes of payload, their CRC-32
_LIMIT: Final = 1 << 26  # Largest payload [bytes]
_PIECE: Final = 1 << 16  # Bytes read at a time


class GarbledError(Exception):
    """The bytes received are no message."""


class Line:
    """One end of the connection.

    Args:
        connection: Stream socket, owned by the line from now on.
    """

    def __init__(self, connection: socket.socket) -> None:
        self._connection = connection
        self._sent = self._received = 0
        self._buffer = bytearray()

    def send(self, kind: bytes, payload: bytes = b"", timeout: float | None = None) -> None:
        """Send a message.

        Raises:
            TimeoutError: the other side has not taken it within ``timeout`` [s].
            OSError: the other side is gone.
        """
        self._sent = (self._sent + 1) & 0xFFFFFFFF
        head = _HEAD.pack(kind, self._sent, len(payload), zlib.crc32(payload))
        self._connection.settimeout(timeout)
        self._connection.sendall(head + payload)

    def receive(self, timeout: float | None = None) -> tuple[bytes, bytes] | None:
        """Return kind and payload of the next message, or None after ``timeout`` [s] without one.

        Raises:
            EOFError: the other side is gone.
            GarbledError: the bytes received are no message.
        """
        while (message := self._next()) is None:
            try:
                self._connection.settimeout(timeout)
                piece = self._connection.recv(_PIECE)
            except TimeoutError:
                return None
            except OSError as error:
                raise EOFError from error
            if not piece:
                raise EOFError
            self._buffer += piece
        return message

    def _next(self) -> tuple[bytes, bytes] | None:
        """Return the message at the beginning of the received bytes, if it is complete."""
        if len(self._buffer) < _HEAD.size:
            return None
        kind, number, size, check = _HEAD.unpack_from(self._buffer)
        expected = (self._received + 1) & 0xFFFFFFFF
        if kind not in _KINDS or number != expected or size > _LIMIT:
            raise GarbledError
        end = _HEAD.size + size
        if len(self._buffer) < end:
            return None
        payload = bytes(self._buffer[_HEAD.size : end])
        if zlib.crc32(payload) != check:
            raise GarbledError
        self._received = expected
        del self._buffer[:end]
        return kind, payload

    def close(self) -> None:
        """Close the connection, which tells the other side that no more messages come."""
        self._connection.close()
