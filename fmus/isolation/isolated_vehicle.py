"""A vehicle FMU in a process of its own: whatever the FMU does, this process goes on."""

import os
import tempfile
import weakref
from collections.abc import Mapping
from math import isfinite
from pathlib import Path

from fmus import errors
from fmus.description.model import Value
from fmus.errors import (
    FmuCrashError,
    FmuError,
    FmuOutputError,
    FmuStartCrashError,
    FmuStateError,
    FmuStepError,
)
from fmus.interfaces.vehicle import Vehicle
from fmus.isolation import processor
from fmus.isolation.cleanup import remove
from fmus.isolation.process_host import ProcessHost, make_process_host
from fmus.isolation.wire import LOAD, QUIT, START, STEP, Client, GarbledError, Text
from fmus.profile.preparation import prepare, unpack
from fmus.profile.vehicle_profile import VehicleProfile
from fmus.text import printable

_END_TIMEOUT = 5.0  # [s] for an FMU to end by itself
_END_PATIENCE = 1.0  # [s] between the end of the connection and that of the process


class IsolatedVehicle(Vehicle):
    """Runs a vehicle FMU in a process of its own, as :class:`fmus.VehicleFmu` does in this one.

    An FMU that crashes, hangs or ends its process becomes an :class:`FmuCrashError`; nothing of
    what it does to its process (working directory, locale, floating-point traps, signals, output)
    reaches this one. Every start uses a new process. The binary is loaded at the start, so a
    binary that cannot be loaded is reported there.

    Args:
        path: the .fmu file.
        step_size: [s].
        profile: which variable plays which part, and the time-outs; None as for ``VehicleFmu``.
        start_values: further start values by variable name.

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
        self._stretch = prepared.pace.stretch
        self.record = prepared.wiring.record
        self._steps = 0
        self._client: Client | None = None
        folder = Path(tempfile.mkdtemp(prefix="vehicle-fmu-"))
        try:
            self._host = make_process_host(prepared, folder)
        except BaseException:
            remove(folder)
            raise
        self._owner = os.getpid()
        self._closing = weakref.finalize(self, _close, self._owner, self._host, folder)
        try:
            unpack(prepared, folder / "fmu")
        except BaseException:
            self._closing()
            raise

    def start(self, *, position: float = 0.0, speed: float = 0.0) -> None:
        """Begin (again) at time 0, in a new process.

        Args:
            position: [m].
            speed: [m/s].

        Raises:
            FmuPlatformError: the FMU's binary cannot be loaded.
            FmuStartError: the FMU refuses its start values.
            FmuOutputError: an output is not a finite number.
            FmuCrashError: its process died, or did not answer in time.
            FmuStateError: the vehicle has been closed.
        """
        if not self._closing.alive:
            raise FmuStateError(self._refusal)
        self.warnings = []
        self._end()
        self._refuse("has not started; call start() again")
        self._client = Client(self._host.start_process(), len(self.record))
        self._steps, self.time = 0, 0.0
        self._exchange(LOAD, 0.0, 0.0, self._start_timeout)
        self._exchange(START, position, speed, self._start_timeout)
        self._refusal = ""

    def step(self, force: float) -> None:
        """Hold ``force`` [N] for one step; the results are in the attributes.

        Raises:
            FmuStepError: the force is not a finite number, or the FMU does not do the step.
            FmuCrashError: its process died, or did not answer in time.
            FmuOutputError: an output is not a finite number, or none that a car can have.
            FmuStateError: the vehicle is not running.
        """
        self._require_step(force)
        self._exchange(STEP, force, processor.current(), self._step_timeout)
        self._steps += 1
        self.time = self._steps * self.step_size

    def close(self) -> None:
        """End the FMU and its process; nothing happens the second time."""
        if not self._closing.alive:
            return
        try:
            if os.getpid() == self._owner:  # a fork of this process must not end the FMU
                self._end()
        finally:
            self._refuse("has been closed; make a new one")
            self._closing()

    def _exchange(self, what: bytes, first: float, second: float, timeout: float) -> None:
        """Send a request and take over the results of its reply."""
        assert self._client is not None  # it exists while no call is refused
        try:
            done, x, v, a, text = self._client.ask(what, first, second, timeout)
            if text:
                self.warnings += _warnings(text)
            if not done:
                raise self._reported_error(text, (x, v, a))
            if not isfinite(x + v + a) and not (isfinite(x) and isfinite(v) and isfinite(a)):
                msg = f"{self.path}: position {x} m, speed {v} m/s, acceleration {a} m/s2"
                raise FmuOutputError(f"{msg} at {self.time:.10g} s; expected finite numbers")
        except FmuError:
            self._fail()
            raise
        except (TimeoutError, EOFError, GarbledError) as problem:
            self._fail()
            raise self._crash(what, first, problem, timeout) from None
        except BaseException:  # Ctrl-C: the reply would be taken for that of the next step
            self._fail()
            raise
        self.position, self.speed, self.acceleration = x, v, a
        self.recorded = self._client.recorded

    def _reported_error(self, text: Text, state: tuple[float, float, float]) -> FmuError:
        """The error that the FMU's process reported; only our own error classes are accepted."""
        kind = getattr(errors, str(text.get("error")), None)
        message = printable(text.get("message"), 2000)
        if not (isinstance(kind, type) and issubclass(kind, FmuError)):
            return FmuStepError(f"{self.path}: {message}")
        time = text.get("time")
        if kind is FmuOutputError and isinstance(time, float):
            self.time = time
            self.position, self.speed, self.acceleration = state
        return kind(message)

    def _crash(
        self, what: bytes, force: float, problem: Exception, timeout: float
    ) -> FmuCrashError:
        """End the process; the error says when it ended, why, and what it printed last."""
        lost = isinstance(problem, EOFError)
        report = self._host.end_process(_END_PATIENCE if lost else 0.0)
        when = "while it was loaded" if what == LOAD else "while it was started"
        key = "start_timeout"
        if what == STEP:
            until = (self._steps + self._stretch) * self.step_size
            when = f"in the step from {self.time:.10g} s to {until:.10g} s under {force:g} N"
            key = "step_timeout"
        if lost:
            reason = f"the FMU's process {report.cause} {when}{report.after_printing}"
            advice = "report it to the FMU's maker"
        elif isinstance(problem, TimeoutError):
            reason = f"no answer within {timeout:g} s {when}{report.after_printing}; killed"
            line = f"{key} = {min(10.0 * timeout, 3600.0):g}"
            advice = f"if it is only slow, add `{line}` to [fmu] of the profile"
        else:
            reason = (
                f"the FMU's process wrote into giveway's connection {when}{report.after_printing}"
            )
            advice = "killed; report it to the FMU's maker"
        kind = FmuCrashError if what == STEP else FmuStartCrashError
        return kind(f"{self.path}: {reason}; {advice}")

    def _end(self) -> None:
        """End the process if there is one; ask it to end first unless it has failed."""
        client, self._client = self._client, None
        if client is None:
            return
        try:
            if not self._failed:
                client.ask(QUIT, 0.0, 0.0, _END_TIMEOUT)
        except TimeoutError:
            self.warnings.append(
                f"{self.path.name}: the FMU did not end within {_END_TIMEOUT:g} s; killed"
            )
        except (EOFError, GarbledError):
            cause = self._host.end_process(_END_PATIENCE).cause
            self.warnings.append(f"{self.path.name}: the FMU's process {cause} when it was ended")
        finally:
            client.close()
            self._host.end_process()


def _close(owner: int, host: ProcessHost, folder: Path) -> None:
    if os.getpid() == owner:
        try:
            host.close()
        finally:  # also after a Ctrl-C during the wait
            remove(folder)


def _warnings(text: Text) -> list[str]:
    warnings = text.get("warnings")
    return [printable(w, 1000) for w in warnings] if isinstance(warnings, list) else []
