"""The sharing of one processor by a vehicle and its FMU's process (Linux).

One of the two always waits for the other. On two processors, each step wakes both of them from
sleep. On one, the system only switches between them, which takes a quarter of the time. Therefore
the FMU's thread follows the vehicle to its processor, and during a quick step the vehicle lets
other processes go first instead of sleeping. An FMU with threads of its own keeps all processors,
as does every FMU on other systems.
"""

import ctypes
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Final

UNKNOWN: Final = -1
_SETTLED: Final = 20  # Number of steps after which an FMU that uses threads has started them
_CHECK_INTERVAL: Final = 1000  # Number of steps between two checks of its threads


def _lookup() -> Callable[[], int]:
    if sys.platform == "linux":
        function = getattr(ctypes.PyDLL(None), "sched_getcpu", None)
        if function is not None:
            function.argtypes, function.restype = (), ctypes.c_int
            return function  # type: ignore[no-any-return]
    return lambda: UNKNOWN


current: Final = _lookup()
"""Function that returns the number of the processor of this thread, or UNKNOWN."""


class Follower:
    """Keeps the FMU's thread on its vehicle's processor; it is made in the FMU's process."""

    def __init__(self) -> None:
        self._steps = 0
        self._at = UNKNOWN
        self._gave_up = sys.platform != "linux"
        self._usual = set() if self._gave_up else os.sched_getaffinity(0)

    def follow(self, processor: int) -> None:
        """Move to the processor of the vehicle, before a step.

        Args:
            processor: Processor of the vehicle, as :data:`current` returns it.
        """
        self._steps += 1
        if self._gave_up or (processor == self._at and self._steps % _CHECK_INTERVAL):
            return
        if self._steps < _SETTLED or processor not in self._usual:
            return
        try:
            threads = [int(entry.name) for entry in Path("/proc/self/task").iterdir()]
            self._gave_up = len(threads) > 1
            for thread in threads:
                os.sched_setaffinity(thread, self._usual if self._gave_up else {processor})
            self._at = processor
        except OSError:  # the system does not allow it, or a thread has ended meanwhile
            self._gave_up = True
