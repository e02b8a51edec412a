"""A worker's program: it makes one run after the other, as long as its study lives."""

import contextlib
import faulthandler
import gc
import itertools
import json
import os
import signal
import socket
import sys
import traceback
from pathlib import Path
from typing import Final

from giveway.errors import GivewayError
from giveway.journal.journal import Journal
from giveway.processes.child import TRACEBACK_FILE, die_with
from giveway.processes.heartbeat import Heartbeat, Phase
from giveway.studies.execution.worker_messages import ERROR, READY, RECORD, REFUSED, Line
from giveway.studies.record import Task

SUMO_FILE: Final = "sumo"  # File with SUMO's messages during the run
# Lowest number of our own files: FMUs that wrongly close or write files use low ones
_HIGH: Final = 200
_TIDY: Final = 25  # Number of runs between two garbage collections
# Linux score: if memory runs out, the system ends a worker and not the study
_OOM_SCORE: Final = "500"


def main(connection: int, folder: str, parent: int, token: str = "") -> None:
    """Serve the study in process ``parent``.

    Args:
        connection: File descriptor of the socket to the study, or the port to connect to if sockets
            cannot be inherited.
        folder: Folder of this worker for heartbeat and traceback.
        parent: Process id of the study.
        token: Token by which a worker that connects proves itself.
    """
    die_with(parent)
    gc.disable()  # imports make no garbage, and each search for it takes longer
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the study decides what Ctrl-C means
    line = Line(_connected(connection, token))
    _raise_oom_score()
    # faulthandler keeps only the number of the file
    with (Path(folder) / TRACEBACK_FILE).open("w", encoding="utf-8") as file:
        faulthandler.enable(file)
        heartbeat = Heartbeat(Path(folder))
        from fmus import keep_unpacked, processes_reused
        from giveway.precompile import compile_kernels_once
        from giveway.studies.execution import perform as performing  # noqa: F401 - no run waits for it
        from giveway.sumo.library import import_libsumo
        from giveway.sumo.scratch import keep_scratch

        keep_unpacked()  # the unpacked files are removed with this worker's temporary files
        keep_scratch()
        import_libsumo()  # here, since a missing libsumo must not count as a failed run
        # here, since half a minute of compiling must not look like a hanging run
        compile_kernels_once()
        gc.freeze()  # modules stay loaded, so garbage collection need not look at them
        gc.enable()
        line.send(READY)
        runs = itertools.count(1)
        with contextlib.suppress(EOFError), processes_reused():
            while message := line.receive():
                task = Task(**json.loads(message[1]))
                heartbeat.step(0, 0.0)
                heartbeat.beat(Phase.LOADING)
                line.send(*_answer(task, heartbeat, Path(folder)))
                if next(runs) % _TIDY == 0:
                    gc.collect()  # a run leaves too few objects to trigger it
    os._exit(0)  # skips the destructors of native code


def _answer(task: Task, heartbeat: Heartbeat, folder: Path) -> tuple[bytes, bytes]:
    """Make the run, and return kind and payload of the message that reports it."""
    from giveway.studies import identity
    from giveway.studies.execution import perform as performing

    try:
        identity.require_same(task)
    except GivewayError as error:
        return REFUSED, str(error).encode("utf-8", "replace")
    try:
        record = performing.perform(task, Journal(None, heartbeat), folder / SUMO_FILE)
        return RECORD, record.to_json().encode()
    except Exception as error:  # any error is reported, and the study continues
        return ERROR, _one_line(error).encode("utf-8", "replace")


def _one_line(error: Exception) -> str:
    """Return the error as one line, as in "ValueError: what (in file.py, line 12)"."""
    words = "".join(traceback.format_exception_only(error)).split()
    frames = traceback.extract_tb(error.__traceback__)
    place = f" (in {Path(frames[-1].filename).name}, line {frames[-1].lineno})" if frames else ""
    return " ".join(words) + place


def _connected(connection: int, token: str) -> socket.socket:
    """Return the socket on a high file descriptor, which native code is unlikely to use."""
    if sys.platform == "win32":
        called = socket.create_connection(("127.0.0.1", connection))
        called.sendall(token.encode())
        return called
    import resource

    soft, _hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    high = _HIGH if soft == resource.RLIM_INFINITY else min(_HIGH, soft - 1)
    os.dup2(connection, high, inheritable=False)
    os.close(connection)
    return socket.socket(fileno=high)


def _raise_oom_score() -> None:
    with contextlib.suppress(OSError):  # exists on Linux only
        Path("/proc/self/oom_score_adj").write_text(_OOM_SCORE, encoding="ascii")
