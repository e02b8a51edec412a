"""The messages of an FMU: the log that keeps them, and the C functions that receive them.

The messages of FMI 1 and 2 are printf formats with arguments, which Python cannot receive as
such. They are taken from the registers and the stack, by the platform's calling convention.
Memory is read only where it is readable: a message like "100% sure" must not crash the process.
"""

import ctypes
import os
import platform
import re
import struct
import sys
from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import suppress
from ctypes import CFUNCTYPE, c_double, c_int, c_uint64, c_void_p
from typing import Any

from fmus.text import printable

_LONGEST = 4096  # bytes that are read of a message
_WIDEST = 200  # characters of a number's field
_PAGE = 4096  # bytes


class MessageLog:
    """Keeps the last messages of an FMU that report anything but success."""

    def __init__(self) -> None:
        self._messages: deque[str] = deque(maxlen=3)

    def add(self, status: int, message: bytes | str | None) -> None:
        """Keep a message on one line, unless it is kept already."""
        if not status or not message:
            return
        text = printable(_decoded(message) if isinstance(message, bytes) else message)
        if text and text not in self._messages:
            self._messages.append(text)

    def take(self) -> str:
        """Return the messages since the last call, and forget them."""
        text = "; ".join(self._messages)
        self._messages.clear()
        return text


def _decoded(message: bytes) -> str:
    """Decode a message; old tools write Latin-1 where the standard demands UTF-8."""
    try:
        return message.decode("utf-8")
    except UnicodeDecodeError:
        return message.decode("latin-1")


# ---- the places of variadic arguments ----


def _convention() -> tuple[int, int, int, int]:
    """Return the places of variadic arguments after five fixed ones.

    The numbers are: integer registers to skip and to use, double registers, stack slots.
    """
    machine = platform.machine().lower()
    if sys.platform == "win32":
        return (0, 0, 0, 16) if machine in {"amd64", "x86_64"} else (0, 0, 0, 0)
    if machine in {"x86_64", "amd64"}:
        return 0, 1, 8, 16
    if machine in {"aarch64", "arm64"}:
        return (3, 0, 0, 16) if sys.platform == "darwin" else (0, 3, 8, 16)
    return 0, 0, 0, 0  # unknown: formats stay as they are


SKIPPED, INTEGERS, DOUBLES, _STACK = _convention()
_EXTRA: tuple[Any, ...] = (
    *[c_uint64] * (SKIPPED + INTEGERS),
    *[c_double] * DOUBLES,
    *[c_uint64] * _STACK,
)
_FORMATTED = CFUNCTYPE(None, c_void_p, c_void_p, c_int, c_void_p, c_void_p, *_EXTRA)
_PLAIN = CFUNCTYPE(None, c_void_p, c_int, c_void_p, c_void_p)


class Arguments:
    """The arguments of a format, one after the other.

    Args:
        slots: Slots of registers and the stack, as the receivers get them.
    """

    def __init__(self, slots: Sequence[Any]) -> None:
        integers, doubles = SKIPPED + INTEGERS, SKIPPED + INTEGERS + DOUBLES
        self._integers: Iterator[int] = iter(slots[SKIPPED:integers])
        self._doubles: Iterator[float] = iter(slots[integers:doubles])
        self._stack: Iterator[int] = iter(slots[doubles:])

    def integer(self) -> int:
        """Return the next integer, or raise StopIteration after the last reachable one."""
        value = next(self._integers, None)
        return next(self._stack) if value is None else value

    def double(self) -> float:
        """Return the next double, or raise StopIteration after the last one that can be reached."""
        value = next(self._doubles, None)
        if value is not None:
            return value
        bits: float = struct.unpack("<d", struct.pack("<Q", next(self._stack)))[0]
        return bits


# ---- receivers ----


def formatted_receiver(messages: MessageLog) -> Any:
    """Return the logger of FMI 1 and 2; keep it as long as the FMU is loaded."""

    def receive(
        _owner: int | None,
        _name: int | None,
        status: int,
        _category: int | None,
        message: int | None,
        *slots: Any,
    ) -> None:
        if status:
            with suppress(Exception):  # no exception may reach C
                messages.add(status, expand(read_text(message), Arguments(slots)))

    return _FORMATTED(receive)


def plain_receiver(messages: MessageLog) -> Any:
    """Return the logger of FMI 3, whose messages need no formatting."""

    def receive(
        _owner: int | None, status: int, _category: int | None, message: int | None
    ) -> None:
        if status:
            with suppress(Exception):
                messages.add(status, read_text(message))

    return _PLAIN(receive)


# ---- printf ----

_CONVERSION = re.compile(
    rb"%(?P<flags>[-+ #0]*)(?P<width>\*|\d+)?(?:\.(?P<precision>\*|\d*))?"
    rb"(?P<length>hh|h|ll|l|L|q|j|z|t|I64)?(?P<kind>[diouxXeEfFgGaAcspn%])"
)
_BITS = {"hh": 8, "h": 16, "l": 32 if sys.platform == "win32" else 64} | dict.fromkeys(
    ("ll", "q", "j", "z", "t", "I64"), 64
)


def expand(text: bytes, arguments: Arguments) -> bytes:
    """Expand a printf format with its arguments; a part that cannot be expanded stays."""
    if b"%" not in text:
        return text

    def replacement(match: re.Match[bytes]) -> bytes:
        if b" " in match["flags"] and (
            match["kind"] in b"scpn" or text[match.end() :][:1].isalpha()
        ):
            return match.group()  # "100% sure", "5% of": no format
        try:
            return _converted(match, arguments)
        except (StopIteration, ValueError, OverflowError, TypeError):
            return match.group()

    return _CONVERSION.sub(replacement, text)


def _converted(match: re.Match[bytes], arguments: Arguments) -> bytes:
    part = {key: value.decode() for key, value in match.groupdict(b"").items()}
    kind = part["kind"]
    if kind == "%":
        return b"%"
    width, precision = (
        str(_signed(arguments.integer(), 32)) if part[name] == "*" else part[name]
        for name in ("width", "precision")
    )
    if max(abs(int(width or 0)), abs(int(precision or 0))) > _WIDEST:
        return match.group()
    dot = "." if match["precision"] is not None else ""
    pattern = f"%{part['flags']}{width}{dot}{precision}"
    if kind in "eEfFgGaA":
        if part["length"] == "L":  # the layout of a long double depends on the platform
            return match.group()
        number = arguments.double()
        return (number.hex() if kind in "aA" else f"{pattern}{kind}" % number).encode()
    raw = arguments.integer()
    if kind in "di":
        return (f"{pattern}d" % _signed(raw, _BITS.get(part["length"], 32))).encode()
    if kind in "ouxX":
        value = raw & (1 << _BITS.get(part["length"], 32)) - 1
        return (f"{pattern}{'d' if kind == 'u' else kind}" % value).encode()
    if kind == "c":
        return bytes([raw & 0xFF])
    if kind == "s":
        return _string(raw, match, precision if dot else "")
    return b"" if kind == "n" else hex(raw).encode()


def _signed(raw: int, bits: int) -> int:
    value = raw & (1 << bits) - 1
    return value - (1 << bits) if value >> bits - 1 else value


def _string(address: int, match: re.Match[bytes], precision: str) -> bytes:
    if not address:
        return b"(null)"
    text = read_text(address)
    if not text and not _read_memory(address, 1):
        return match.group()
    text = text[: int(precision)] if precision else text
    width = int(match["width"] or 0) if match["width"] != b"*" else 0
    return text.ljust(width) if b"-" in match["flags"] else text.rjust(width)


# ---- memory ----


def read_text(address: int | None) -> bytes:
    """Return the start of the C string at an address, or an empty one if it cannot be read."""
    text = b""
    while address and len(text) < _LONGEST:
        here = address + len(text)
        piece = _read_memory(here, min(_PAGE - here % _PAGE, _LONGEST - len(text)))
        end = piece.find(b"\0")
        if end >= 0:
            return text + piece[:end]
        if not piece:
            break
        text += piece
    return text


if sys.platform == "win32":

    def _read_memory(address: int, size: int) -> bytes:
        buffer, done = ctypes.create_string_buffer(size), ctypes.c_size_t()
        ctypes.windll.kernel32.ReadProcessMemory(
            c_void_p(-1), c_void_p(address), buffer, ctypes.c_size_t(size), ctypes.byref(done)
        )
        return buffer.raw[: done.value]

else:
    _write = ctypes.CDLL(None)["write"]
    _write.argtypes = [c_int, c_void_p, ctypes.c_size_t]
    _write.restype = ctypes.c_ssize_t

    def _read_memory(address: int, size: int) -> bytes:
        """Read memory through a pipe: the kernel refuses to write what is not readable."""
        source, sink = os.pipe()
        try:
            done = _write(sink, address, size)
            return os.read(source, done) if done > 0 else b""
        finally:
            os.close(source)
            os.close(sink)
