"""The watchdog of a vehicle: a process that starts the FMU's processes and ends them (Linux).

It never runs an FMU itself. For every episode it forks a worker from its own clean state, with all
modules imported. It reads what the worker prints, so that a flood of output neither blocks the
worker nor fills a disk. When the worker ends, it kills every process that the FMU may have started,
even hidden ones. The watchdog, not the vehicle's process, is the FMU's parent.

When the vehicle's process has ended, the watchdog removes the temporary folder and ends too. When
the vehicle is closed, the watchdog may be told to wait for another one, with nothing left of the
first.
"""

import ctypes
import gc
import os
import resource
import select
import signal
import socket
import sys
import tempfile
import warnings
from contextlib import suppress
from pathlib import Path
from time import monotonic, sleep
from typing import Final

from fmus.isolation.cleanup import LOG, remove, scratch_of
from fmus.isolation.exit_report import ExitReport, PrintedTail, out_of_memory_kills
from fmus.isolation.wire import END_WORKER, MESSAGE, RETIRE, SERVE, START_WORKER
from fmus.isolation.worker import Order, read_order, serve

_CHECK_INTERVAL: Final = 1000  # [ms] between checks that the vehicle's process still runs
_CONNECTION_NUMBER: Final = 200  # a high number: FMUs that wrongly close other files try low ones
_PR_SET_PDEATHSIG, _PR_SET_CHILD_SUBREAPER = 1, 36
_PTRACE_DETACH: Final = 17
_IGNORED_SIGNALS = (  # an FMU may send them to its parent process
    signal.SIGHUP, signal.SIGINT, signal.SIGQUIT, signal.SIGTERM, signal.SIGALRM,
    signal.SIGUSR1, signal.SIGUSR2, signal.SIGTSTP,
)  # fmt: skip
_DRAIN = 1 << 20  # [bytes] read at most after a worker has ended


def main(control: int, parent: int, folder: str) -> None:
    """Serve the vehicle of process ``parent``.

    Args:
        control: File descriptor of a socket of whole messages (SOCK_SEQPACKET).
        parent: Process id of the vehicle's process.
        folder: Temporary folder of the vehicle, with the pickled order in ``order``.
    """
    # os.fork warns of threads (Python 3.12): those of libraries sleep, and no FMU has run here.
    warnings.simplefilter("ignore", DeprecationWarning)
    folders = [Path(folder)]
    try:
        order = read_order(folder)
        order.import_ahead()
        with socket.socket(fileno=control) as connection:
            _Watchdog(connection, parent, order, folders).run()
    finally:
        for place in folders:
            remove(place)


class _Watchdog:
    def __init__(
        self, control: socket.socket, parent: int, order: Order, folders: list[Path]
    ) -> None:
        self._control, self._parent, self._order = control, parent, order
        self._folders = folders  # folders of the vehicle; empty while there is none
        self._worker: int | None = None
        self._report: ExitReport | None = None
        self._printed, self._output = PrintedTail(), -1
        self._oom_kills = 0
        # the watchdog becomes the parent of processes that the FMU leaves behind
        _prctl(_PR_SET_CHILD_SUBREAPER)
        self._wake, wake = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)
        signal.signal(signal.SIGCHLD, lambda _number, _frame: None)
        signal.set_wakeup_fd(wake, warn_on_full_buffer=False)
        for number in _IGNORED_SIGNALS:
            signal.signal(number, signal.SIG_IGN)
        signal.pthread_sigmask(signal.SIG_SETMASK, ())
        self._poll = select.poll()
        self._poll.register(control, select.POLLIN)
        self._poll.register(self._wake, select.POLLIN)
        gc.freeze()  # garbage collection in a worker then leaves memory pages shared
        gc.enable()  # only imports, which make no garbage, went without it

    def run(self) -> None:
        """Serve requests until the vehicle's process has ended."""
        serving = True
        while serving:
            for source, _event in self._poll.poll(_CHECK_INTERVAL):
                if source == self._output:
                    self._read_output()
                elif source == self._wake:
                    os.read(self._wake, 512)
                    self._reap()
                elif source == self._control.fileno():  # and not the output, closed just now
                    serving = self._answer_request()
            serving = serving and os.getppid() == self._parent
        self._end_worker()

    def _answer_request(self) -> bool:
        """Carry out a request of the vehicle, and return whether the vehicle still runs."""
        try:
            message, files, _flags, _sender = socket.recv_fds(self._control, MESSAGE, 1)
            if not message:
                return False
            number, what, argument = message.split(b" ", 2)
            answer = b""
            if what == START_WORKER:
                self._fork(files[0])
            elif what == END_WORKER:
                answer = self._end_worker(int(argument) / 1e3).encoded()
            elif what == RETIRE:
                self._retire()
            elif what == SERVE:
                self._serve(Path(os.fsdecode(argument)))
            self._control.send(b"%s %s" % (number, answer))
        except OSError as error:
            sys.stderr.write(f"{error}\n")  # the vehicle reads this if it still runs
            return False
        return True

    def _retire(self) -> None:
        """Remove all traces of the vehicle, and wait for another one."""
        self._end_worker()
        os.chdir("/")
        _print_to(Path(os.devnull))
        while self._folders:
            remove(self._folders.pop())

    def _serve(self, folder: Path) -> None:
        """Serve the vehicle of a folder as if this process had been started for it."""
        self._folders.append(folder)
        scratch = str(scratch_of(folder))
        os.environ["TMPDIR"] = tempfile.tempdir = scratch
        os.chdir(scratch)
        _print_to(folder / LOG)
        self._order = read_order(str(folder))
        self._order.import_ahead()

    def _fork(self, connection: int) -> None:
        self._end_worker()
        self._printed, self._report = PrintedTail(), None
        self._oom_kills = out_of_memory_kills()
        self._output, output = os.pipe()
        os.set_blocking(self._output, False)  # only this end: the worker's output must not be lost
        watchdog = os.getpid()
        worker = os.fork()
        if worker == 0:
            try:
                serve(self._order, _become_worker(watchdog, connection, output))
            finally:
                os._exit(1)
        self._worker = worker
        os.close(connection)
        os.close(output)
        self._poll.register(self._output, select.POLLIN)

    def _end_worker(self, patience: float = 0.0) -> ExitReport:
        """Wait up to ``patience`` [s] for the worker to end, then kill it; return its report."""
        end = monotonic() + patience
        self._reap()
        while self._worker is not None and monotonic() < end:
            self._read_output()
            sleep(1e-3)
            self._reap()
        if self._worker is not None:
            os.kill(self._worker, signal.SIGKILL)
            _pid, status = os.waitpid(self._worker, 0)
            self._record_end(self._worker, status, killed=True)
        return self._report or ExitReport(0, killed=False, oom=False, printed="")

    def _reap(self) -> None:
        """Collect all processes that have ended; record the worker's end if it is among them."""
        with suppress(ChildProcessError):
            while (found := os.waitpid(-1, os.WNOHANG))[0]:
                if os.WIFSTOPPED(found[1]):
                    _stop_tracing(*found)
                elif found[0] == self._worker:
                    self._record_end(*found, killed=False)

    def _record_end(self, worker: int, status: int, *, killed: bool) -> None:
        self._worker = None
        _kill_all_children(worker)
        self._read_output(_DRAIN)
        self._close_output()
        code = os.waitstatus_to_exitcode(status)
        oom = out_of_memory_kills() > self._oom_kills
        self._report = ExitReport(code, killed=killed, oom=oom, printed=self._printed.last_line())

    def _read_output(self, limit: int = 1 << 16) -> None:
        """Keep the end of what the worker and its children have printed since the last call."""
        with suppress(BlockingIOError):
            while limit > 0 and self._output >= 0:
                piece = os.read(self._output, 1 << 16)
                self._printed.add(piece)
                limit -= len(piece)
                if not piece:  # every process that could write has closed it
                    self._close_output()

    def _close_output(self) -> None:
        if self._output >= 0:
            self._poll.unregister(self._output)
            os.close(self._output)
            self._output = -1


def _print_to(file: Path) -> None:
    target = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_CLOEXEC, 0o600)
    os.dup2(target, 1)
    os.dup2(target, 2)
    os.close(target)


def _become_worker(watchdog: int, connection: int, output: int) -> socket.socket:
    """Detach this process from the watchdog, but let it be killed when the watchdog ends."""
    _prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != watchdog:
        os._exit(1)
    os.setsid()  # signals that the FMU sends to its process group reach nobody else
    signal.set_wakeup_fd(-1)
    for ignored in (signal.SIGCHLD, *_IGNORED_SIGNALS):
        signal.signal(ignored, signal.SIG_DFL)
    high = min(_CONNECTION_NUMBER, resource.getrlimit(resource.RLIMIT_NOFILE)[0] - 1)
    os.dup2(connection, high, inheritable=False)
    nothing = os.open(os.devnull, os.O_RDONLY)
    for number, source in enumerate((nothing, output, output)):
        os.dup2(source, number)
    os.closerange(3, high)
    os.closerange(high + 1, 1 << 16)
    with suppress(OSError):  # when memory runs out, the system shall kill the FMU first
        Path("/proc/self/oom_score_adj").write_text("500", encoding="ascii")
    return socket.socket(fileno=high)


def _kill_all_children(worker: int) -> None:
    """Kill and collect every child, including those inherited from killed ones."""
    children = Path(f"/proc/self/task/{os.getpid()}/children")
    with suppress(ChildProcessError):  # no children are left
        while True:
            try:
                pids = children.read_text(encoding="ascii").split()
            except FileNotFoundError:  # this kernel has no such list: kill the process group
                with suppress(ProcessLookupError):
                    os.killpg(worker, signal.SIGKILL)
                return
            for pid in pids:
                with suppress(ProcessLookupError):
                    os.kill(int(pid), signal.SIGKILL)
            os.waitpid(-1, 0)


def _stop_tracing(pid: int, status: int) -> None:
    """Stop tracing a process that asked its parent to trace it, as copy protections do."""
    ptrace = ctypes.CDLL(None)["ptrace"]
    ptrace(_PTRACE_DETACH, pid, None, ctypes.c_long(os.WSTOPSIG(status)))


def _prctl(option: int, value: int = 1) -> None:
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(option, ctypes.c_ulong(value), 0, 0, 0)
