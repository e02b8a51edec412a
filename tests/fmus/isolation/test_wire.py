"""Whatever an FMU writes into the connection: it is a reply, or no harm is done."""

from __future__ import annotations

import json
import resource
import socket

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fmus.errors import FmuCrashError
from fmus.isolation import wire as protocol
from fmus.isolation.wire import DONE, STEP, Client, GarbledError, reply_layout


def answered(answer, timeout=0.02):
    """The outcome of a first request that is answered so."""
    here, there = socket.socketpair()
    with there:
        there.sendall(answer)
        there.shutdown(socket.SHUT_WR)
        line = Client(here, 2, 3)
        try:
            return line.ask(STEP, (1.0,), timeout)
        finally:
            line.close()


@given(st.binary(max_size=200))
def test_noise_is_told_from_a_reply(noise):
    with pytest.raises((GarbledError, EOFError)):
        answered(noise)


@given(st.binary(max_size=100))
def test_noise_instead_of_the_text_is_no_reply(noise):
    head = reply_layout(3).pack(DONE, 1, len(noise) + 1, 0.0, 0.0, 0.0)
    with pytest.raises((GarbledError, EOFError)):
        answered(head + b"!" + noise)


def test_a_reply_is_read_whole():
    body = json.dumps({"warnings": ["x" * 50_000]}).encode()
    head = reply_layout(3).pack(DONE, 1, len(body), 1.0, 2.0, 3.0)
    done, state, text = answered(head + body)
    assert (done, state, len(text["warnings"][0])) == (True, [1.0, 2.0, 3.0], 50_000)


@pytest.mark.parametrize(
    ("number", "length"), [(2, 0), (0, 0), (1, protocol.TEXT_LIMIT + 1), (1, 0xFFFFFFFF)]
)
def test_a_reply_to_something_else_or_without_measure_is_refused(number, length):
    with pytest.raises(GarbledError):
        answered(reply_layout(3).pack(DONE, number, length, 0.0, 0.0, 0.0))


def test_a_text_nested_without_end_is_refused():
    body = b"[" * 60_000
    with pytest.raises(GarbledError):
        answered(reply_layout(3).pack(DONE, 1, len(body), 0.0, 0.0, 0.0) + body)


def test_a_reply_in_drops_does_not_stretch_the_time_out():
    here, there = socket.socketpair()
    line = Client(here, 2, 3)
    with there:
        there.sendall(b"do")
        with pytest.raises(TimeoutError):
            line.ask(STEP, (1.0,), 0.05)
    line.close()


def test_every_request_has_a_time_out_of_its_own():
    here, there = socket.socketpair()
    line = Client(here, 2, 3)
    with there:
        for number, timeout in enumerate((0.05, 0.05, 0.01, 5.0), start=1):
            if number < 4:
                with pytest.raises(TimeoutError):
                    line.ask(STEP, (1.0,), timeout)
            else:
                there.sendall(reply_layout(3).pack(DONE, number, 0, 1.0, 2.0, 3.0))
                assert line.ask(STEP, (1.0,), timeout)[0]
            assert here.gettimeout() == timeout
    line.close()


@pytest.fixture
def few_files():
    """So few that the connection's number is among those that the zoo writes into."""
    usual, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (60, most))
    yield
    resource.setrlimit(resource.RLIMIT_NOFILE, (usual, most))


def test_an_fmu_that_writes_into_the_connection_is_told(few_files, isolated):
    vehicle = isolated(behaviour="write_into_files", at=0.0)
    vehicle.start()
    with pytest.raises(FmuCrashError, match="wrote into giveway's connection in the step from 0 s"):
        vehicle.step(0.0)
