"""The guardian of one vehicle: a process that starts the FMU's processes and buries them (Linux).

It never runs an FMU itself. For every episode it forks a worker from its own clean state, with
everything imported; it reads what the worker prints, so that a flood neither blocks nor fills
anything; and when the worker ends it kills all that the FMU may have started, however it hid. It
stands between the FMU and the vehicle's process: the FMU's parent is the guardian.

It ends, and removes the vehicle's temporary folder, when the vehicle's process is gone.
"""

from __future__ import annotations

import ctypes
import gc
import os
import resource
import select
import signal
import socket
import sys
import warnings
from contextlib import suppress
from pathlib import Path
from time import monotonic, sleep
from typing import Final

from fmus.isolation.cleanup import remove
from fmus.isolation.exit_report import Death, PrintedTail, out_of_memory_kills
from fmus.isolation.wire import BURY, FORK, MESSAGE
from fmus.isolation.worker import Order, read_order, serve

_WATCH: Final = 1000  # [ms] between looks whether the vehicle's process is still there
_HIGH: Final = 200  # FMUs that close or write to files that are not theirs try low numbers
_PR_SET_PDEATHSIG, _PR_SET_CHILD_SUBREAPER = 1, 36
_PTRACE_DETACH: Final = 17
_DEAF_TO = (  # what an FMU may send to its parent process
    signal.SIGHUP, signal.SIGINT, signal.SIGQUIT, signal.SIGTERM, signal.SIGALRM,
    signal.SIGUSR1, signal.SIGUSR2, signal.SIGTSTP,
)  # fmt: skip
_DRAIN = 1 << 20  # [bytes] read after a worker's death


def main(control: int, parent: int, folder: str) -> None:
    """Serve the vehicle of process ``parent``.

    Args:
        control: file descriptor of a socket of whole messages (SOCK_SEQPACKET).
        parent: process id.
        folder: the vehicle's temporary folder, with the pickled order in ``order``.
    """
    # The libraries' threads that os.fork warns of (Python 3.12) sleep; an FMU has not run here.
    warnings.simplefilter("ignore", DeprecationWarning)
    try:
        order = read_order(folder)
        order.import_ahead()
        with socket.socket(fileno=control) as connection:
            _Guardian(connection, parent, order).run()
    finally:
        remove(Path(folder))


class _Guardian:
    def __init__(self, control: socket.socket, parent: int, order: Order) -> None:
        self._control, self._parent, self._order = control, parent, order
        self._worker: int | None = None
        self._death: Death | None = None
        self._printed, self._output = PrintedTail(), -1
        self._oom_kills = 0
        _prctl(_PR_SET_CHILD_SUBREAPER)  # whatever the FMU starts falls to us when the FMU is gone
        self._wake, wake = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)
        signal.signal(signal.SIGCHLD, lambda _number, _frame: None)
        signal.set_wakeup_fd(wake, warn_on_full_buffer=False)
        for number in _DEAF_TO:
            signal.signal(number, signal.SIG_IGN)
        signal.pthread_sigmask(signal.SIG_SETMASK, ())
        self._poll = select.poll()
        self._poll.register(control, select.POLLIN)
        self._poll.register(self._wake, select.POLLIN)
        gc.freeze()  # collections in a worker leave the pages shared

    def run(self) -> None:
        """Until the vehicle's process is gone."""
        serving = True
        while serving:
            for source, _event in self._poll.poll(_WATCH):
                if source == self._output:
                    self._read_output()
                elif source == self._wake:
                    os.read(self._wake, 512)
                    self._reap()
                elif source == self._control.fileno():  # and no file closed a moment ago
                    serving = self._obey()
            serving = serving and os.getppid() == self._parent
        self._bury()

    def _obey(self) -> bool:
        """Do what the vehicle asks for; False: it is gone."""
        try:
            message, files, _flags, _sender = socket.recv_fds(self._control, MESSAGE, 1)
            if not message:
                return False
            number, what, argument = message.split(b" ")
            answer = b""
            if what == FORK:
                self._fork(files[0])
            elif what == BURY:
                answer = self._bury(int(argument) / 1e3).encoded()
            self._control.send(b"%s %s" % (number, answer))
        except OSError as error:
            sys.stderr.write(f"{error}\n")  # for the vehicle to read, if it is still there
            return False
        return True

    def _fork(self, connection: int) -> None:
        self._bury()
        self._printed, self._death = PrintedTail(), None
        self._oom_kills = out_of_memory_kills()
        self._output, output = os.pipe()
        os.set_blocking(self._output, False)  # only our end: what is printed shall not be lost
        guardian = os.getpid()
        worker = os.fork()
        if worker == 0:
            try:
                serve(self._order, _become_worker(guardian, connection, output))
            finally:
                os._exit(1)
        self._worker = worker
        os.close(connection)
        os.close(output)
        self._poll.register(self._output, select.POLLIN)

    def _bury(self, patience: float = 0.0) -> Death:
        """Make sure that the worker is dead, ``patience`` [s] from now, and tell how it died."""
        end = monotonic() + patience
        self._reap()
        while self._worker is not None and monotonic() < end:
            self._read_output()
            sleep(1e-3)
            self._reap()
        if self._worker is not None:
            os.kill(self._worker, signal.SIGKILL)
            _pid, status = os.waitpid(self._worker, 0)
            self._lay_out(self._worker, status, killed=True)
        return self._death or Death(0, killed=False, oom=False, printed="")

    def _reap(self) -> None:
        """Take note of the worker's death, if it has died, and of those of others."""
        with suppress(ChildProcessError):
            while (found := os.waitpid(-1, os.WNOHANG))[0]:
                if os.WIFSTOPPED(found[1]):
                    _let_go(*found)
                elif found[0] == self._worker:
                    self._lay_out(*found, killed=False)

    def _lay_out(self, worker: int, status: int, *, killed: bool) -> None:
        self._worker = None
        _kill_all_children(worker)
        self._read_output(_DRAIN)
        self._close_output()
        code = os.waitstatus_to_exitcode(status)
        oom = out_of_memory_kills() > self._oom_kills
        self._death = Death(code, killed=killed, oom=oom, printed=self._printed.last_line())

    def _read_output(self, limit: int = 1 << 16) -> None:
        """Keep the end of what the worker and its like have printed since the last time."""
        with suppress(BlockingIOError):
            while limit > 0 and self._output >= 0:
                piece = os.read(self._output, 1 << 16)
                self._printed.add(piece)
                limit -= len(piece)
                if not piece:  # all that could write have closed it
                    self._close_output()

    def _close_output(self) -> None:
        if self._output >= 0:
            self._poll.unregister(self._output)
            os.close(self._output)
            self._output = -1


def _become_worker(guardian: int, connection: int, output: int) -> socket.socket:
    """Cut what ties this process to the guardian, except that it dies with it."""
    _prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != guardian:
        os._exit(1)
    os.setsid()  # signals of the FMU to its process group reach nobody else
    signal.set_wakeup_fd(-1)
    for deaf in (signal.SIGCHLD, *_DEAF_TO):
        signal.signal(deaf, signal.SIG_DFL)
    high = min(_HIGH, resource.getrlimit(resource.RLIMIT_NOFILE)[0] - 1)
    os.dup2(connection, high, inheritable=False)
    nothing = os.open(os.devnull, os.O_RDONLY)
    for number, source in enumerate((nothing, output, output)):
        os.dup2(source, number)
    os.closerange(3, high)
    os.closerange(high + 1, 1 << 16)
    with suppress(OSError):  # short of memory, the system is to take the FMU first
        Path("/proc/self/oom_score_adj").write_text("500", encoding="ascii")
    return socket.socket(fileno=high)


def _kill_all_children(worker: int) -> None:
    """Kill and reap every child, also those that we inherit by that, until there is none."""
    children = Path(f"/proc/self/task/{os.getpid()}/children")
    with suppress(ChildProcessError):  # nobody left
        while True:
            try:
                pids = children.read_text(encoding="ascii").split()
            except FileNotFoundError:  # a kernel without such lists: those that did not hide
                with suppress(ProcessLookupError):
                    os.killpg(worker, signal.SIGKILL)
                return
            for pid in pids:
                with suppress(ProcessLookupError):
                    os.kill(int(pid), signal.SIGKILL)
            os.waitpid(-1, 0)


def _let_go(pid: int, status: int) -> None:
    """Trace no process that wanted to be traced, as protection against copying does."""
    ptrace = ctypes.CDLL(None)["ptrace"]
    ptrace(_PTRACE_DETACH, pid, None, ctypes.c_long(os.WSTOPSIG(status)))


def _prctl(option: int, value: int = 1) -> None:
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(option, ctypes.c_ulong(value), 0, 0, 0)
