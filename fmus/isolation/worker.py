"""The FMU's own process: it runs one vehicle for one episode, as requested through a socket."""

import ctypes
import os
import pickle
import signal
import socket
import sys
import threading
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from time import sleep
from typing import Any, NoReturn

from fmus.description.model import Kind
from fmus.driving.vehicle import VehicleFmu
from fmus.errors import FmuError
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
)
from fmus.profile.preparation import Prepared
from fmus.text import printable

_WARNINGS, _WARNING, _MESSAGE = 20, 400, 2000  # number, characters: JSON stays below its limit


@dataclass(frozen=True)
class Order:
    """What the process shall run: a vehicle, and the folder that holds its unpacked FMU."""

    prepared: Prepared
    folder: Path

    def vehicle(self) -> VehicleFmu:
        """The vehicle, its FMU loaded into this process."""
        return VehicleFmu.unpacked(self.prepared, self.folder)

    def import_ahead(self) -> None:
        """Import what the vehicle will need, so that forked workers need not import it again."""
        if self.prepared.wiring.interface.kind is Kind.MODEL_EXCHANGE:
            from fmus.fmi import cvode

            cvode.available()


def read_order(folder: str) -> Order:
    """The order that the vehicle's process has left in its temporary folder."""
    order = pickle.loads(Path(folder, "order").read_bytes())
    assert isinstance(order, Order)
    return order


def main(port: int, token: str, folder: str) -> NoReturn:
    """Run as a worker without a watchdog; connect back to the vehicle's process.

    Args:
        port: on this machine.
        token: proves to the vehicle that this is its worker.
        folder: the vehicle's temporary folder.
    """
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
    """Answer requests until the connection is closed; then end the process."""
    status = CONNECTION_LOST
    with suppress(BaseException):  # whatever happens, the other side notices the closed connection
        _protect()
        _Worker(order, connection).run()
        status = 0
    os._exit(status)  # runs neither the FMU's exit handlers nor ours


def _protect() -> None:
    """Have the FMU's output flushed line by line, and no core file written at a crash."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is handled by the vehicle's process
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
        self._vehicle: VehicleFmu | None = None
        self._warned = 0
        self._follower = Follower()
        self._recorded = len(order.prepared.wiring.recorded)
        self._layout = reply_layout(self._recorded)

    def run(self) -> None:
        while (request := receive(self._connection)) is not None:
            what, number, first, second = request
            try:
                text = self._do(what, first, second)
            except FmuError as error:
                self._refuse(number, type(error).__name__, str(error))
            except Exception as error:  # a fault of giveway, or an FMU that tampers with Python
                self._refuse(number, "", f"{type(error).__name__}: {printable(error)}")
            else:
                reply(self._connection, DONE, number, self._state(), self._layout, text)
                if what == QUIT:
                    return

    def _do(self, what: bytes, first: float, second: float) -> Text | None:
        vehicle = self._vehicle
        if what == STEP and vehicle is not None:
            self._follower.follow(int(second))
            vehicle.step(first)
        elif what == LOAD:
            self._vehicle = self._order.vehicle()
        elif what == START and vehicle is not None:
            vehicle.start(position=first, speed=second)
        elif what == QUIT and vehicle is not None:
            vehicle.close()
        return self._new_warnings()

    def _new_warnings(self) -> Text | None:
        """Warnings that have not been sent yet."""
        warnings = self._vehicle.warnings if self._vehicle is not None else []
        if len(warnings) == self._warned:
            return None
        new = warnings[self._warned :][:_WARNINGS]
        self._warned = len(warnings)
        return {"warnings": [printable(w, _WARNING) for w in new]}

    def _state(self) -> tuple[float, ...]:
        vehicle, count = self._vehicle, self._recorded
        if vehicle is None:
            return (0.0,) * (3 + count)
        state = vehicle.position, vehicle.speed, vehicle.acceleration
        if not count:
            return state
        recorded = vehicle.recorded
        return (*state, *(recorded if len(recorded) == count else (0.0,) * count))

    def _refuse(self, number: int, kind: str, message: str) -> None:
        text: dict[str, Any] = {"error": kind, "message": printable(message, _MESSAGE)}
        text["time"] = 0.0 if self._vehicle is None else self._vehicle.time
        text |= self._new_warnings() or {}
        reply(self._connection, FAILED, number, self._state(), self._layout, text)
