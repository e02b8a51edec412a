"""A vehicle whose longitudinal motion is an FMU, with a force as its input."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from math import isclose, isfinite
from pathlib import Path
from typing import Final, NoReturn, Protocol, Self

from fmus.archive.own_folder import OwnFolder
from fmus.archive.place import unpacking_place
from fmus.description.model import Channel, Value
from fmus.driving.kept_folder import kept
from fmus.driving.motion import Motion
from fmus.driving.starting import reach, require_position, start_values
from fmus.errors import FmuOutputError, FmuStartError, FmuStateError, FmuStepError
from fmus.fmi import load
from fmus.fmi.messages import MessageLog
from fmus.fmi.status import STATUS_NAMES, WARNING
from fmus.interfaces.vehicle import Drivable
from fmus.profile.preparation import Prepared, prepare, unpack
from fmus.profile.step_plan import between
from fmus.profile.vehicle_profile import VehicleProfile

_PREFIX: Final = "giveway-fmu-"


class Runner(Protocol):
    """An instance of an FMU, or several that are one vehicle; see :class:`fmus.fmi.Instance`."""

    inputs: memoryview[float]
    outputs: memoryview[float]
    remarks: list[str]

    @property
    def tick(self) -> Callable[[float, float], int]:
        """Function that does one step."""

    @property
    def messages(self) -> MessageLog:
        """Last messages of the FMU."""

    def start(
        self,
        values: Mapping[Channel, Value],
        inputs: Sequence[Channel],
        outputs: Sequence[Channel],
    ) -> None:
        """Start it with these start values."""

    def stop(self) -> None:
        """End it, until the next start."""

    def close(self) -> None:
        """Free everything."""


class VehicleFmu(Drivable):
    """Runs a vehicle FMU in this process, in steps of fixed size.

    Its position, speed, acceleration and time are those of :class:`Vehicle`.

    Args:
        path: Path of the .fmu file.
        step_size: Step size of the controller [s].
        profile: Roles of the FMU's variables. With None it is the shipped FMUs' own, or a draft
            from names and units if it leaves no doubt.
        start_values: Further start values by variable name, set at every :meth:`start`.

    Raises:
        FmuFileError: the file is missing, or no readable FMU.
        FmuInterfaceError: it has no interface that can be run here.
        FmuPlatformError: it has no binary for this platform, or none that can be loaded.
        FmuVariableError: a variable is missing, or is not what it is used for.
        FmuProfileError: the profile does not fit, or there is none where one is needed.
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
        with ExitStack() as stack:  # if a later part fails, the earlier ones are undone
            self._set_up(prepared, self._place(prepared, stack), stack)

    @classmethod
    def unpacked(cls, prepared: Prepared, folder: Path) -> Self:
        """Return the vehicle of an FMU that is unpacked in ``folder``, which is not removed."""
        vehicle = cls.__new__(cls)
        with ExitStack() as stack:
            vehicle._set_up(prepared, folder, stack)
        return vehicle

    def _set_up(self, prepared: Prepared, folder: Path, stack: ExitStack) -> None:
        super().__init__(prepared.path)
        self.prepared = prepared
        self.record = prepared.wiring.record
        self.step_size = prepared.step_size
        self._step_plan = prepared.step_plan
        self._command = prepared.command
        self._grade = prepared.wiring.grade
        self.knows_grades = self._grade is not None
        self._motion = Motion(prepared)
        self.warnings = self._motion.warnings
        self._ends = ((0.0, 0.0), (0.0, 0.0))  # position, speed at both ends of the last FMU step
        self._steps = self._earlier = 0  # since time 0, and during the run-up before it
        self._closed = False
        self._instance = self._load(prepared, folder)
        stack.callback(self._instance.close)
        self._resources = stack.pop_all()

    def _place(self, prepared: Prepared, stack: ExitStack) -> Path:
        """Return the folder in which the FMU is unpacked."""
        folder = kept(prepared)
        if folder is None:
            folder = Path(stack.enter_context(OwnFolder(_PREFIX, unpacking_place())))
            unpack(prepared, folder)
        return folder

    def _load(self, prepared: Prepared, folder: Path) -> Runner:
        """Return what runs the FMU that is unpacked in a folder."""
        return load(
            prepared.model,
            prepared.wiring.interface,
            folder,
            prepared.binary,
            prepared.profile.fmu,
            rewinds=not prepared.ours,  # keeping the state takes time in every step
            clocks=prepared.clocks,
        )

    # --- start ---------------------------------------------------------------------------------

    def start(self, *, position: float = 0.0, speed: float = 0.0) -> None:
        """Begin (again) at time 0 with a new instance of the FMU.

        Args:
            position: Position [m].
            speed: Speed [m/s]; an FMU without a parameter for it is driven up to it before time 0.

        Raises:
            FmuStartError: the FMU refuses its start values, or does not start at this speed.
            FmuOutputError: an output is not a number that a car can have.
            FmuStateError: the vehicle has been closed.
        """
        if self._closed:
            raise FmuStateError(self._refusal)
        for quantity, value in (("position", position), ("speed", speed)):
            if not isfinite(value):
                raise FmuStartError(
                    f"{self.path}: start at a {quantity} of {value}; expected a finite number"
                )
        self._instance.stop()
        self._refuse("has not started; call start() again")
        self._steps = self._earlier = 0
        self.time = 0.0
        wiring = self.prepared.wiring
        self._instance.start(
            start_values(self.prepared, position, speed),
            [wire.channel for wire in wiring.inputs],
            wiring.read,
        )
        self._inputs = self._instance.inputs
        self._outputs = self._instance.outputs
        # a view, which always has the last step's values
        self.recorded = self._outputs[len(wiring.outputs) :]
        self._tick = self._instance.tick
        self._motion = motion = Motion(self.prepared)
        self.warnings = motion.warnings
        self.warnings += [f"{self.path.name}: {remark}" for remark in self._instance.remarks]
        motion.begin(self._outputs)
        self._refusal = ""
        self._show(motion)
        self._ends = ((0.0, 0.0), (self.position, self.speed))
        try:
            self._reach(position, speed)
        except BaseException:
            self._fail()
            raise

    def _reach(self, position: float, speed: float) -> None:
        """Check the first position and speed, or drive up to the speed before time 0."""
        duration = reach(self, speed)
        if duration is not None:
            self._earlier, self._steps = self._steps, 0
            self.time = 0.0
            self.warnings.append(
                f"{self.path.name}: no parameter for the initial speed: driven up to "
                f"{self.speed:.3g} m/s in {duration:.3g} s before the start"
            )
        wiring = self.prepared.wiring
        if wiring.initial_position is None or wiring.output("position") is None or self._earlier:
            motion, ((begin, v_0), (_, v_1)) = self._motion, self._ends
            ahead = motion.position - self.position
            self._ends = ((position + begin - self.position, v_0), (position + ahead, v_1))
            motion.count_from(position + ahead)
            self.position = position
        else:
            require_position(self, position)

    @property
    def between_steps(self) -> bool:
        """True if an FMU step has ended within the last control step."""
        return self._step_plan.has_ended(self._earlier + self._steps)

    # --- steps ---------------------------------------------------------------------------------

    def step(self, force: float, grade: float = 0.0) -> None:
        """Hold ``force`` [N] for one step on a ``grade`` [rad], and set the attributes.

        Raises:
            FmuStepError: the force is not a finite number, or the FMU does not do the step.
            FmuOutputError: an output is not a number that a car can have.
            FmuStateError: the vehicle is not running.
        """
        if self._refusal or not isfinite(force):
            self._require_step(force)
        motion, done, step_plan = self._motion, self._earlier + self._steps, self._step_plan
        if step_plan.stretch == 1:
            first = done * step_plan.substeps
            self._drive(force, grade, range(first, first + step_plan.substeps))
            self.position, self.speed = motion.position, motion.speed
        else:
            steps = range(step_plan.steps_until(done), step_plan.steps_until(done + 1))
            if steps:
                self._drive(force, grade, steps)
            share = step_plan.share(done + 1)
            self.position, self.speed = between(*self._ends, step_plan.step, share)
        self._steps += 1
        self.time = self._steps * self.step_size
        self.acceleration = motion.acceleration

    def _drive(self, force: float, grade: float, steps: range) -> None:
        """Do the FMU's steps that begin within one control step."""
        step_plan, motion, tick = self._step_plan, self._motion, self._tick
        self._command.apply(force, motion.speed, self._inputs)
        if self._grade is not None:
            self._inputs[self._grade] = self.prepared.wiring.grade_to_raw(grade)
        if self.prepared.bounds:
            motion.keep_bounds(self._inputs)
        h, each = step_plan.step, step_plan.stretch > 1
        for number in steps:
            status = tick(number * h, h)
            if status > WARNING:
                self._step_failed(force, status)
            if each:
                self._follow(force, h)
                self._ends = (self._ends[1], (motion.position, motion.speed))
        if not each:
            self._follow(force, len(steps) * h)

    def _follow(self, force: float, duration: float) -> None:
        """Take over the motion after a step of some duration [s]."""
        end = (self._steps + self._step_plan.ahead) * self.step_size
        try:
            self._motion.follow(self._outputs, force, duration, end)
        except FmuOutputError:
            self.time = end
            self._show(self._motion)
            self._fail()
            raise

    def _show(self, motion: Motion) -> None:
        self.position, self.speed, self.acceleration = motion.state

    # --- end -----------------------------------------------------------------------------------

    def close(self) -> None:
        """Free everything, including the temporary folder; a second call does nothing."""
        if not self._closed:
            self._closed = True
            self._refuse("has been closed; make a new one")
            self._instance.stop()
            self._resources.close()

    def _own_step(self) -> str:
        """Return advice for an FMU with steps of one length only, as the end of a message."""
        wanted, interface = self.prepared.model.default_step, self.prepared.wiring.interface
        if interface.variable_step or wanted is None or isclose(wanted, self._step_plan.step):
            return ""
        return (
            "; it does steps of one length only, and its default experiment's is "
            f"{wanted:g} s: add step = {wanted:g} to [fmu]"
        )

    def _step_failed(self, force: float, status: int) -> NoReturn:
        self._fail()
        said = self._instance.messages.take() or "without a message"
        end = (self._steps + self._step_plan.ahead) * self.step_size
        raise FmuStepError(
            f"{self.path}: no step from {self.time:.10g} s to {end:.10g} s under {force:g} N: the "
            f"FMU returned '{STATUS_NAMES[status]}', {said}{self._own_step()}"
        )
