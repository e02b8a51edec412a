"""A vehicle and its FMU's process take turns on one processor (Linux).

One of the two always waits for the other. On two processors, each step wakes both of them from
sleep; on one, the system only switches between them, in a quarter of the time. Therefore the FMU's
thread follows the vehicle, and the vehicle, for the time of a quick step, lets others go first
instead of falling asleep. An FMU with threads of its own keeps all processors, and so does every
FMU on other systems.
"""

import ctypes
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Final

UNKNOWN: Final = -1
_SETTLED: Final = 20  # steps after which an FMU that works in threads has started them
_CHECK_INTERVAL: Final = 1000  # steps between two looks at its threads


def _lookup() -> Callable[[], int]:
    if sys.platform == "linux":
        function = getattr(ctypes.PyDLL(None), "sched_getcpu", None)
        if function is not None:
            function.argtypes, function.restype = (), ctypes.c_int
            return function  # type: ignore[no-any-return]
    return lambda: UNKNOWN


current: Final = _lookup()
"""The number of the processor that this thread runs on; UNKNOWN where the system does not say."""


class Follower:
    """Keeps the FMU's thread on its vehicle's processor; made in the FMU's process."""

    def __init__(self) -> None:
        self._steps = 0
        self._at = UNKNOWN
        self._gave_up = sys.platform != "linux"
        self._usual = set() if self._gave_up else os.sched_getaffinity(0)

    def follow(self, processor: int) -> None:
        """Move to the processor of the vehicle, before a step.

        Args:
            processor: Processor that the vehicle runs on, as :data:`current` tells it.
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
