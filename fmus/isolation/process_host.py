"""What starts and buries the FMU's processes, as seen from the vehicle."""

from __future__ import annotations

import pickle
import sys
from typing import TYPE_CHECKING, Protocol

from fmus.isolation.cleanup import scratch_of
from fmus.isolation.linux_host import GuardedKeeper
from fmus.isolation.portable_host import PlainKeeper
from fmus.isolation.worker import Order

if TYPE_CHECKING:
    import socket
    from pathlib import Path

    from fmus.isolation.exit_report import Death
    from fmus.profile.preparation import Prepared


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
    scratch_of(folder).mkdir()
    return (GuardedKeeper if sys.platform == "linux" else PlainKeeper)(prepared.path, folder)
