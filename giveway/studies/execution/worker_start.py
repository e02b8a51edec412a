"""The start of a worker's process: an interpreter like this one, connected by a socket."""

import os
import secrets
import socket
import subprocess
import sys
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from time import monotonic
from typing import IO, Final

from giveway.processes.interpreter import command

# Time [s] to import everything and compile the kernels, on a busy machine
START_LIMIT: Final = 600.0
_BOOT: Final = "from giveway.studies.execution.worker_program import main; main(*arguments)"
_ONE_THREAD: Final = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1"
)  # runs are parallel already, and thread pools would need more memory


def start(
    folder: Path, temporary: Path, printed: IO[bytes]
) -> tuple[subprocess.Popen[bytes], socket.socket]:
    """Start a worker, and return its process and the study's end of the connection.

    Args:
        folder: Folder of the worker.
        temporary: Folder for its temporary files.
        printed: File for its standard error; its standard output is not kept.

    Raises:
        OSError: the process cannot be started.
    """
    if sys.platform == "win32":
        return _start_with_callback(folder, temporary, printed)
    here, there = socket.socketpair()
    try:
        with there:
            arguments: list[int | str] = [there.fileno(), str(folder), os.getpid()]
            process = _popen(arguments, temporary, printed, pass_fds=(there.fileno(),))
    except BaseException:
        here.close()
        raise
    return process, here


def _start_with_callback(
    folder: Path, temporary: Path, printed: IO[bytes]
) -> tuple[subprocess.Popen[bytes], socket.socket]:
    """Start a worker that connects by itself and sends a token, if sockets cannot be inherited."""
    token = secrets.token_hex(16)
    with socket.create_server(("127.0.0.1", 0)) as server:
        arguments: list[int | str] = [server.getsockname()[1], str(folder), os.getpid(), token]
        process = _popen(arguments, temporary, printed)
        server.settimeout(0.1)
        end = monotonic() + START_LIMIT
        while process.poll() is None and monotonic() < end:
            with suppress(TimeoutError):
                connection, _address = server.accept()
                connection.settimeout(5.0)
                if connection.recv(len(token), socket.MSG_WAITALL) == token.encode():
                    return process, connection
                connection.close()
    process.kill()
    process.wait()
    raise OSError(f"a worker ended while it started (exit code {process.returncode})")


def _popen(
    arguments: Sequence[int | str],
    temporary: Path,
    printed: IO[bytes],
    pass_fds: Sequence[int] = (),
) -> subprocess.Popen[bytes]:
    places = dict.fromkeys(("TMPDIR", "TEMP", "TMP"), str(temporary))
    return subprocess.Popen(
        command(_BOOT, list(arguments)),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=printed,
        env=_ONE_THREAD | os.environ | places,
        pass_fds=pass_fds,
        start_new_session=True,  # Ctrl-C in the terminal must not reach the worker
        creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0),  # the same on Windows
    )
