"""The probe of a cluster's address: nobody, a stranger, or no address at all."""

from __future__ import annotations

import contextlib
import re
import socket
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import pytest

from giveway.studies.execution import WorkerError, cluster_executor


@pytest.mark.parametrize("address", ["", "localhost", "local:0", "local:x", "tcp://"])
def test_an_address_that_is_none(address, refused):
    with refused(WorkerError, f"'{address}'", "tcp://host:port", "local:N"):
        cluster_executor(address)


def test_nobody_at_the_address(refused, monkeypatch):
    monkeypatch.setattr("giveway.studies.execution.cluster._CONNECT", 0.5)
    with (
        refused(WorkerError, "tcp://127.0.0.1:1", "cannot be reached"),
        cluster_executor("tcp://127.0.0.1:1"),
    ):
        pass


class Stranger(threading.Thread):
    """A server that is no Dask scheduler: what connects gets ``greeting``, and is kept waiting."""

    def __init__(self, greeting: bytes) -> None:
        super().__init__(daemon=True)
        self._greeting = greeting
        self._server = socket.create_server(("127.0.0.1", 0))
        self._open: list[socket.socket] = []
        self.port = self._server.getsockname()[1]
        self.start()

    def run(self) -> None:
        with contextlib.suppress(OSError):
            while True:
                connection, _ = self._server.accept()
                self._open.append(connection)
                connection.sendall(self._greeting)

    def close(self) -> None:
        for each in (self._server, *self._open):
            each.close()


STRANGERS = (
    ("tcp", b"", "nothing that answers|timed out|Timed out"),
    ("tcp", b"HTTP/1.1 400 Bad Request\r\n\r\n" * 9, "another protocol|nothing that answers"),
    ("tls", b"", "distributed.comm.tls"),
    ("udp", b"", "unknown address scheme"),
)


def refusal_of(address: str) -> str:
    """The message with which an address is refused."""
    with pytest.raises(WorkerError) as refused, cluster_executor(address):
        pass
    return str(refused.value)


def test_strangers_at_an_address_are_one_line_each(monkeypatch, capfd):
    monkeypatch.setattr("giveway.studies.execution.cluster._CONNECT", 1.0)
    servers = [Stranger(greeting) for _, greeting, _ in STRANGERS]
    addresses = [
        f"{scheme}://127.0.0.1:{server.port}"
        for (scheme, *_), server in zip(STRANGERS, servers, strict=True)
    ]
    began = time.monotonic()
    with ThreadPoolExecutor(len(servers)) as threads:  # each waits for its probe, a process
        refusals = list(threads.map(refusal_of, addresses))
    for server in servers:
        server.close()
    assert capfd.readouterr() == ("", "")
    assert time.monotonic() - began < 60.0  # it ends at all, however busy the machine is
    for address, (*_, reason), said in zip(addresses, STRANGERS, refusals, strict=True):
        assert re.match(rf"cluster '{address}'.*({reason})[^\n]*\Z", said), said
