"""A vehicle whose longitudinal motion is an FMU: a force in; position, speed, acceleration out."""

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path
from types import TracebackType
from typing import Any, NoReturn, Self

from fmus import fmi
from fmus.errors import (
    FmuOutputError,
    FmuStartError,
    FmuStateError,
    FmuStepError,
    FmuVariableError,
)
from fmus.instance import STATUS_NAMES, WARNING, Tick
from fmus.model import Variable


@dataclass(frozen=True)
class VehicleVariables:
    """The names that an FMU gives to what a vehicle needs; the defaults are the shipped FMUs'."""

    force: str = "force"  # [N] input
    position: str = "position"  # [m] output
    speed: str = "speed"  # [m/s] output
    acceleration: str = "acceleration"  # [m/s2] output
    initial_position: str | None = "s0"  # [m] parameter; None: the FMU starts where it starts
    initial_speed: str | None = "v0"  # [m/s] parameter; None likewise

    @property
    def outputs(self) -> tuple[str, str, str]:
        """Position, speed, acceleration."""
        return self.position, self.speed, self.acceleration


@dataclass(frozen=True, eq=False)
class SavedState:
    """A state of a vehicle to return to."""

    step: int
    handle: Any = field(repr=False)


class VehicleFmu:
    """Runs a vehicle FMU (FMI 2.0 or 3.0, Co-Simulation) in steps of fixed size.

    ``position`` [m], ``speed`` [m/s], ``acceleration`` [m/s2] and ``time`` [s] are plain floats, as
    of the last step. The time after k steps is k times the step size, never a running sum.

    Args:
        path: the .fmu file.
        step_size: [s].
        variables: what the FMU calls its force, position, speed and acceleration.
        start_values: further start values by variable name, set at every :meth:`start`.

    Raises:
        FmuFileError: the file is missing, or no readable FMU.
        FmuInterfaceError: it is not for Co-Simulation with FMI 2.0 or 3.0.
        FmuPlatformError: it has no binary for this platform, or none that can be loaded.
        FmuVariableError: a variable is missing, or is not what it is used for.
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        *,
        step_size: float,
        variables: VehicleVariables | None = None,
        start_values: Mapping[str, float | bool] | None = None,
    ) -> None:
        self.path = Path(path)
        self.variables = VehicleVariables() if variables is None else variables
        self.position = self.speed = self.acceleration = self.time = 0.0
        if not (isfinite(step_size) and step_size > 0.0):
            msg = f"{self.path}: step size {step_size:g} s; expected a number above 0"
            raise FmuVariableError(msg)
        self._step_size = step_size
        self._steps = 0
        self._model = model = fmi.read_model(self.path)
        self._force = model.role(self.variables.force, "input").reference
        outputs = [model.role(name, "output").reference for name in self.variables.outputs]
        self._output_references = outputs
        self._start_values = {
            model.settable(name, value): value for name, value in (start_values or {}).items()
        }
        self._initial = {
            "position": self._initial_variable(self.variables.initial_position),
            "speed": self._initial_variable(self.variables.initial_speed),
        }
        self._saved: set[SavedState] = set()
        self._tick: Tick
        self._closed = False
        self._refuse("has not been started; call start() first")
        self._instance = fmi.load(model)
        self._outputs = self._instance.outputs

    @property
    def step_size(self) -> float:
        """[s]."""
        return self._step_size

    def start(self, *, position: float = 0.0, speed: float = 0.0) -> None:
        """Begin (again) at time 0 with a new instance of the FMU.

        Args:
            position: [m].
            speed: [m/s].

        Raises:
            FmuStartError: the FMU refuses its start values.
            FmuOutputError: an output is not a finite number.
            FmuStateError: the vehicle has been closed.
        """
        if self._closed:
            raise FmuStateError(self._refusal)
        values = dict(self._start_values)
        values |= self._initial_value("position", position)
        values |= self._initial_value("speed", speed)
        self._stop()
        self._refuse("has not started; call start() again")
        self._instance.start(values)
        self._run_from(0)

    def step(self, force: float) -> None:
        """Hold ``force`` [N] for one step; the results are in the attributes.

        Raises:
            FmuStepError: the force is not a finite number, or the FMU does not do the step.
            FmuOutputError: an output is not a finite number.
            FmuStateError: the vehicle is not running.
        """
        if not isfinite(force):
            msg = f"{self.path}: force {force} N at {self.time:g} s; expected a finite number"
            raise FmuStepError(msg)
        status = self._tick(force, self.time)
        if status > WARNING:
            self._step_failed(force, status)
        self._steps += 1
        self.time = self._steps * self._step_size
        self.position, self.speed, self.acceleration = self._outputs
        if not isfinite(self.position + self.speed + self.acceleration):
            self._require_finite()

    def save_state(self) -> SavedState:
        """The complete state of the FMU now, to return to with :meth:`restore_state`.

        Raises:
            FmuStateError: the vehicle is not running, or the FMU cannot save its state.
        """
        if self._refusal:
            raise FmuStateError(self._refusal)
        if not self._model.saves_state:
            msg = f"{self.path}: the FMU cannot save its state; expected canGetAndSetFMUstate"
            raise FmuStateError(msg)
        state = SavedState(self._steps, self._instance.save())
        self._saved.add(state)
        return state

    def restore_state(self, state: SavedState) -> None:
        """Return to a saved state; also after a step that failed.

        Raises:
            FmuStateError: the state is another vehicle's, or has been freed.
        """
        self._require_saved(state)
        self._instance.restore(state.handle)
        self._run_from(state.step)

    def free_state(self, state: SavedState) -> None:
        """Free a saved state; :meth:`start` and :meth:`close` free those that are left.

        Raises:
            FmuStateError: the state is another vehicle's, or has been freed.
        """
        self._require_saved(state)
        self._saved.remove(state)
        self._instance.free_state(state.handle)

    def close(self) -> None:
        """Free everything, also the temporary folder; nothing happens the second time."""
        if not self._closed:
            self._closed = True
            self._refuse("has been closed; make a new one")
            self._stop()
            self._instance.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def _run_from(self, step: int) -> None:
        """Go on from the FMU's present state, which is that after ``step`` steps."""
        self._steps = step
        self.time = step * self._step_size
        self._tick = self._instance.link(self._force, self._output_references, self._step_size)
        self._refusal = ""
        self.position, self.speed, self.acceleration = self._outputs
        self._require_finite()

    def _stop(self) -> None:
        for state in self._saved:
            self._instance.free_state(state.handle)
        self._saved.clear()
        self._instance.stop()

    def _refuse(self, reason: str) -> None:
        """Let every further step raise, so that those that run need no test for it."""
        message = self._refusal = f"{self.path}: the vehicle {reason}"

        def refuse(_force: float, _time: float) -> int:
            raise FmuStateError(message)

        self._tick = refuse

    def _fail(self) -> None:
        self._refuse(f"failed at {self.time:g} s; start it again or restore a saved state")

    def _step_failed(self, force: float, status: int) -> NoReturn:
        self._fail()
        said = self._instance.journal.take() or "without a message"
        msg = (
            f"{self.path}: no step from {self.time:g} s to {self.time + self._step_size:g} s under "
            f"{force:g} N: the FMU returned '{STATUS_NAMES[status]}', {said}"
        )
        raise FmuStepError(msg)

    def _require_finite(self) -> None:
        for name, value in zip(self.variables.outputs, self._outputs, strict=True):
            if not isfinite(value):
                self._fail()
                msg = (
                    f"{self.path}: {name} = {value} at {self.time:g} s; expected a finite number; "
                    "check the FMU's parameters and the step size"
                )
                raise FmuOutputError(msg)

    def _require_saved(self, state: SavedState) -> None:
        if state not in self._saved:
            msg = (
                f"{self.path}: the saved state of step {state.step} is not this vehicle's or has "
                "been freed (start() frees all); save a new one"
            )
            raise FmuStateError(msg)

    def _initial_variable(self, name: str | None) -> Variable | None:
        return None if name is None else self._model.settable(name, 0.0)

    def _initial_value(self, quantity: str, value: float) -> dict[Variable, float | bool]:
        variable = self._initial[quantity]
        if variable is not None:
            self._model.settable(variable.name, value)  # the value, too, must be fit for it
            return {variable: value}
        if value == 0.0:
            return {}
        msg = (
            f"{self.path}: cannot start at a {quantity} of {value:g}: name the FMU's parameter in "
            f"VehicleVariables(initial_{quantity}=...), or start at 0"
        )
        raise FmuStartError(msg)
