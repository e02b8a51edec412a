"""Limits of a run: how long it may take, and how often it is tried."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from giveway.processes.heartbeat import LOOP, SETTING_UP, Phase
from giveway.studies.execution.executor import WorkerError

# Wall-clock time [s] without progress of the loop that counts as a hang
HANG_LIMIT: Final = 120.0
ATTEMPTS: Final = 2  # Number of attempts at a run


@dataclass(frozen=True)
class Limits:
    """The time limits of a run.

    Attributes:
        hang: Time [s] without progress of the loop.
        run: Time [s] of the whole run, or infinity for no limit.
    """

    hang: float = HANG_LIMIT
    run: float = math.inf

    @classmethod
    def checked(cls, hang_limit: float, run_limit: float | None) -> Limits:
        """Return the limits from the user's numbers.

        Raises:
            WorkerError: a number is not above 0.
        """
        for name, value in (("hang_limit", hang_limit), ("run_limit", run_limit)):
            if value is not None and not value > 0.0:
                raise WorkerError(
                    f"{name} = {value!r}: expected seconds above 0; leave it out for the default"
                )
        return cls(hang_limit, math.inf if run_limit is None else run_limit)

    def quiet(self, phase: Phase, *, stopped: bool = False) -> float:
        """Return the time [s] for which nothing may change in a phase of a run.

        Args:
            phase: Phase of the run. STARTING: the worker has not taken it yet.
            stopped: True if somebody has stopped the process, which therefore cannot be busy.
        """
        busy = phase not in LOOP and phase is not Phase.STARTING and not stopped
        return SETTING_UP * self.hang if busy else self.hang
