"""Co-Simulation: the FMU brings its own solver and is asked to step.

An FMU may discard a step; it then says how far it came, and the rest is done from there. If that
fails, the state before the step is restored and the step is done in halves, quarters, ...
"""

from __future__ import annotations

from contextlib import suppress
from ctypes import c_double
from typing import TYPE_CHECKING

from fmus.errors import FmuPlatformError
from fmus.fmi.calls import CallFailedError
from fmus.fmi.running import Instance
from fmus.fmi.status import DISCARD, ENDED, FATAL, WARNING

if TYPE_CHECKING:
    from ctypes import c_void_p

    from fmus.fmi.calls import Calls
    from fmus.fmi.running import Tick
    from fmus.fmi.values import Transfer

HALVINGS = 6  # of a step that an FMU discards
CONTINUATIONS = 100  # of one step from where the FMU has stopped
NEGLIGIBLE = 1e-9  # share of a step that is taken for nothing


class CoSimulation(Instance):
    """An FMU that steps by itself.

    Args:
        calls: the FMU's functions.
        tolerance: relative, told to the FMU; None: its own.
        rewinds: save the state before every step, so that it can be done again in smaller ones.
    """

    def __init__(self, calls: Calls, tolerance: float | None, *, rewinds: bool) -> None:
        super().__init__(calls, tolerance)
        self._rewinds = rewinds and calls.interface.saves_state
        self._start, self._step = c_double(), c_double()
        self._before: c_void_p | None = None  # state before the last step
        calls.function(calls.name("DoStep"))

    def make_tick(self, into: Transfer, out: Transfer) -> Tick:  # noqa: D102 - as in the base
        set_inputs, set_arguments = into.function, into.arguments
        get_outputs, get_arguments = out.function, out.arguments
        start, step = self._start, self._step
        self._stepper = stepper = self.calls.stepper(start, step)
        do_step, arguments, flags = stepper.do_step, stepper.arguments, stepper.flags
        note_status, complete = self.note_status, self._complete
        save = self._save if self._rewinds else None

        def tick(time: float, size: float) -> int:
            status = set_inputs(*set_arguments)
            if status and (status := note_status(status)) > WARNING:
                return status
            if save:
                save()
            start.value = time
            step.value = size
            status = do_step(*arguments)
            if (status or flags[0]) and (status := complete(status, time, size)) > WARNING:
                return status
            status = get_outputs(*get_arguments)
            return note_status(status) if status else 0

        return tick

    def _save(self) -> None:
        """Keep the state before a step, in a new handle: some FMUs do not reuse an old one."""
        if self._rewinds:
            before, self._before = self._before, None
            try:
                if before is not None:
                    self.calls.free_state(before)
                self._before = self.calls.save()
            except (CallFailedError, FmuPlatformError):  # the FMU can do less than it says
                self._rewinds = False

    def _complete(self, status: int, time: float, size: float) -> int:
        """Finish a step that the FMU did not complete."""
        status = self._continue(self.note_status(status), time, time + size, size)
        for halving in range(1, HALVINGS + 1):
            if status != DISCARD or self._before is None:
                break
            try:
                self.calls.restore(self._before)
            except CallFailedError as error:
                return self.note_status(error.status)
            parts = 1 << halving
            for part in range(parts):
                begin, end = time + size * part / parts, time + size * (part + 1) / parts
                status = self._do(begin, end)
                status = self._continue(status, begin, end, size)
                if status > WARNING:
                    break
        if status == DISCARD:
            self._worst = DISCARD
            tried = (
                f"and steps down to 1/{1 << HALVINGS} of it"
                if self._before
                else ("and cannot return to the state before it")
            )
            advice = "try a smaller `step` under [fmu] of the profile"
            self.messages.add(DISCARD, f"it discards the step, {tried}; {advice}")
        return status

    def _continue(self, status: int, time: float, end: float, size: float) -> int:
        """Go on from where the FMU has stopped in a step that was to reach ``end``."""
        for _ in range(CONTINUATIONS):
            if status > DISCARD or not (status == DISCARD or self._stepper.flags[0]):
                return status
            progress = self._stepper.progress()
            if progress.ended:
                return ENDED
            reached = progress.reached
            nothing = NEGLIGIBLE * size
            if reached is None or not time + nothing < reached <= end + nothing:
                return DISCARD
            if reached >= end - nothing:
                return WARNING
            time = reached
            status = self._do(time, end)
        return DISCARD

    def _do(self, begin: float, end: float) -> int:
        self._start.value = begin
        self._step.value = end - begin
        return self.note_status(self._stepper.do_step(*self._stepper.arguments))

    def stop(self) -> None:  # noqa: D102
        before, self._before = self._before, None
        if before is not None and self.calls.component and self._worst != FATAL:
            with suppress(CallFailedError, FmuPlatformError):  # a state that stays does no harm
                self.calls.free_state(before)
        super().stop()
