"""A part of a vehicle: an FMU that gets numbers, does its own steps, and gives numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isnan
from pathlib import Path

from fmus.description.model import Channel, Interface, Value
from fmus.errors import FmuStepError
from fmus.fmi import load
from fmus.fmi.status import STATUS_NAMES, WARNING
from fmus.profile.preparation import PreparedFmu
from fmus.profile.tables import Stepping


@dataclass(frozen=True)
class PartWiring:
    """The variables of a part that are set and read.

    Attributes:
        interface: Interface that runs.
        numbers: Variables whose start values are told at each start.
        inputs: Variables that are set before each step; NaN at the start leaves one as it is.
        outputs: Variables that are read after each step.
        start_values: Start values that never change: texts, truth values and arrays.
    """

    interface: Interface
    numbers: tuple[Channel, ...]
    inputs: tuple[Channel, ...]
    outputs: tuple[Channel, ...]
    start_values: Mapping[Channel, Value]


@dataclass(frozen=True)
class PreparedPart(PreparedFmu):
    """A part that is ready to be unpacked and loaded."""

    wiring: PartWiring
    stepping: Stepping


class PartFmu:
    """Runs a part in its process: START start values; STEP processor, time, step, inputs.

    Args:
        prepared: Prepared part.
        folder: Folder of the unpacked FMU, which is not removed.

    Attributes:
        time: Time at the end of the last step [s].
        warnings: Remarks on the FMU and on its start.

    Raises:
        FmuPlatformError: the FMU has no binary that can be loaded.
    """

    def __init__(self, prepared: PreparedPart, folder: Path) -> None:
        self.prepared = prepared
        self.time = 0.0
        self._instance = load(
            prepared.model,
            prepared.wiring.interface,
            folder,
            prepared.binary,
            prepared.stepping,
            clocks=prepared.clocks,
        )
        self.warnings = self._instance.remarks
        self.warnings += prepared.notes

    @staticmethod
    def numbers(prepared: PreparedPart) -> tuple[int, int]:
        """Return the numbers of values in requests and in replies."""
        wiring = prepared.wiring
        asked = max(3 + len(wiring.inputs), len(wiring.numbers) + len(wiring.inputs))
        return asked, len(wiring.outputs)

    def start(self, numbers: Sequence[float]) -> None:
        """Begin at time 0 with start values: those of ``numbers``, then those of ``inputs``.

        Raises:
            FmuStartError: the FMU refuses its start values.
        """
        wiring = self.prepared.wiring
        values = dict(wiring.start_values)
        for channel, number in zip((*wiring.inputs, *wiring.numbers), numbers, strict=False):
            if not isnan(number):
                values[channel] = round(number) if channel.variable.is_integer else number
        self._instance.start(values, wiring.inputs, wiring.outputs)
        self.time = 0.0

    def step(self, numbers: Sequence[float]) -> None:
        """Do one step of the FMU.

        Raises:
            FmuStepError: the FMU does not do the step.
        """
        instance, (time, step) = self._instance, numbers[1:3]
        for index in range(len(self.prepared.wiring.inputs)):
            instance.inputs[index] = numbers[3 + index]
        status = instance.tick(time, step)
        if status > WARNING:
            said = instance.messages.take() or "without a message"
            raise FmuStepError(
                f"{self.prepared.path}: no step from {time:.10g} s to {time + step:.10g} s: the "
                f"FMU returned '{STATUS_NAMES[status]}', {said}"
            )
        self.time = time + step

    def state(self) -> Sequence[float]:
        """Return the outputs after the last step, in the FMU's own units."""
        return self._instance.outputs.tolist()

    def close(self) -> None:
        """End the FMU and free its library."""
        self._instance.close()
