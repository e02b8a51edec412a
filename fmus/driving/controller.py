"""A controller that is an FMU: at each step it receives its inputs and returns its answer."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from fmus.errors import FmuStepError
from fmus.fmi import load
from fmus.fmi.status import STATUS_NAMES, WARNING
from fmus.profile.controllers.controller_preparation import PreparedController


class ControllerFmu:
    """Runs a controller FMU in this process.

    The answer at t_k is the output at the end of the step from t_k, with the inputs at t_k. There
    is no lag, whether the FMU computes its outputs with its inputs or with its step.

    Args:
        prepared: Prepared controller.
        folder: Folder of the unpacked FMU, which is not removed.

    Attributes:
        answer: Answer of the last step, in the FMU's own unit.
        time: Time at the end of that step [s].

    Raises:
        FmuPlatformError: the FMU has no binary that can be loaded.
    """

    def __init__(self, prepared: PreparedController, folder: Path) -> None:
        self.prepared = prepared
        self.answer = self.time = 0.0
        self._steps = 0
        fmu = prepared.profile.fmu
        self._instance = load(
            prepared.model,
            prepared.wiring.interface,
            folder,
            prepared.binary,
            solver=fmu.solver,
            tolerance=fmu.tolerance,
            stop_time=fmu.stop_time,
        )

    def start(self) -> None:
        """Begin (again) at time 0 with a new instance.

        Raises:
            FmuStartError: the FMU refuses its start values.
        """
        wiring = self.prepared.wiring
        self._instance.stop()
        self._steps, self.time = 0, 0.0
        channels = [wire.channel for wire in wiring.inputs]
        self._instance.start(wiring.start_values, channels, [wiring.answer.channel])

    def step(self, told: Sequence[float]) -> None:
        """Do one control step; an FMU with longer steps is called once in each of its own steps.

        Args:
            told: Values of its inputs, in its own units.

        Raises:
            FmuStepError: the FMU does not do the step.
        """
        step_plan, instance = self.prepared.step_plan, self._instance
        if self._steps % step_plan.stretch == 0:
            for index, value in enumerate(told):
                instance.inputs[index] = value
            first = self._steps // step_plan.stretch * step_plan.substeps
            for number in range(first, first + step_plan.substeps):
                status = instance.tick(number * step_plan.step, step_plan.step)
                if status > WARNING:
                    said = instance.messages.take() or "without a message"
                    raise FmuStepError(
                        f"{self.prepared.path}: no step from {number * step_plan.step:.10g} s to "
                        f"{(number + 1) * step_plan.step:.10g} s: the FMU returned "
                        f"'{STATUS_NAMES[status]}', {said}"
                    )
            self.answer = instance.outputs[0]
        self._steps += 1
        self.time = self._steps * self.prepared.step_size

    def close(self) -> None:
        """End the FMU and free its library."""
        self._instance.close()
