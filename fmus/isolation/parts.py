"""A vehicle of several FMUs, each in a process of its own and with steps of its own.

A part's step begins with what the others had put out by then: each output is held until the part
that gives it has done its next step. At the control instants the outputs of a part that is already
past them are interpolated.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import nan
from typing import NoReturn, TypeGuard

from fmus.description.binaries import binary_of
from fmus.description.channels import find_channel
from fmus.description.model import Channel, Link, Model, System, Value
from fmus.description.reading import read_model
from fmus.description.systems import unpacked_parts
from fmus.driving.part import PartFmu, PartWiring, PreparedPart
from fmus.errors import FmuError, FmuStartError
from fmus.fmi.messages import MessageLog
from fmus.isolation import processor
from fmus.isolation.fmu_process import FmuProcess, while_starting
from fmus.isolation.wire import LOAD, START, STEP
from fmus.profile.clocks import tickings_of
from fmus.profile.preparation import Prepared
from fmus.profile.wires import interface_of

_AT_ONCE = 1e-9  # relative tolerance of two times that are the same


class Parts:
    """The parts of a vehicle, with the interface of one FMU's instance.

    Args:
        prepared: Prepared vehicle of several FMUs.

    Attributes:
        inputs: One number for each input of the vehicle.
        outputs: One number for each output, at the end of the last tick.
        warnings: Warnings of the parts.
    """

    def __init__(self, prepared: Prepared) -> None:
        system = prepared.model.system
        assert system is not None  # the vehicle is made of several FMUs
        self._path, self._system = prepared.path, system
        self._prepared = prepared
        self.inputs = self.outputs = memoryview(bytearray()).cast("d")
        self.messages = MessageLog()  # stays empty: a part that fails raises its error itself
        self.warnings: list[str] = []
        self.remarks: list[str] = []  # stays empty: the parts' processes report theirs
        self._parts: dict[str, _Part] = {}
        self._told: list[tuple[int, _Part, int, Link]] = []
        self._read: list[tuple[_Part, int, Link]] = []

    def start(
        self,
        values: Mapping[Channel, Value],
        inputs: Sequence[Channel],
        outputs: Sequence[Channel],
    ) -> None:
        """Start all parts at time 0, each with what the others put out then.

        Raises:
            FmuError: a part does not start, or the outputs at the start do not settle.
        """
        self.stop()
        self.warnings = []
        given = _Given(self._system, values)
        if not self._parts:
            self._wire(given, inputs, outputs)
        parts = self._parts.values()
        for part in parts:
            part.start(given.numbers(part.name), [nan] * len(part.inputs))
        for _ in range(len(self._parts) + 1):
            late = [part for part in parts if part.awaits() != part.began_with]
            if not late:
                break
            for part in late:
                part.start(given.numbers(part.name), part.awaits())
        else:
            raise FmuStartError(
                f"{self._path}: the outputs at the start do not settle: those of "
                f"{', '.join(part.name for part in late)} change those of the others; is there an "
                "algebraic loop?"
            )
        self.inputs = memoryview(bytearray(8 * len(inputs))).cast("d")
        self.outputs = memoryview(bytearray(8 * len(outputs))).cast("d")
        for index, channel in enumerate(inputs):
            number = values.get(channel)
            if isinstance(number, int | float):
                self.inputs[index] = number
        self._answer(0, None)

    def tick(self, time: float, step: float) -> int:
        """Let every part do the steps that begin before ``time + step``.

        Raises:
            FmuError: a part fails; the message names it.
        """
        number = round(time / step)
        due = sorted(
            (count * part.plan.step, index, count, part)
            for index, part in enumerate(self._parts.values())
            for count in range(part.plan.steps_until(number), part.plan.steps_until(number + 1))
        )
        for begin, _, count, part in due:
            for index, target, slot, link in self._told:
                if target is part:
                    part.given[slot] = link.gain * self.inputs[index] + link.shift
            part.step(count, begin, step)
        self._answer(number + 1, step)
        return 0

    def stop(self) -> None:
        """End the parts' processes."""
        for part in self._parts.values():
            part.process.end()

    def close(self) -> None:
        """End the parts' processes, and remove their folders."""
        for part in self._parts.values():
            part.process.close()

    def _answer(self, instant: int, step: float | None) -> None:
        for index, (part, slot, link) in enumerate(self._read):
            value = part.at(slot, 1.0 if step is None else part.plan.share(instant))
            self.outputs[index] = link.gain * value + link.shift
        for part in self._parts.values():
            if part.process.warnings:
                self.warnings += part.process.warnings
                part.process.warnings.clear()

    # ---- wiring ----

    def _wire(self, given: _Given, inputs: Sequence[Channel], outputs: Sequence[Channel]) -> None:
        """Make the parts, and connect them with each other and with the vehicle."""
        told = [self._system.inputs.get(c.name) or (Link(c.name, c.name),) for c in inputs]
        read = [self._system.outputs.get(c.name) or Link(c.name, c.name) for c in outputs]
        set_ = [link.target for link in self._system.links]
        set_ += [link.target for links in told for link in links]
        got = [link.source for link in (*self._system.links, *read)]
        with unpacked_parts(self._prepared.model) as models:
            for name, model in models.items():
                self._parts[name] = _Part(
                    name, self._prepared, model, given, self._of(name, set_), self._of(name, got)
                )
        for link in self._system.links:
            source, target = self._place(link.source), self._place(link.target)
            target[0].links.append((target[0].inputs.index(target[1]), *source, link))
        for index, links in enumerate(told):
            for link in links:
                part, variable = self._place(link.target)
                self._told.append((index, part, part.inputs.index(variable), link))
        for link in read:
            part, variable = self._place(link.source)
            self._read.append((part, part.outputs.index(variable), link))

    def _of(self, part: str, names: Iterable[str]) -> list[str]:
        places = (self._system.part_of(name) for name in names)
        return list(dict.fromkeys(place[1] for place in places if place and place[0] == part))

    def _place(self, name: str) -> tuple[_Part, str]:
        place = self._system.part_of(name)
        assert place is not None  # the wiring names variables of parts only
        return self._parts[place[0]], place[1]


class _Given:
    """The start values of a vehicle, by part.

    Args:
        system: System of several FMUs.
        values: Start values by the vehicle's channels.
    """

    def __init__(self, system: System, values: Mapping[Channel, Value]) -> None:
        self.plain: dict[str, dict[str, Value]] = {name: {} for name in system.parts}
        for channel, value in values.items():
            links = system.inputs.get(channel.name) or (Link(channel.name, channel.name),)
            for link in links:
                place = system.part_of(link.target)
                assert place is not None  # start values are those of parts
                told = link.gain * value + link.shift if _is_number(value) else value
                self.plain[place[0]][place[1]] = told

    def numbers(self, part: str) -> list[float]:
        """Return the start values of a part that are numbers."""
        return [float(value) for value in self.plain[part].values() if _is_number(value)]


def _is_number(value: Value) -> TypeGuard[float]:
    return isinstance(value, int | float) and not isinstance(value, bool)


class _Part:
    """One part, its process, and its outputs at both ends of its last step."""

    def __init__(
        self,
        name: str,
        prepared: Prepared,
        model: Model,
        given: _Given,
        inputs: list[str],
        outputs: list[str],
    ) -> None:
        self.name, self.inputs, self.outputs = name, inputs, outputs
        self.path = prepared.path
        self.plan = prepared.part_steps(name)
        self.stepping = prepared.part_stepping(name)
        self.links: list[tuple[int, _Part, str, Link]] = []
        self.given = [0.0] * len(inputs)
        self.began_with: list[float] = []
        self._before: Sequence[float] = ()
        self._after: Sequence[float] = ()
        self._ended = 0.0  # [s] end of the last step

        def channel(variable: str) -> Channel:
            return find_channel(model, f"part '{name}':", variable)

        values = given.plain[name]
        model = read_model(model.path, values)  # a structural parameter sizes arrays
        interface = interface_of(model, self.stepping.kind)
        wiring = PartWiring(
            interface=interface,
            numbers=tuple(channel(v) for v, value in values.items() if _is_number(value)),
            inputs=tuple(channel(v) for v in inputs),
            outputs=tuple(channel(v) for v in outputs),
            start_values={channel(v): x for v, x in values.items() if not _is_number(x)},
        )
        self._settable = [c.variable.settable and c.variable.is_real for c in wiring.inputs]
        clocks, remarks = tickings_of(model, interface, self.stepping, self.plan.step)
        part = PreparedPart(
            model, self.plan, (), prepared.step_size, binary_of(model, interface), tuple(remarks),
            clocks, wiring, self.stepping,
        )  # fmt: skip
        self.process = FmuProcess(PartFmu, part)

    def start(self, numbers: Sequence[float], inputs: list[float]) -> None:
        """Start the FMU in a new process; NaN leaves an input as it is."""
        self.began_with = inputs
        self.process.begin()
        self._ask(LOAD, (), while_starting(LOAD))
        first = self._ask(START, (*inputs, *numbers), while_starting(START))
        self._before = self._after = first
        self._ended = 0.0

    def awaits(self) -> list[float]:
        """Return the inputs at the start that the other parts give; NaN for any other."""
        found = [nan] * len(self.inputs)
        for slot, part, output, link in self.links:
            if self._settable[slot]:
                found[slot] = link.gain * part._after[part.outputs.index(output)] + link.shift
        return found

    def step(self, count: int, begin: float, step: float) -> None:
        """Do the step ``count`` of the FMU, with what the others had put out at its beginning."""
        for slot, part, output, link in self.links:
            held = part.held(part.outputs.index(output), begin, step)
            self.given[slot] = link.gain * held + link.shift
        size = self.plan.step
        end = (count + 1) * size
        when = f"in the step from {begin:.10g} s to {end:.10g} s"
        numbers = (float(processor.current()), begin, size, *self.given)
        self._before, self._after = self._after, self._ask(STEP, numbers, when)
        self._ended = end

    def held(self, slot: int, time: float, step: float) -> float:
        """Return the output of the last step that had ended at a time [s]."""
        return (self._after if self._ended <= time + _AT_ONCE * step else self._before)[slot]

    def at(self, slot: int, share: float) -> float:
        """Return an output when a share of the last step has passed."""
        before, after = self._before[slot], self._after[slot]
        return after if share == 1.0 else before + share * (after - before)

    def _ask(self, what: bytes, numbers: Sequence[float], when: str) -> Sequence[float]:
        timeout = self.stepping.step_timeout if what == STEP else self.stepping.start_timeout
        try:
            return self.process.ask(what, numbers, timeout, lambda: when)
        except FmuError as error:
            self._named(error)

    def _named(self, error: FmuError) -> NoReturn:
        reason = str(error).removeprefix(f"{self.process.path}: ")
        raise type(error)(f"{self.path}: part '{self.name}': {reason}") from None
