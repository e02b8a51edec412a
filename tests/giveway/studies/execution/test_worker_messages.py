"""Messages between study and worker: whole and in their turn, or none at all."""

from __future__ import annotations

import socket
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from giveway.studies.execution.worker_messages import RECORD, TASK, GarbledError, Line


@pytest.fixture
def ends():
    here, there = socket.socketpair()
    with here, there:
        yield Line(here), there


def message(payload: bytes) -> bytes:
    """The bytes of a first message."""
    here, there = socket.socketpair()
    with here, there:
        Line(there).send(RECORD, payload)
        return here.recv(1 << 16)


def test_messages_arrive_in_order_however_they_are_cut(ends):
    line, there = ends
    other = Line(there)
    other.send(TASK, b"one")
    other.send(RECORD, b"")
    assert line.receive() == (TASK, b"one")
    assert line.receive() == (RECORD, b"")


def test_a_side_that_takes_nothing_is_not_waited_for_long(ends):
    line, _ = ends
    with pytest.raises(TimeoutError):
        line.send(TASK, bytes(1 << 24), 0.05)


def test_half_a_message_is_waited_for(ends):
    line, there = ends
    whole = message(b"x" * 5000)
    there.sendall(whole[:3000])
    assert line.receive(0.01) is None
    there.sendall(whole[3000:])
    assert line.receive(1.0) == (RECORD, b"x" * 5000)


def test_the_end_of_the_other_side_is_told(ends):
    line, there = ends
    there.sendall(message(b"x")[:-1])
    there.close()
    with pytest.raises(EOFError):
        line.receive(1.0)


def test_a_message_twice_is_none(ends):
    line, there = ends
    there.sendall(2 * message(b"x"))
    assert line.receive(1.0) == (RECORD, b"x")
    with pytest.raises(GarbledError):
        line.receive(1.0)


def test_a_size_that_no_message_has_is_not_waited_for(ends):
    line, there = ends
    there.sendall(struct.pack("<4sIII", RECORD, 1, 1 << 31, 0))
    with pytest.raises(GarbledError):
        line.receive(1.0)


@given(place=st.integers(0, 115), flip=st.integers(1, 255))
def test_no_changed_byte_passes(place, flip):
    noisy = bytearray(message(b"p" * 100))
    noisy[place] ^= flip
    here, there = socket.socketpair()
    with here, there:
        there.sendall(noisy)
        there.shutdown(socket.SHUT_WR)
        with pytest.raises((GarbledError, EOFError)):
            Line(here).receive(1.0)
