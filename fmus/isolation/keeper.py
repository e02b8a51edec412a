"""What starts and buries the FMU's processes, as seen from the vehicle."""

from __future__ import annotations

import json
import os
import pickle
import signal
import socket
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Final

from fmus.errors import FmuCrashError
from fmus.isolation.burial import Death, decoded
from fmus.isolation.guardian import BURY, FORK
from fmus.text import printable

if TYPE_CHECKING:
    from fmus.isolation.worker import Order

_IMPORT_TIMEOUT: Final = 120.0  # [s] on the busiest machine
_DEATH_TIMEOUT: Final = 10.0  # [s] a killed process that does not go: the system is in trouble
_BOOT: Final = (
    "import sys, json; sys.path[:] = json.loads(sys.argv[1]); "
    "from fmus.isolation.guardian import main; "
    "main(int(sys.argv[2]), int(sys.argv[3]), sys.argv[4])"
)
_LOST: Final = Death(None, killed=False, oom=False, printed="")


class Keeper:
    """The guardian process of one vehicle; it imports what it needs while others go on.

    Args:
        order: what to run; its folder is written to, and removed when the guardian ends.
    """

    def __init__(self, order: Order) -> None:
        self._order = order
        self._owner = os.getpid()
        folder = order.folder
        (folder / "order").write_bytes(pickle.dumps(order))
        self._log = folder / "guardian.log"
        self._control, control = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with control, self._log.open("wb") as log:
            self._process = subprocess.Popen(
                [*_python(), "-c", _BOOT, _paths(), str(control.fileno()), str(self._owner)]
                + [str(folder)],
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                cwd=_scratch(folder),
                env=os.environ | {"TMPDIR": str(_scratch(folder))},
                pass_fds=(control.fileno(),),
                start_new_session=True,  # Ctrl-C in the terminal is not for it
            )

    def begin(self) -> socket.socket:
        """A new process for the FMU; returns the connection to it.

        Raises:
            FmuCrashError: there can be none.
        """
        here, there = socket.socketpair()
        with there:
            try:
                self._control.settimeout(_IMPORT_TIMEOUT)
                socket.send_fds(self._control, [FORK], [there.fileno()])
                if self._control.recv(16) == b"ok":
                    return here
            except OSError:
                pass
        here.close()
        log = self._log.read_text("utf-8", "replace").splitlines() if self._log.exists() else []
        reason = printable(log[-1]) if log else "its guardian process is gone"
        msg = f"{self._order.path}: no process of its own can be started: {reason}"
        raise FmuCrashError(msg)

    def bury(self, patience: float = 0.0) -> Death:
        """End the FMU's process, and all that it has started; returns how it ended.

        Args:
            patience: [s] in which it may end by itself.
        """
        try:
            self._control.settimeout(patience + _DEATH_TIMEOUT)
            self._control.send(b"%s %d" % (BURY, round(1e3 * patience)))
            return decoded(self._control.recv(4096))
        except (OSError, ValueError, TypeError):
            return _LOST

    def close(self) -> None:
        """End everything, and wait until it is gone; nothing happens the second time."""
        if os.getpid() != self._owner:  # a fork of the vehicle's process: not its to end
            return
        self._control.close()
        try:
            self._process.wait(_DEATH_TIMEOUT)
        except subprocess.TimeoutExpired:
            with suppress(ProcessLookupError):
                os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()


def _python() -> list[str]:
    """The interpreter, as this one was started."""
    flags = {
        "-E": sys.flags.ignore_environment,
        "-s": sys.flags.no_user_site,
        "-B": sys.flags.dont_write_bytecode,
    }
    # -P: nothing is imported from the working directory before our paths are set
    return [sys.executable, "-P", *(flag for flag, on in flags.items() if on)]


def _paths() -> str:
    """Where this process imports from, wherever the other one is."""
    return json.dumps([str(Path(entry).absolute()) for entry in sys.path])


def _scratch(folder: Path) -> Path:
    """Where the FMU's process works and leaves what it writes."""
    scratch = folder / "scratch"
    scratch.mkdir(exist_ok=True)
    return scratch
