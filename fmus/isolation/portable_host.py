"""The process host without a watchdog, for systems other than Linux."""

import os
import secrets
import socket
import subprocess
import threading
from contextlib import suppress
from pathlib import Path
from time import monotonic
from typing import Final

from fmus.isolation.exit_report import ExitReport, PrintedTail
from fmus.isolation.spawning import IMPORT_TIMEOUT, kill_group, no_process, spawn

_READ_TIMEOUT: Final = 1.0  # [s] wait for the last output: a process left behind may hold the pipe


class PortableHost:
    """A host that starts a new interpreter for every episode.

    Args:
        path: Path of the FMU.
        folder: Temporary folder.

    Attributes:
        sound: True as long as the FMU has not crashed, hung or broken its connection.
    """

    def __init__(self, path: Path, folder: Path) -> None:
        self.sound = True
        self._path, self._folder = path, folder
        self._process: subprocess.Popen[bytes] | None = None
        self._printed = PrintedTail()
        self._reader: threading.Thread | None = None

    def start_process(self) -> socket.socket:
        """Start a new process for the FMU and return the connection to it.

        Raises:
            FmuCrashError: the process cannot be started.
        """
        self.end_process()
        token = secrets.token_hex(16)
        with socket.create_server(("127.0.0.1", 0)) as server:
            arguments = ("worker", server.getsockname()[1], token, self._folder)
            process = spawn(self._path, *arguments, folder=self._folder, output=subprocess.PIPE)
            self._process, self._printed = process, PrintedTail()
            self._reader = threading.Thread(target=self._read, args=(process,), daemon=True)
            self._reader.start()
            end = monotonic() + IMPORT_TIMEOUT
            server.settimeout(0.1)
            while process.poll() is None and monotonic() < end:
                with suppress(TimeoutError):
                    connection, _address = server.accept()
                    connection.settimeout(5.0)
                    if connection.recv(len(token), socket.MSG_WAITALL) == token.encode():
                        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                        return connection
                    connection.close()
        raise no_process(self._path, self.end_process().printed.encode())

    def end_process(self, patience: float = 0.0) -> ExitReport:
        """End the FMU's process and all processes that it has started; return how it ended.

        Args:
            patience: Time [s] in which it may end by itself.
        """
        process, self._process = self._process, None
        if process is None or self._reader is None:
            return ExitReport(None, killed=False, oom=False, printed="")
        killed = False
        try:
            process.wait(patience)
        except subprocess.TimeoutExpired:
            killed = True
        kill_group(process)
        self._reader.join(_READ_TIMEOUT)
        return ExitReport(process.returncode, killed, oom=False, printed=self._printed.last_line())

    def close(self) -> None:
        """End everything and wait until it has ended."""
        self.end_process()

    def _read(self, process: subprocess.Popen[bytes]) -> None:
        assert process.stdout is not None  # it is a pipe
        with process.stdout as output:
            while piece := os.read(output.fileno(), 1 << 16):
                self._printed.add(piece)
