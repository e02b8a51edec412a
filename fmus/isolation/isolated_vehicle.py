"""A vehicle FMU in a process of its own: whatever the FMU does, this process goes on."""

import os
from collections.abc import Mapping, Sequence
from math import isfinite

from fmus.description.model import Value
from fmus.errors import FmuOutputError, FmuStateError
from fmus.interfaces.vehicle import Vehicle
from fmus.isolation import processor
from fmus.isolation.fmu_process import FmuProcess, while_starting
from fmus.isolation.hosted import HostedVehicle
from fmus.isolation.wire import LOAD, START, STEP
from fmus.profile.preparation import prepare
from fmus.profile.vehicle_profile import VehicleProfile


class IsolatedVehicle(Vehicle):
    """A vehicle FMU in a process of its own, with the interface of :class:`fmus.VehicleFmu`.

    A crash, hang or end of the process becomes an :class:`FmuCrashError`. Changes of the process
    (working directory, locale, floating-point traps, signals, output) do not reach this one. Every
    start uses a new process. The binary is loaded at the start, so a binary that cannot be loaded
    is reported there.

    Args:
        path: Path of the .fmu file.
        step_size: Step size [s].
        profile: Roles of the FMU's variables, and time limits, or None as for ``VehicleFmu``.
        start_values: Further start values by variable name.

    Raises:
        FmuFileError: the file is missing, or no readable FMU.
        FmuInterfaceError: the FMU cannot be run.
        FmuPlatformError: it has no binary for this platform.
        FmuProfileError: the profile does not fit the FMU.
        FmuVariableError: a variable is missing, or is not what it is used for.
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        *,
        step_size: float,
        profile: VehicleProfile | None = None,
        start_values: Mapping[str, Value] | None = None,
    ) -> None:
        prepared = prepare(path, step_size=step_size, profile=profile, start_values=start_values)
        super().__init__(prepared.path)
        self.step_size = step_size
        self.warnings = []
        self._start_timeout = prepared.profile.fmu.start_timeout
        self._step_timeout = prepared.profile.fmu.step_timeout
        self._ahead = prepared.step_plan.ahead
        self.record = prepared.wiring.record
        self.knows_grades = prepared.wiring.grade is not None
        self._steps, self._force = 0, 0.0
        self._process = FmuProcess(HostedVehicle, prepared)

    def start(self, *, position: float = 0.0, speed: float = 0.0) -> None:
        """Begin (again) at time 0, in a new process.

        Args:
            position: Position [m].
            speed: Speed [m/s].

        Raises:
            FmuPlatformError: the FMU's binary cannot be loaded.
            FmuStartError: the FMU refuses its start values.
            FmuOutputError: an output is not a finite number.
            FmuCrashError: the process died, or did not answer in time.
            FmuStateError: the vehicle has been closed.
        """
        if self._process.closed:
            raise FmuStateError(self._refusal)
        self._refuse("has not started; call start() again")
        self._process.begin()
        self.warnings = self._process.warnings
        self._steps, self.time = 0, 0.0
        self._exchange(LOAD, (), self._start_timeout)
        self._exchange(START, (position, speed), self._start_timeout)
        self._refusal = ""

    def step(self, force: float, grade: float = 0.0) -> None:
        """Hold ``force`` [N] for one step on a ``grade`` [rad], and set the attributes.

        Raises:
            FmuStepError: the force is not a finite number, or the FMU does not do the step.
            FmuCrashError: the process died, or did not answer in time.
            FmuOutputError: an output is not a finite number, or none that a car can have.
            FmuStateError: the vehicle is not running.
        """
        self._require_step(force)
        self._force = force
        self._exchange(STEP, (processor.current(), force, grade), self._step_timeout)
        self._steps += 1
        self.time = self._steps * self.step_size

    def close(self) -> None:
        """End the FMU and its process; a second call does nothing."""
        if self._process.closed:
            return
        try:
            self._process.close()
        finally:
            self._refuse("has been closed; make a new one")

    def _exchange(self, what: bytes, numbers: Sequence[float], timeout: float) -> None:
        """Send a request and take over the results of its reply."""
        process = self._process
        try:
            x, v, a, *recorded = process.ask(what, numbers, timeout, lambda: self._when(what))
            if not isfinite(x + v + a) and not (isfinite(x) and isfinite(v) and isfinite(a)):
                process.failed = True
                msg = f"{self.path}: position {x} m, speed {v} m/s, acceleration {a} m/s2"
                raise FmuOutputError(f"{msg} at {self.time:.10g} s; expected finite numbers")
        except FmuOutputError:
            if process.last:  # the reported state: the rows show where the vehicle was
                self.time = process.last_time
                self.position, self.speed, self.acceleration = process.last[:3]
            self._fail()
            raise
        except BaseException:
            self._fail()
            raise
        self.position, self.speed, self.acceleration = x, v, a
        self.recorded = recorded

    def _when(self, what: bytes) -> str:
        """Return the time of a request in words, for messages."""
        if what != STEP:
            return while_starting(what)
        until = (self._steps + self._ahead) * self.step_size
        return f"in the step from {self.time:.10g} s to {until:.10g} s under {self._force:g} N"
