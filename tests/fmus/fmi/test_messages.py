"""What FMUs say: formats are expanded as C does it, and nothing that they say does harm."""

from __future__ import annotations

import ctypes
import struct
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fmus.fmi.messages import DOUBLES, INTEGERS, SKIPPED, Arguments, MessageLog, expand, read_text


def passed(*values):
    """Arguments where C puts them: in registers as long as there are any, then on the stack."""
    integers, doubles, stack = [], [], []
    for value in values:
        code, registers, room = (
            ("<q", integers, INTEGERS) if isinstance(value, int) else ("<d", doubles, DOUBLES)
        )
        if len(registers) < room:
            registers.append(value)
        else:
            stack.append(struct.unpack("<Q", struct.pack(code, value))[0])
    integers += [0] * (INTEGERS - len(integers))
    doubles += [0.0] * (DOUBLES - len(doubles))
    return Arguments([0] * SKIPPED + integers + doubles + stack)


def c_printf(text, *values):
    """The C library's own idea."""
    library = ctypes.cdll.msvcrt if sys.platform == "win32" else ctypes.CDLL(None)
    buffer = ctypes.create_string_buffer(2000)
    library.snprintf(buffer, ctypes.c_size_t(2000), text, *values)
    return buffer.value


@given(
    flags=st.sampled_from(["", "-", "+", "0", "-+"]),
    width=st.sampled_from(["", "1", "12"]),
    kind=st.sampled_from(["d", "i", "hd", "hhi", "ld", "u", "hu", "x", "X", "o"]),
    value=st.integers(-(2**31), 2**31 - 1),
)
def test_whole_numbers_as_c_writes_them(flags, width, kind, value):
    if kind[-1] not in "di":
        flags = flags.replace("+", "")  # for numbers with a sign only
    text = f"a %{flags}{width}{kind}; %.3d b".encode()
    c_value = ctypes.c_long(value) if kind == "ld" else ctypes.c_int(value)
    assert expand(text, passed(value, 7)) == c_printf(text, c_value, ctypes.c_int(7))


@given(
    value=st.floats(allow_nan=False, allow_infinity=False, width=32),
    precision=st.sampled_from(["", ".0", ".3", ".17"]),
    kind=st.sampled_from("eEfgG"),
)
def test_floating_point_numbers_as_c_writes_them(value, precision, kind):
    text = f"a %{precision}{kind}; b".encode()
    assert expand(text, passed(value)) == c_printf(text, ctypes.c_double(value))


def test_many_arguments_in_their_order():
    word = ctypes.create_string_buffer(b"axle")
    numbers = [0.5 * n for n in range(10)]
    text = b"%s %d %ld" + b" %g" * 10 + b" %.*f %c %% %5s|"
    values = [ctypes.addressof(word), -7, 2**40, *numbers, 2, 1.23456, ord("x")]
    assert expand(text, passed(*values, ctypes.addressof(word))) == (
        b"axle -7 1099511627776 0 0.5 1 1.5 2 2.5 3 3.5 4 4.5 1.23 x %  axle|"
    )


@pytest.mark.parametrize(
    "text", [b"100% sure", b"5% of it, 3% done", b"% q %", b"%100000d", b"%s", b"%n"]
)
def test_what_is_no_format_stays_as_it_is(text):
    assert expand(text, passed(8)) == (text if text != b"%n" else b"")


def test_arguments_that_are_not_there_leave_the_format():
    assert expand(b"%d %d", Arguments([])) == b"%d %d"


def test_unreadable_memory_is_no_text():
    assert read_text(8) == b""
    assert read_text(None) == b""
    word = ctypes.create_string_buffer(b"x" * 100_000)
    assert set(read_text(ctypes.addressof(word))) == {ord("x")}


def test_the_log_keeps_the_last_lines_of_trouble():
    messages = MessageLog()
    messages.add(0, b"all is well")
    for text in (b"first", b"second\nline", b"second line", "Kühl".encode("latin-1"), b"\x1b[2J"):
        messages.add(3, text)
    assert messages.take() == "second line; Kühl; ?[2J"
    assert messages.take() == ""


@pytest.mark.parametrize("version", ["1.0", "2.0", "3.0"])
@pytest.mark.parametrize(
    ("behaviour", "said"),
    [
        ("message_latin1", "Kühlwasser zu heiß"),
        ("message_null", ""),
        ("message_percent", "100% sure, 5 %, %q"),
        ("message_arguments", "the axle broke 3 times, 99.5% sure"),
        ("message_control", "?[2J?[31mred? second line??"),
        ("message_huge", "x" * 197 + "..."),
        ("message_thread", "said by another thread"),
    ],
)
def test_what_fmus_say(zoo, run, version, behaviour, said):
    car = run(zoo.car(fmi=version, behaviour=behaviour), {"force": 1.0}, 6)
    assert car.status <= 1
    assert car.messages.take() == said
