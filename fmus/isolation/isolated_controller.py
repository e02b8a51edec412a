"""A controller FMU in a process of its own: whatever the FMU does, this process goes on."""

from __future__ import annotations

from collections.abc import Sequence
from math import isinf

from fmus.driving.controller import ControllerFmu
from fmus.errors import FmuStateError
from fmus.isolation import processor
from fmus.isolation.fmu_process import FmuProcess, while_starting
from fmus.isolation.wire import LOAD, START, STEP
from fmus.profile.controllers.controller_preparation import PreparedController


class IsolatedController:
    """A controller FMU in a process of its own; inputs and answer are in SI units.

    Nothing is started before the first call. Every :meth:`restart` uses a new process.

    Args:
        prepared: Prepared controller.

    Attributes:
        warnings: Warnings for the user.
    """

    def __init__(self, prepared: PreparedController) -> None:
        self.path = prepared.path
        self.warnings = [f"{prepared.path.name}: {note}" for note in prepared.notes]
        self._prepared = prepared
        self._nothing = prepared.profile.inputs.nothing
        self._process: FmuProcess | None = None
        self._begun = self._closed = False
        self._steps = 0

    def ask(self, seen: Sequence[float]) -> float:
        """Return the FMU's answer at this step, which may not be a finite number.

        Args:
            seen: Value of each input [SI]; infinite for an input without a value.

        Raises:
            FmuError: the FMU does not start, or does not do the step.
            FmuCrashError: the process died, or did not answer in time.
        """
        if not self._begun:
            self._begin()
        told = (float(processor.current()), *self._told(seen))
        (raw,) = self._exchange(STEP, told, self._prepared.profile.fmu.step_timeout)
        self._steps += 1
        return self._prepared.wiring.answer.to_si(raw)

    def restart(self) -> None:
        """Forget the past, so that the next call is the first one."""
        self._begun = False

    def close(self) -> None:
        """End the FMU and its process; a second call does nothing."""
        self._closed = True
        if self._process is not None:
            self._process.close()

    def _begin(self) -> None:
        """Start the FMU in a new process."""
        if self._closed:
            raise FmuStateError(f"{self.path}: the controller has been closed; make a new one")
        if self._process is None:
            self._process = FmuProcess(ControllerFmu, self._prepared)
        self._process.begin()
        self._steps = 0
        timeout = self._prepared.profile.fmu.start_timeout
        self._exchange(LOAD, (), timeout)
        self._exchange(START, (), timeout)
        self._begun = True

    def _exchange(self, what: bytes, numbers: Sequence[float], timeout: float) -> Sequence[float]:
        assert self._process is not None  # it has begun
        return self._process.ask(what, numbers, timeout, lambda: self._when(what))

    def _when(self, what: bytes) -> str:
        """Return the time of a request in words, for messages."""
        if what != STEP:
            return while_starting(what)
        return f"at {self._steps * self._prepared.step_size:.10g} s of its time"

    def _told(self, seen: Sequence[float]) -> list[float]:
        """Return the inputs in the FMU's units, within the ranges that it declares."""
        nothing = self._nothing
        told = [
            wire.to_raw(value if not isinf(value) else nothing)
            for wire, value in zip(self._prepared.wiring.inputs, seen, strict=True)
        ]
        for bound in self._prepared.bounds:
            raw = told[bound.index]
            if not bound.low <= raw <= bound.high:
                told[bound.index] = min(max(raw, bound.low), bound.high)
                if not isinf(seen[bound.index]):
                    self._note_bound(bound.index, bound.low, bound.high)
        return told

    def _note_bound(self, index: int, low: float, high: float) -> None:
        wire = self._prepared.wiring.inputs[index]
        allowed = f"{low:g} to {high:g} {wire.unit}".rstrip()
        note = f"{self.path.name}: {wire.channel.name} was limited to the FMU's {allowed}"
        if note not in self.warnings:
            self.warnings.append(note)
