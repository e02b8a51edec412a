"""Fitting a profile to an FMU: each role gets a channel and its conversion to SI units."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from fmus.description import units
from fmus.description.channels import find_channel, known_names, start_channels
from fmus.description.model import (
    NUMERIC_TYPES,
    REAL_TYPES,
    Channel,
    Dimension,
    Interface,
    Kind,
    Model,
    Unit,
    Value,
    Variable,
)
from fmus.errors import FmuInterfaceError, FmuProfileError, FmuVariableError
from fmus.profile.vehicle_profile import Axis, Inputs, VehicleProfile

_QUANTITIES = {  # dimension and the unit to suggest, by role
    "force": (units.FORCE, "N"),
    "drive_force": (units.FORCE, "N"),
    "brake_force": (units.FORCE, "N"),
    "acceleration": (units.ACCELERATION, "m/s2"),
    "throttle": (units.NONE, "1"),
    "brake": (units.NONE, "1"),
    "speed_setpoint": (units.SPEED, "m/s"),
    "speed": (units.SPEED, "m/s"),
    "position": (units.LENGTH, "m"),
}
_INPUTS = (
    "force",
    "drive_force",
    "brake_force",
    "acceleration",
    "throttle",
    "brake",
    "speed_setpoint",
)
_OUTPUTS = ("speed", "position", "acceleration")
_LARGEST = 1e12  # SI per raw unit, or its inverse, or an offset: beyond it a number is mistyped


@dataclass(frozen=True)
class Wire:
    """A role of the vehicle and the FMU's variable that plays it: SI = scale * raw + shift."""

    role: str
    channel: Channel
    scale: float
    shift: float
    unit: str  # as shown to the user; empty if it has none

    def to_si(self, raw: float) -> float:
        """The quantity in SI units."""
        return self.scale * raw + self.shift

    def to_raw(self, value: float) -> float:
        """The quantity as the FMU wants it."""
        return (value - self.shift) / self.scale


class Recorded(NamedTuple):
    """A variable whose values the rows keep, as the FMU describes it."""

    name: str
    unit: str  # empty if it has none
    description: str


@dataclass(frozen=True)
class Wiring:
    """A profile that fits its FMU."""

    interface: Interface
    inputs: tuple[Wire, ...]
    outputs: tuple[Wire, ...]  # speed, position, acceleration, as far as the profile names them
    initial_speed: Wire | None
    initial_position: Wire | None
    start_values: Mapping[Channel, Value]
    recorded: tuple[Channel, ...] = ()  # read beside the outputs, in the FMU's own units

    @property
    def read(self) -> list[Channel]:
        """All that is read after a step: the outputs, then what is recorded."""
        return [*(wire.channel for wire in self.outputs), *self.recorded]

    @property
    def record(self) -> tuple[Recorded, ...]:
        """What is recorded, in words."""
        return tuple(
            Recorded(channel.name, channel.variable.unit, channel.variable.description)
            for channel in self.recorded
        )

    def output(self, role: str) -> int | None:
        """The index of a role among the outputs; None: the profile does not name it."""
        return next((i for i, wire in enumerate(self.outputs) if wire.role == role), None)


def wire(
    model: Model, profile: VehicleProfile, start_values: Mapping[str, Value] | None = None
) -> Wiring:
    """Find everything that ``profile`` names in an FMU.

    Args:
        model: of the FMU.
        profile: which variable plays which part.
        start_values: by variable name; they come after the profile's ``parameters``.

    Raises:
        FmuInterfaceError: the FMU has not the kind that the profile asks for.
        FmuVariableError: a variable is missing, or cannot be used as the profile wants.
        FmuProfileError: a unit is missing or of the wrong dimension.
    """
    outputs, initial = profile.outputs, profile.initial
    return Wiring(
        interface=_interface(model, profile.fmu.kind),
        inputs=_input_wires(model, profile.inputs),
        outputs=tuple(
            _wire(model, "outputs", role, axis)
            for role in _OUTPUTS
            if (axis := getattr(outputs, role)) is not None
        ),
        initial_speed=_initial(model, "speed", initial.speed),
        initial_position=_initial(model, "position", initial.position),
        start_values=start_channels(model, {**profile.parameters, **(start_values or {})}),
        recorded=tuple(_recorded(model, name) for name in profile.record),
    )


def _recorded(model: Model, name: str) -> Channel:
    """A variable whose value is kept.

    Raises:
        FmuVariableError: there is none, or it is no number that changes.
    """
    channel = find_channel(model, "record:", name)
    variable = channel.variable
    if variable.kind in NUMERIC_TYPES and _is_output(variable):
        return channel
    fitting = known_names(
        v.name for v in model.variables.values() if v.causality == "output" and v.kind in REAL_TYPES
    )
    what = f"is {variable.causality} {variable.kind}"
    raise FmuVariableError(
        f"{model.path}: record: variable '{name}' {what}; expected a number that the FMU computes: "
        f"{fitting}"
    )


def _input_wires(model: Model, inputs: Inputs) -> tuple[Wire, ...]:
    wires: dict[Channel, Wire] = {}
    for role in _INPUTS:
        axis = getattr(inputs, role)
        if axis is None:
            continue
        found = _wire(model, "inputs", role, axis)
        if found.channel in wires:
            raise FmuVariableError(
                f"{model.path}: [inputs.{role}] variable '{found.channel.name}' is that of "
                f"[inputs.{wires[found.channel].role}] already; expected another one"
            )
        wires[found.channel] = found
    return tuple(wires.values())


def _initial(model: Model, role: str, axis: Axis | None) -> Wire | None:
    return None if axis is None else _wire(model, "initial", role, axis)


def _interface(model: Model, wanted: str | None) -> Interface:
    if wanted is None:
        first = Kind.CO_SIMULATION if Kind.CO_SIMULATION in model.interfaces else None
        return model.interfaces[first or next(iter(model.interfaces))]
    kind = Kind(wanted)
    if kind not in model.interfaces:
        raise FmuInterfaceError(
            f"{model.path}: [fmu] kind = '{wanted}': the FMU has {', '.join(model.interfaces)} "
            "only; change the line, or export the model again"
        )
    return model.interfaces[kind]


def _wire(model: Model, table: str, role: str, axis: Axis) -> Wire:
    channel = find_channel(model, f"[{table}.{role}]", axis.variable)
    variable = channel.variable
    problem = ""
    if variable.kind not in NUMERIC_TYPES:
        problem = f"is {variable.kind}; expected a number"
    elif table == "inputs" and not _is_input(variable):
        fitting = known_names(v.name for v in model.variables.values() if v.causality == "input")
        problem = f"is {variable.causality}; expected an input: {fitting}"
    elif table == "outputs" and not _is_output(variable):
        fitting = known_names(v.name for v in model.variables.values() if v.causality == "output")
        problem = f"is {variable.causality}; expected an output: {fitting}"
    elif table == "initial" and not variable.settable:
        problem = f"is {variable.causality} and cannot be set before the start; leave it out"
    if problem:
        raise FmuVariableError(
            f"{model.path}: [{table}.{role}] variable '{channel.name}' {problem}"
        )
    return _converted(model, table, role, axis, channel)


def _is_input(variable: Variable) -> bool:
    return variable.causality == "input" or variable.variability == "tunable"


def _is_output(variable: Variable) -> bool:
    changes = variable.variability not in {"constant", "fixed"}
    return changes and variable.causality in {"output", "local", "internal"}


def _converted(model: Model, table: str, role: str, axis: Axis, channel: Channel) -> Wire:
    """The wire with the unit's factor and offset, and the profile's gain and offset."""
    declared = channel.variable.unit
    name = declared if axis.unit is None else axis.unit
    dimension, usual = _QUANTITIES[role]
    unit = units.to_si(model.units.get(name) or Unit(name)) if name else None
    problem = _unit_problem(unit, axis, dimension, usual)
    if problem:
        here = f"{model.path}: [{table}.{role}] variable '{channel.name}'"
        raise FmuProfileError(f"{here} {problem}, to [{table}.{role}]")
    gain = 1.0 if axis.gain is None else axis.gain
    factor, offset = (unit.factor, unit.offset) if unit is not None else (1.0, 0.0)
    scale, shift = gain * factor, gain * offset + axis.offset
    if not (1.0 / _LARGEST <= abs(scale) <= _LARGEST and abs(shift) <= _LARGEST):
        raise FmuProfileError(
            f"{model.path}: [{table}.{role}] variable '{channel.name}' = 1 would be {scale:g} "
            f"{usual} with an offset of {shift:g}; check unit, gain and offset of [{table}.{role}]"
        )
    return Wire(role, channel, scale, shift, name)


def _unit_problem(unit: Unit | None, axis: Axis, dimension: Dimension, usual: str) -> str:
    """Why a unit does not say how to convert to SI, and the line to add; empty if it does."""
    if axis.gain is not None:
        return ""
    if unit is None:
        if dimension == units.NONE:
            return ""
        return f'has no unit; add the line unit = "{usual}", or what it is'
    if unit.dimension is None:
        return (
            f"is in '{unit.name}', an unknown unit; add the line unit = \"{usual}\" or gain = ..."
        )
    if unit.dimension == dimension:
        return ""
    wanted, found = units.quantity(dimension), units.quantity(unit.dimension)
    return (
        f"is in '{unit.name}', {found}, and not {wanted}; name another variable, or add the line "
        f"gain = ... ({usual} per SI unit of {found})"
    )
