"""People of types that walk at red: SUMO's ``jmDriveAfterRedTime``.

For each time that occurs there is a block of signals of its own behind those that all others heed.
A signal of a block is closed if it is red for longer than that time, or closed without being red.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

_RED = frozenset("ru")


class RedWalkers:
    """Signals for people who walk at red.

    Args:
        times: Time [s] after the beginning of red up to which people walk, for each type that does.
        signals: Number of signals that people heed.
        first: Number of the first signal that is not used yet.
    """

    def __init__(self, times: Mapping[str, float], signals: int, first: int) -> None:
        self._signals = signals
        self._times = sorted(set(times.values()))
        self._first = {
            name: first + signals * self._times.index(time) for name, time in times.items()
        }
        self._start = first
        self._red = np.zeros(signals, dtype=np.bool_)
        self._since = np.full(signals, -np.inf)
        self.size = signals * len(self._times)  # number of these signals

    def __bool__(self) -> bool:
        return bool(self._times)

    def signals_for(self, kind: str, signals: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return the signals that a person of a type heeds, in place of those of its route.

        Args:
            kind: Id of the person's type.
            signals: Signals (k,) of its route; -1 where there is none.
        """
        if kind not in self._first:
            return signals
        heeded = (signals >= 0) & (signals < self._signals)
        return np.where(heeded, signals + self._first[kind], signals)

    def note(self, signal: int, letter: str, time: float) -> None:
        """Note a new state of a signal at a time [s]."""
        self._red[signal] = letter in _RED
        self._since[signal] = time

    def close(self, closed: NDArray[np.bool_], time: float) -> None:
        """Open or close the signals of people who walk at red.

        Args:
            closed: Marks of all signals; those that everybody heeds are up to date.
            time: Present time [s].
        """
        for block, limit in enumerate(self._times):
            walks = self._red & (time - self._since < limit)
            first = self._start + block * self._signals
            closed[first : first + self._signals] = closed[: self._signals] & ~walks
