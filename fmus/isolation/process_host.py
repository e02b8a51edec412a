"""The interface for starting and ending the FMU's processes."""

import pickle
import socket
import sys
from pathlib import Path
from typing import Protocol

from fmus.isolation.cleanup import scratch_of
from fmus.isolation.exit_report import ExitReport
from fmus.isolation.linux_host import LinuxHost
from fmus.isolation.portable_host import PortableHost
from fmus.isolation.worker import Order


class ProcessHost(Protocol):
    """Starts and ends the processes of one FMU.

    Attributes:
        sound: True as long as the FMU has not crashed, hung or broken its connection.
    """

    sound: bool

    def start_process(self) -> socket.socket:
        """Start a new process for the FMU and return the connection to it.

        Raises:
            FmuCrashError: the process cannot be started.
        """

    def end_process(self, patience: float = 0.0) -> ExitReport:
        """End the FMU's process and all processes that it has started; return how it ended.

        Args:
            patience: Time [s] in which it may end by itself.
        """

    def close(self) -> None:
        """End everything and wait until it has ended."""


def make_process_host(order: Order, folder: Path) -> ProcessHost:
    """Return the process host for this platform.

    Args:
        order: FMU and adapter that run in its processes.
        folder: Temporary folder to which the host may write. The unpacked FMU must be in the
            order's folder before a process starts.
    """
    (folder / "order").write_bytes(pickle.dumps(order))
    scratch_of(folder).mkdir()
    return (LinuxHost if sys.platform == "linux" else PortableHost)(order.prepared.path, folder)
