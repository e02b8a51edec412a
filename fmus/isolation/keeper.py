"""What starts and buries the FMU's processes, as seen from the vehicle."""

from __future__ import annotations

import json
import os
import pickle
import secrets
import signal
import socket
import subprocess
import sys
import threading
from contextlib import suppress
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Any, Final, Protocol

from fmus.errors import FmuCrashError
from fmus.isolation.burial import Death, PrintedTail, decoded
from fmus.isolation.protocol import BURY, FORK, MESSAGE
from fmus.isolation.worker import Order

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fmus.preparation import Prepared

_IMPORT_TIMEOUT: Final = 120.0  # [s] on the busiest machine
_DEATH_TIMEOUT: Final = 10.0  # [s] a killed process that does not go: the system is in trouble
_BOOT: Final = (
    "import json, sys; sys.path[:], arguments = json.loads(sys.argv[1]); "
    "from fmus.isolation.{module} import main; main(*arguments)"
)
_LOST: Final = Death(None, killed=False, oom=False, printed="")


class Keeper(Protocol):
    """Starts and buries the processes of one FMU."""

    def begin(self) -> socket.socket:
        """A new process for the FMU; returns the connection to it.

        Raises:
            FmuCrashError: there can be none.
        """

    def bury(self, patience: float = 0.0) -> Death:
        """End the FMU's process, and all that it has started; returns how it ended.

        Args:
            patience: [s] in which it may end by itself.
        """

    def close(self) -> None:
        """End everything, and wait until it is gone."""


def make_keeper(prepared: Prepared, folder: Path) -> Keeper:
    """The keeper for this platform.

    Args:
        prepared: the vehicle.
        folder: temporary, the keeper's to write to; holds the unpacked FMU in ``fmu``, at the
            latest when a process begins.
    """
    order = Order(prepared.without_source(), folder / "fmu")
    (folder / "order").write_bytes(pickle.dumps(order))
    (folder / "scratch").mkdir()
    return (GuardedKeeper if sys.platform == "linux" else PlainKeeper)(prepared.path, folder)


class GuardedKeeper:
    """Has a guardian process, which imports what is needed while others go on (Linux).

    Args:
        path: of the FMU.
        folder: as for :func:`make_keeper`; the guardian removes it when it ends.
    """

    def __init__(self, path: Path, folder: Path) -> None:
        self._path = path
        self._owner = os.getpid()
        self._number = 0  # of the last question
        self._begun = False
        self._log = folder / "guardian.log"
        self._control, control = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        arguments = ("guardian", control.fileno(), self._owner, folder)
        with control, self._log.open("wb") as log:
            self._process = spawn(
                *arguments, folder=folder, output=log, pass_fds=(control.fileno(),)
            )

    def begin(self) -> socket.socket:
        """See :class:`Keeper`."""
        here, there = socket.socketpair()
        with there:
            try:
                self._ask(FORK, b"0", _IMPORT_TIMEOUT, there.fileno())
                self._begun = True
                return here
            except OSError:
                here.close()
        raise no_process(self._path, self._log.read_bytes() if self._log.exists() else b"")

    def bury(self, patience: float = 0.0) -> Death:
        """See :class:`Keeper`."""
        try:
            ms = b"%d" % round(1e3 * patience)
            return decoded(self._ask(BURY, ms, patience + _DEATH_TIMEOUT))
        except (OSError, ValueError, TypeError):
            return _LOST

    def _ask(self, what: bytes, argument: bytes, timeout: float, *files: int) -> bytes:
        """The guardian's answer; those to questions that were interrupted are passed over."""
        self._number += 1
        self._control.settimeout(timeout)
        socket.send_fds(self._control, [b"%d %s %s" % (self._number, what, argument)], files)
        while True:
            message = self._control.recv(MESSAGE)
            number, _, answer = message.partition(b" ")
            if not message:
                raise ConnectionResetError
            if int(number) == self._number:
                return answer

    def close(self) -> None:
        """See :class:`Keeper`."""
        if os.getpid() != self._owner:  # a fork of the vehicle's process: not its to end
            return
        self._control.close()
        if not self._begun:
            self._process.kill()
        try:
            self._process.wait(_DEATH_TIMEOUT)
        except subprocess.TimeoutExpired:
            kill_group(self._process)


class PlainKeeper:
    """Starts a new interpreter for every episode (where there is no guardian).

    Args:
        path: of the FMU.
        folder: as for :func:`make_keeper`.
    """

    def __init__(self, path: Path, folder: Path) -> None:
        self._path, self._folder = path, folder
        self._owner = os.getpid()
        self._process: subprocess.Popen[bytes] | None = None
        self._printed = PrintedTail()
        self._reader: threading.Thread | None = None

    def begin(self) -> socket.socket:
        """See :class:`Keeper`."""
        self.bury()
        token = secrets.token_hex(16)
        with socket.create_server(("127.0.0.1", 0)) as server:
            arguments = ("worker", server.getsockname()[1], token, self._folder)
            process = spawn(*arguments, folder=self._folder, output=subprocess.PIPE)
            self._process, self._printed = process, PrintedTail()
            self._reader = threading.Thread(target=self._read, args=(process,), daemon=True)
            self._reader.start()
            end = monotonic() + _IMPORT_TIMEOUT
            server.settimeout(0.1)
            while process.poll() is None and monotonic() < end:
                with suppress(TimeoutError):
                    connection, _address = server.accept()
                    connection.settimeout(5.0)
                    if connection.recv(len(token), socket.MSG_WAITALL) == token.encode():
                        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                        return connection
                    connection.close()
        raise no_process(self._path, self.bury().printed.encode())

    def bury(self, patience: float = 0.0) -> Death:
        """See :class:`Keeper`."""
        process, self._process = self._process, None
        if process is None or self._reader is None or os.getpid() != self._owner:
            return _LOST
        killed = False
        try:
            process.wait(patience)
        except subprocess.TimeoutExpired:
            killed = True
        kill_group(process)
        self._reader.join(_DEATH_TIMEOUT)
        return Death(process.returncode, killed, oom=False, printed=self._printed.last_line())

    def close(self) -> None:
        """See :class:`Keeper`."""
        self.bury()

    def _read(self, process: subprocess.Popen[bytes]) -> None:
        assert process.stdout is not None  # it is a pipe
        with process.stdout as output:
            while piece := os.read(output.fileno(), 1 << 16):
                self._printed.add(piece)


def spawn(
    module: str, *arguments: object, folder: Path, output: Any, pass_fds: Sequence[int] = ()
) -> subprocess.Popen[bytes]:
    """An interpreter like this one that runs ``main`` of a module of this package.

    Args:
        module: its name.
        arguments: of ``main``: numbers and texts.
        folder: the vehicle's temporary one.
        output: where it prints.
        pass_fds: files that it inherits.
    """
    scratch = str(folder / "scratch")
    values = [a if isinstance(a, int) else str(a) for a in arguments]
    flags = {
        "-E": sys.flags.ignore_environment,
        "-s": sys.flags.no_user_site,
        "-B": sys.flags.dont_write_bytecode,
    }
    given = json.dumps([[str(Path(entry).absolute()) for entry in sys.path], values])
    # -P: nothing is imported from the working directory before our paths are set
    return subprocess.Popen(
        [sys.executable, "-P", *(flag for flag, on in flags.items() if on)]
        + ["-c", _BOOT.format(module=module), given],
        stdin=subprocess.DEVNULL,
        stdout=output,
        stderr=subprocess.STDOUT,
        cwd=scratch,
        env=os.environ | {"TMPDIR": scratch},
        pass_fds=pass_fds,
        start_new_session=True,  # Ctrl-C in the terminal is not for it
        creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0),  # likewise on Windows
    )


def kill_group(process: subprocess.Popen[bytes]) -> None:
    """Kill a process, and its group where there are groups, and wait for its end."""
    with suppress(OSError):
        if sys.platform == "win32":
            process.kill()
        else:
            os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def no_process(path: Path, printed: bytes) -> FmuCrashError:
    """The error that the FMU can have no process, with the last line that was printed."""
    tail = PrintedTail()
    tail.add(printed)
    reason = tail.last_line() or "it ended at once"
    return FmuCrashError(f"{path}: no process of its own can be started for the FMU: {reason}")
