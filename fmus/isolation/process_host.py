"""The host of this platform that starts and ends the FMU's processes."""

import pickle
import sys
from pathlib import Path

from fmus.isolation.cleanup import scratch_of
from fmus.isolation.linux_host import LinuxHost
from fmus.isolation.portable_host import PortableHost
from fmus.isolation.worker import Order

ProcessHost = LinuxHost | PortableHost
"""Starts and ends the processes of one FMU."""


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
