"""The preparation of a vehicle: reading its FMU, choosing a profile, and checking both.

Faults of a file or a profile are reported here, before native code is loaded. The result can be
handed to another process.
"""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf, isfinite, isnan
from pathlib import Path

from fmus.archive.archive_check import extract, open_archive
from fmus.archive.place import place_note
from fmus.description.binaries import binary_of, is_library, is_platform, name_note
from fmus.description.model import Interface, Model, Value
from fmus.description.reading import read_model
from fmus.description.systems import unpacked_parts
from fmus.errors import FmuError, FmuProfileError, FmuVariableError
from fmus.profile.bundled import BUNDLED_PROFILE, is_bundled
from fmus.profile.clocks import Ticking, tickings_of
from fmus.profile.commands import Command, make_command
from fmus.profile.draft_profile import draft_profile, require_confident
from fmus.profile.step_plan import StepPlan, step_plan_of
from fmus.profile.tables import Stepping
from fmus.profile.vehicle_profile import FittedModel, VehicleProfile
from fmus.profile.wires import Wire, interface_of
from fmus.profile.wiring import Wiring, wire
from fmus.text import listed


@dataclass(frozen=True)
class Bound:
    """The range that an FMU declares for an input, in the FMU's unit."""

    index: int  # index of the input
    low: float
    high: float


@dataclass(frozen=True)
class PreparedFmu:
    """An FMU that is ready to be unpacked and loaded.

    Attributes:
        model: Model of the FMU.
        step_plan: Relation of the control steps to the FMU's steps.
        bounds: Bounds of the inputs.
        step_size: Step size of the controller [s].
        binary: Library for this platform, by its name in the archive.
        notes: Remarks on the FMU for the user.
        clocks: Input clocks that tick.
    """

    model: Model
    step_plan: StepPlan
    bounds: tuple[Bound, ...]
    step_size: float
    binary: str
    notes: tuple[str, ...]
    clocks: tuple[Ticking, ...]

    @property
    def path(self) -> Path:
        """Path of the FMU."""
        return self.model.path


@dataclass(frozen=True)
class Prepared(PreparedFmu):
    """A vehicle that is ready to be unpacked and loaded.

    Attributes:
        profile: Profile by which it is driven.
        wiring: Variables for its inputs and outputs.
        command: Inverse map.
        ours: True for a shipped FMU, whose outputs are trusted and whose state need not be saved.
    """

    profile: VehicleProfile
    wiring: Wiring
    command: Command
    ours: bool

    @property
    def fitted(self) -> FittedModel | None:
        """Fitted model of the profile, with the longest wait for the FMU's steps in its dead times.

        The dead times of the fit have the mean wait in them, half of the longest one then.
        """
        model, fmu = self.profile.model, self.profile.fmu
        if model is None:
            return None
        interface, default = self.wiring.interface, self.model.default_step
        then = step_plan_of(self.path, fmu.step, interface, default, model.time_step)
        return model.later(self.delay - 0.5 * replace(self, step_plan=then).delay)

    @property
    def delay(self) -> float:
        """Longest time [s] by which forces wait for steps, in all parts together."""
        system = self.model.system
        parts = () if system is None else map(self.part_steps, system.parts)
        return self.step_plan.delay + sum(plan.delay for plan in parts)

    def part_stepping(self, name: str) -> Stepping:
        """Return the settings of a part; those that the profile leaves open are the vehicle's."""
        own = self.profile.parts.get(name, Stepping())
        vehicle = self.profile.fmu
        given = own.model_dump(exclude_unset=True)
        usual = {"start_timeout": vehicle.start_timeout, "step_timeout": vehicle.step_timeout}
        return Stepping(**(usual | given))

    def part_steps(self, name: str) -> StepPlan:
        """Return the relation of a part's steps to those of the vehicle."""
        assert self.model.system is not None  # it has parts
        model, own = self.model.system.parts[name], self.part_stepping(name)
        interface = interface_of(model, own.kind)
        return step_plan_of(self.path, own.step, interface, model.default_step, self.step_plan.step)


def prepare(
    path: str | os.PathLike[str],
    *,
    step_size: float,
    profile: VehicleProfile | None = None,
    start_values: Mapping[str, Value] | None = None,
) -> Prepared:
    """Check and read an FMU, and fit a profile to it.

    Args:
        path: Path of the .fmu file.
        step_size: Step size of the controller [s].
        profile: Roles of the FMU's variables. With None it is the shipped FMUs' own, or a draft
            from names and units if it leaves no doubt.
        start_values: Further start values by variable name.

    Raises:
        FmuFileError: the file is missing, or no readable FMU.
        FmuInterfaceError: it has no interface that can be run here.
        FmuPlatformError: it has no binary for this platform.
        FmuVariableError: a variable is missing, or is not what it is used for.
        FmuProfileError: the profile does not fit, or there is none where one is needed.
    """
    path = Path(path)
    if not (isfinite(step_size) and step_size > 0.0):
        raise FmuVariableError(f"{path}: step size {step_size:g} s; expected a number above 0")
    model = read_model(path)
    profile = _chosen(model, profile)
    model = read_model(path, {**profile.parameters, **(start_values or {})})
    wiring = wire(model, profile, start_values)
    _require_parts(model, profile, wiring)
    if model.system is not None:  # each part has a binary of its own
        binary, notes = "", model.system.doubts
    else:
        binary = binary_of(model, wiring.interface)
        notes = notes_on(wiring.interface, binary)
    plan = step_plan_of(path, profile.fmu.step, wiring.interface, model.default_step, step_size)
    clocks, remarks = tickings_of(model, wiring.interface, profile.fmu, plan.step)
    return Prepared(
        model=model,
        profile=profile,
        wiring=wiring,
        command=make_command(profile, wiring.inputs, step_size),
        step_plan=plan,
        bounds=bounds_of(wiring.inputs),
        step_size=step_size,
        binary=binary,
        notes=(*notes, *remarks),
        clocks=clocks,
        ours=profile is BUNDLED_PROFILE,
    )


def _require_parts(model: Model, profile: VehicleProfile, wiring: Wiring) -> None:
    """Make sure that every part has a binary, and that the profile names no others.

    Raises:
        FmuProfileError: the profile names a part that does not exist, or several variables.
        FmuPlatformError: a part has no binary for this platform.
    """
    wires = (*wiring.inputs, *wiring.outputs, wiring.initial_speed, wiring.initial_position)
    joint = next((w for w in wires if w is not None and len(w.channel.parts) > 1), None)
    if model.system is not None and joint is not None:
        raise FmuProfileError(
            f"{model.path}: {joint.channel.name}: several variables of a system of FMUs "
            "cannot have one role; join them within the system"
        )
    known = () if model.system is None else tuple(model.system.parts)
    for name in profile.parts:
        if name not in known:
            names = listed(known) or "one FMU is no system of parts"
            raise FmuProfileError(f"{model.path}: [parts.{name}]: no such part; it has: {names}")
    if model.system is None:
        return
    with unpacked_parts(model) as parts:
        for name, part in parts.items():
            kind = profile.parts[name].kind if name in profile.parts else None
            try:
                binary_of(part, interface_of(part, kind))
            except FmuError as error:
                reason = str(error).removeprefix(f"{part.path}: ")
                raise type(error)(f"{model.path}: part '{name}': {reason}") from None


def choose_profile(path: Path, profile: VehicleProfile | None) -> VehicleProfile:
    """Return the profile for driving: the given one, the shipped FMUs' own, or a draft.

    Raises:
        FmuFileError: the file is missing, or no readable FMU.
        FmuProfileError: there is doubt; the message says which lines to add.
    """
    return _chosen(read_model(path), profile)


def _chosen(model: Model, profile: VehicleProfile | None) -> VehicleProfile:
    if profile is not None:
        return profile
    if is_bundled(model.path):
        return BUNDLED_PROFILE
    return require_confident(draft_profile(model), model.path)


def unpack(prepared: PreparedFmu, folder: Path) -> None:
    """Unpack all members into ``folder`` but libraries for other platforms, sources and documents.

    A library may load others by their places from its own (``$ORIGIN``), wherever these are.

    Raises:
        FmuArchiveError: a member is damaged.
    """
    own = prepared.binary.split("/")[1]

    def wanted(name: str) -> bool:
        place, _, rest = name.partition("/")
        if place == "binaries":
            other = rest.partition("/")[0]
            return other == own or not is_platform(other)
        return place not in {"sources", "documentation"} or is_library(name)

    extract(open_archive(prepared.path), folder, wanted)
    (folder / "resources").mkdir(exist_ok=True)  # its path is given to the FMU even if it is empty


def notes_on(interface: Interface, binary: str) -> tuple[str, ...]:
    """Return the remarks on an FMU's library and on the folder from which it is loaded."""
    return tuple(note for note in (name_note(interface, binary), place_note()) if note)


def bounds_of(inputs: Sequence[Wire]) -> tuple[Bound, ...]:
    """Return the ranges that an FMU declares for its inputs."""
    return tuple(
        Bound(
            index,
            -inf if low is None or isnan(low) else low / factor,
            inf if high is None or isnan(high) else high / factor,
        )
        for index, wired in enumerate(inputs)
        for channel, factor in wired.channel.parts
        for low, high in ((channel.variable.minimum, channel.variable.maximum),)
        if (low is not None or high is not None) and (low is None or high is None or low <= high)
        if factor > 0.0
    )
