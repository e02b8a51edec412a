"""The FMU's own process: it runs one FMU for one episode, as requested through a socket."""

import ctypes
import gc
import os
import pickle
import signal
import socket
import sys
import threading
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from time import sleep
from typing import Any, NoReturn

from fmus.description.model import Kind
from fmus.errors import FmuError
from fmus.isolation.hosted import Hosted
from fmus.isolation.processor import Follower
from fmus.isolation.wire import (
    CONNECTION_LOST,
    DONE,
    FAILED,
    LOAD,
    QUIT,
    START,
    STEP,
    Text,
    receive,
    reply,
    reply_layout,
    request_layout,
)
from fmus.text import printable

# Largest numbers: of warnings, of characters of a warning, of characters of an error
_WARNINGS, _WARNING, _MESSAGE = 20, 400, 2000


@dataclass(frozen=True)
class Order:
    """The order for a process: the FMU, its adapter, and the folder of the unpacked FMU."""

    hosted: type[Hosted]
    prepared: Any
    folder: Path

    def import_ahead(self) -> None:
        """Import the modules that the FMU will need, so that forked workers need not do it."""
        if self.prepared.wiring.interface.kind is Kind.MODEL_EXCHANGE:
            from fmus.fmi import cvode

            cvode.available()


def read_order(folder: str) -> Order:
    """Return the order that the client has left in its temporary folder."""
    order = pickle.loads(Path(folder, "order").read_bytes())
    assert isinstance(order, Order)
    return order


def main(port: int, token: str, folder: str) -> NoReturn:
    """Run as a worker without a watchdog, and connect back to the client.

    Args:
        port: Port on this machine.
        token: Proof that this is the expected worker.
        folder: Temporary folder.
    """
    gc.enable()  # after the imports, as in the watchdog
    parent = os.getppid()

    def watch() -> None:
        while os.getppid() == parent:
            sleep(1.0)
        os._exit(CONNECTION_LOST)

    threading.Thread(target=watch, daemon=True).start()
    connection = socket.create_connection(("127.0.0.1", port))
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    connection.sendall(token.encode())
    serve(read_order(folder), connection)


def serve(order: Order, connection: socket.socket) -> NoReturn:
    """Answer requests until the connection is closed, then end the process."""
    status = CONNECTION_LOST
    with suppress(BaseException):  # on any exception, the other side notices the closed connection
        _protect()
        _Worker(order, connection).run()
        status = 0
    os._exit(status)  # runs no exit handlers, neither the FMU's nor giveway's


def _protect() -> None:
    """Let the FMU's output be flushed line by line, and no core file be written at a crash."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the client handles Ctrl-C
    if sys.platform != "win32":
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        libc = ctypes.CDLL(None)
        for name in ("stdout", "__stdoutp"):
            with suppress(ValueError):  # this C library has another name for it
                line_wise = 1  # _IOLBF: Linux and macOS agree
                libc.setvbuf(ctypes.c_void_p.in_dll(libc, name), None, line_wise, ctypes.c_size_t())


class _Worker:
    def __init__(self, order: Order, connection: socket.socket) -> None:
        self._order = order
        self._connection = connection
        self._hosted: Hosted | None = None
        self._warned = 0
        self._follower = Follower()
        asked, answered = order.hosted.numbers(order.prepared)
        self._requests = request_layout(asked)
        self._layout, self._answered = reply_layout(answered), answered

    def run(self) -> None:
        while (request := receive(self._connection, self._requests)) is not None:
            what, number, numbers = request
            try:
                text = self._do(what, numbers)
            except FmuError as error:
                self._refuse(number, type(error).__name__, str(error))
            # a fault of giveway, or of an FMU that changes Python's state
            except Exception as error:
                self._refuse(number, "", f"{type(error).__name__}: {printable(error)}")
            else:
                reply(self._connection, DONE, number, self._state(), self._layout, text)
                if what == QUIT:
                    return

    def _do(self, what: bytes, numbers: Sequence[float]) -> Text | None:
        hosted = self._hosted
        if what == STEP and hosted is not None:
            self._follower.follow(int(numbers[0]))
            hosted.step(numbers)
        elif what == LOAD:
            self._hosted = self._order.hosted(self._order.prepared, self._order.folder)
        elif what == START and hosted is not None:
            hosted.start(numbers)
        elif what == QUIT and hosted is not None:
            hosted.close()
        return self._new_warnings()

    def _new_warnings(self) -> Text | None:
        """Return the warnings that have not been sent yet."""
        warnings = self._hosted.warnings if self._hosted is not None else []
        if len(warnings) == self._warned:
            return None
        new = warnings[self._warned :][:_WARNINGS]
        self._warned = len(warnings)
        return {"warnings": [printable(w, _WARNING) for w in new]}

    def _state(self) -> Sequence[float]:
        state = () if self._hosted is None else self._hosted.state()
        return state if len(state) == self._answered else (0.0,) * self._answered

    def _refuse(self, number: int, kind: str, message: str) -> None:
        text: dict[str, Any] = {"error": kind, "message": printable(message, _MESSAGE)}
        text["time"] = 0.0 if self._hosted is None else self._hosted.time
        text |= self._new_warnings() or {}
        reply(self._connection, FAILED, number, self._state(), self._layout, text)
