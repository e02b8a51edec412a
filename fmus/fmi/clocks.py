"""The ticking of input clocks in event mode (FMI 3)."""

from __future__ import annotations

from collections.abc import Sequence
from ctypes import c_bool, c_double, c_int, c_size_t, c_uint32
from math import inf

from fmus.fmi.calls import Calls
from fmus.profile.clocks import Ticking

NEGLIGIBLE = 1e-9  # [s] difference of two times that are the same
CHANGED = 2  # fmi3IntervalQualifier


class Clocks:
    """The clocks of an instance, and the times of their next ticks.

    Args:
        calls: The FMU's functions.
        tickings: Clocks that tick.
    """

    def __init__(self, calls: Calls, tickings: Sequence[Ticking]) -> None:
        self._calls = calls
        self._clocks = [_Clock(ticking, calls.start_time) for ticking in tickings]
        references = [one.ticking.reference for one in self._clocks]
        self._references = references
        calls.active = frozenset()

    @property
    def needed(self) -> bool:
        """Return whether any variable belongs to one of the clocks."""
        return any(one.ticking.needed for one in self._clocks)

    @property
    def next(self) -> float:
        """The time of the next tick [s]; infinite without one."""
        return min((one.next for one in self._clocks), default=inf)

    def try_out(self) -> None:
        """Set all clocks to inactive, which an FMU that ticks can do in event mode.

        Raises:
            CallFailedError: the FMU refuses.
        """
        self._set([False] * len(self._clocks))

    def activate(self, time: float) -> None:
        """Let the clocks tick whose time [s] has come.

        Raises:
            CallFailedError: the FMU refuses.
        """
        due = [one.next <= time + NEGLIGIBLE for one in self._clocks]
        if any(due):
            self._set(due)
            ticking = (r for r, now in zip(self._references, due, strict=True) if now)
            self._calls.active = frozenset(ticking)
            for one, ticks in zip(self._clocks, due, strict=True):
                if ticks:
                    one.tick()

    def ask(self, time: float) -> None:
        """End the ticks, and ask for intervals that the description does not tell, at a time [s].

        Raises:
            CallFailedError: the FMU refuses.
        """
        self._calls.active = frozenset()
        for one in self._clocks:
            if one.asked and (one.fresh or not one.ticking.repeats):
                one.fresh = False
                reference = (c_uint32 * 1)(one.ticking.reference)
                intervals, qualifiers = (c_double * 1)(), (c_int * 1)()
                name = self._calls.name("Get", "IntervalDecimal")
                self._calls.call(name, reference, c_size_t(1), intervals, qualifiers)
                if qualifiers[0] == CHANGED:
                    one.follow(time, intervals[0])

    def _set(self, active: Sequence[bool]) -> None:
        chosen = [n for n, one in enumerate(active) if one] or range(len(active))
        references = (c_uint32 * len(chosen))(*(self._references[n] for n in chosen))
        values = (c_bool * len(chosen))(*(active[n] for n in chosen))
        name = self._calls.name("Set", "Clock")
        self._calls.call(name, references, c_size_t(len(chosen)), values)


class _Clock:
    """One clock: its ticks are at origin + k period."""

    def __init__(self, ticking: Ticking, start: float) -> None:
        self.ticking = ticking
        self.asked = ticking.period is None
        self._period = inf if ticking.period is None else ticking.period
        self._origin = start + (ticking.shift or 0.0)
        self._count = 0
        self.next = inf if self.asked else self._origin
        self.fresh = True  # the FMU has not been asked since the last tick

    def tick(self) -> None:
        self._count += 1
        self.fresh = True
        self.next = self._origin + self._count * self._period if self.ticking.repeats else inf

    def follow(self, time: float, interval: float) -> None:
        """Tick after an interval [s] that the FMU has named at a time [s]."""
        self._period = max(interval, NEGLIGIBLE)
        if self.ticking.shift is None or self._count:
            self._origin = time + self._period
        self._count = 0
        self.next = self._origin
