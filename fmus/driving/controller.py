"""A controller that is an FMU: at each step it receives its inputs and returns its answer."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from fmus.errors import FmuStepError
from fmus.fmi import load
from fmus.fmi.status import STATUS_NAMES, WARNING
from fmus.profile.controllers.controller_preparation import PreparedController


class ControllerFmu:
    """Runs a controller FMU in its process: START nothing; STEP its inputs, in its own units.

    The answer at t_k is the output at the end of the step from t_k, with the inputs at t_k. There
    is no lag, whether the FMU computes its outputs with its inputs or with its step.

    Args:
        prepared: Prepared controller.
        folder: Folder of the unpacked FMU, which is not removed.

    Attributes:
        time: Time at the end of the last step [s].
        warnings: Warnings, which stay empty: the client checks the inputs and warns.

    Raises:
        FmuPlatformError: the FMU has no binary that can be loaded.
    """

    def __init__(self, prepared: PreparedController, folder: Path) -> None:
        self.prepared = prepared
        self.warnings: list[str] = []
        self.time = self._answer = 0.0
        self._steps = 0
        self._instance = load(
            prepared.model,
            prepared.wiring.interface,
            folder,
            prepared.binary,
            prepared.profile.fmu,
            clocks=prepared.clocks,
        )

    @staticmethod
    def numbers(prepared: PreparedController) -> tuple[int, int]:
        """Return the numbers of values in requests and in replies."""
        return 1 + len(prepared.wiring.inputs), 1

    def start(self, _numbers: Sequence[float]) -> None:
        """Begin at time 0 with the start values of the profile.

        Raises:
            FmuStartError: the FMU refuses its start values.
        """
        wiring = self.prepared.wiring
        channels = [wire.channel for wire in wiring.inputs]
        self._instance.start(wiring.start_values, channels, [wiring.answer.channel])

    def step(self, numbers: Sequence[float]) -> None:
        """Do one control step; an FMU with longer steps is called once in each of its own steps.

        Args:
            numbers: Processor of the client, then the values of the inputs in their own units.

        Raises:
            FmuStepError: the FMU does not do the step.
        """
        step_plan, instance = self.prepared.step_plan, self._instance
        steps = range(step_plan.steps_until(self._steps), step_plan.steps_until(self._steps + 1))
        if steps:
            for index, value in enumerate(numbers[1:]):
                instance.inputs[index] = value
            for number in steps:
                status = instance.tick(number * step_plan.step, step_plan.step)
                if status > WARNING:
                    said = instance.messages.take() or "without a message"
                    raise FmuStepError(
                        f"{self.prepared.path}: no step from {number * step_plan.step:.10g} s to "
                        f"{(number + 1) * step_plan.step:.10g} s: the FMU returned "
                        f"'{STATUS_NAMES[status]}', {said}"
                    )
            self._answer = instance.outputs[0]
        self._steps += 1
        self.time = self._steps * self.prepared.step_size

    def state(self) -> Sequence[float]:
        """Return the answer of the last step, in the FMU's own unit."""
        return (self._answer,)

    def close(self) -> None:
        """End the FMU and free its library."""
        self._instance.close()
