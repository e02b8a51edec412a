"""A role and the variable that plays it, with the conversion to SI units."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from fmus.description import units
from fmus.description.channels import find_channel, find_channels, known_names
from fmus.description.model import (
    NUMERIC_TYPES,
    Channel,
    Dimension,
    Interface,
    JointChannel,
    Kind,
    Model,
    Unit,
    Variable,
)
from fmus.errors import FmuInterfaceError, FmuProfileError, FmuVariableError
from fmus.profile.tables import Axis
from fmus.profile.vehicle_profile import VehicleAxis

_QUANTITIES = {  # dimension and the unit to suggest, by role
    "force": (units.FORCE, "N"),
    "drive_force": (units.FORCE, "N"),
    "brake_force": (units.FORCE, "N"),
    "acceleration": (units.ACCELERATION, "m/s2"),
    "throttle": (units.NONE, "1"),
    "brake": (units.NONE, "1"),
    "speed_setpoint": (units.SPEED, "m/s"),
    "grade": (units.ANGLE, "rad"),
    "slope": (units.NONE, "1"),  # the tangent of the grade
    "speed": (units.SPEED, "m/s"),
    "position": (units.LENGTH, "m"),
    "last_force": (units.FORCE, "N"),
    "gap": (units.LENGTH, "m"),
    "person_gap": (units.LENGTH, "m"),
    "leader_gap": (units.LENGTH, "m"),
    "leader_speed": (units.SPEED, "m/s"),
    "speed_limit": (units.SPEED, "m/s"),
    "stop_gap": (units.LENGTH, "m"),
    "obstacle_positions": (units.LENGTH, "m"),
    "obstacle_gaps": (units.LENGTH, "m"),
    "time_step": (units.TIME, "s"),
    "mass": (units.MASS, "kg"),
    "friction": (units.FRICTION, "N.s/m"),
    "reference_speed": (units.SPEED, "m/s"),
    "safe_distance": (units.LENGTH, "m"),
    "force_limit": (units.FORCE, "N"),
    "comfortable_deceleration": (units.ACCELERATION, "m/s2"),
}
DIVIDED: Final = frozenset({"force", "drive_force", "brake_force"})
_TURNING: Final = {  # dimensions that a radius turns into that of the role, and the unit to suggest
    **dict.fromkeys(DIVIDED, ((units.TORQUE,), "N.m")),
    **dict.fromkeys(("speed", "speed_setpoint"), ((units.TURNING, units.FREQUENCY), "rad/s")),
    "position": ((units.ANGLE, units.NONE), "rad"),
    "acceleration": (((0, 0, -2, 0, 0, 0, 0, 1), (0, 0, -2, 0, 0, 0, 0, 0)), "rad/s2"),
}
# Largest SI value per raw unit, its inverse, or offset; beyond it, a number is mistyped
_LARGEST = 1e12


@dataclass(frozen=True)
class Wire:
    """A role of the vehicle and the FMU's variable that has it: SI = scale * raw + shift."""

    role: str
    channel: Channel
    scale: float
    shift: float
    unit: str  # unit as shown to the user; empty without one

    def to_si(self, raw: float) -> float:
        """Return the quantity in SI units."""
        return self.scale * raw + self.shift

    def to_raw(self, value: float) -> float:
        """Return the quantity in the unit of the FMU."""
        return (value - self.shift) / self.scale


def interface_of(model: Model, wanted: str | None) -> Interface:
    """Return the interface that a profile's ``kind`` names, by default Co-Simulation.

    Raises:
        FmuInterfaceError: the FMU does not have it.
    """
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


def make_wire(model: Model, table: str, role: str, axis: Axis) -> Wire:
    """Return the wire of one role.

    Args:
        model: Model of the FMU.
        table: Table of the profile that names the role.
        role: Role in that table.
        axis: Variable of the role, with its unit and gain.

    Raises:
        FmuVariableError: the variable is missing, or cannot be used in this role.
        FmuProfileError: a unit is missing or of the wrong dimension.
    """
    joint = axis if isinstance(axis, VehicleAxis) and axis.variables else None
    if joint is not None:
        return _joint_wire(model, table, role, joint)
    channel = find_channel(model, f"[{table}.{role}]", axis.variable)
    _require_usable(model, table, role, channel)
    return _converted(model, table, role, axis, channel)


def _joint_wire(model: Model, table: str, role: str, axis: VehicleAxis) -> Wire:
    """Return the wire of a role that several variables have."""
    here = f"{model.path}: [{table}.{role}]"
    parts = [c for name in axis.names for c in find_channels(model, f"[{table}.{role}]", name)]
    for channel in parts:
        _require_usable(model, table, role, channel)
    divided = table == "inputs" and role in DIVIDED
    if axis.share is not None and not divided:
        raise FmuProfileError(f"{here} share: only a force is divided; leave it out")
    if axis.share is not None and len(axis.share) != len(parts):
        raise FmuProfileError(
            f"{here} share: {len(axis.share)} numbers for {len(parts)} variables; expected one each"
        )
    first = parts[0]
    odd = next((c for c in parts if _speech(c) != _speech(first)), None)
    if odd is not None:
        raise FmuProfileError(
            f"{here} variables '{first.name}' and '{odd.name}' differ in unit or type; name "
            "variables of one unit and type"
        )
    if len(set(parts)) < len(parts):
        raise FmuProfileError(f"{here} variables: one of them is named twice; expected each once")
    mean = 1.0 if table != "outputs" and not divided else 1.0 / len(parts)
    factors = axis.share or [mean] * len(parts)
    joined = tuple(zip(parts, factors, strict=True))
    wire = _converted(model, table, role, axis, JointChannel(first.variable, first.element, joined))
    if divided and wire.shift != 0.0:
        raise FmuProfileError(f"{here} a force with an offset cannot be divided; leave it out")
    return wire


def _speech(channel: Channel) -> tuple[str, str, bool]:
    """Return unit and type of a variable."""
    return channel.variable.unit, channel.variable.kind, channel.variable.negated


def _require_usable(model: Model, table: str, role: str, channel: Channel) -> None:
    """Refuse a variable that cannot have a role.

    Raises:
        FmuVariableError: it is not of the role's kind.
    """
    variable = channel.variable
    problem = ""
    if variable.kind not in NUMERIC_TYPES:
        problem = f"is {variable.kind}; expected a number"
    elif table == "inputs" and not _is_input(variable):
        fitting = known_names(v.name for v in model.variables.values() if v.causality == "input")
        problem = f"is {variable.causality}; expected an input: {fitting}"
    elif table == "outputs" and not is_output(variable):
        fitting = known_names(v.name for v in model.variables.values() if v.causality == "output")
        problem = f"is {variable.causality}; expected an output: {fitting}"
    elif table in {"initial", "setup"} and not variable.settable:
        problem = f"is {variable.causality} and cannot be set before the start; leave it out"
    if problem:
        raise FmuVariableError(
            f"{model.path}: [{table}.{role}] variable '{channel.name}' {problem}"
        )


def distinct(model: Model, wires: Iterable[Wire]) -> tuple[Wire, ...]:
    """Return the wires of inputs, each with a variable of its own.

    Raises:
        FmuVariableError: two roles have the same variable.
    """
    taken: dict[Channel, Wire] = {}
    for wire in wires:
        for channel, _share in wire.channel.parts:
            if taken.setdefault(channel, wire) is not wire:
                table = "grade" if wire.role == "slope" else wire.role
                raise FmuVariableError(
                    f"{model.path}: [inputs.{table}] variable '{channel.name}' is that of "
                    f"[inputs.{taken[channel].role}] already; expected another one"
                )
    return tuple(dict.fromkeys(taken.values()))


def _is_input(variable: Variable) -> bool:
    return variable.causality == "input" or variable.variability == "tunable"


def is_output(variable: Variable) -> bool:
    """Return whether the FMU computes a variable."""
    changes = variable.variability not in {"constant", "fixed"}
    return changes and variable.causality in {"output", "local", "internal"}


def _converted(model: Model, table: str, role: str, axis: Axis, channel: Channel) -> Wire:
    """Return the wire with the unit's factor and offset, and the profile's gain and offset."""
    declared = channel.variable.unit
    name = declared if axis.unit is None else axis.unit
    dimension, usual = _QUANTITIES[role]
    unit = units.to_si(model.units.get(name) or Unit(name)) if name else None
    radius = axis.radius if isinstance(axis, VehicleAxis) else None
    if radius is None:
        problem = _unit_problem(unit, axis, dimension, usual)
    else:
        problem = _radius_problem(unit, role)
    if problem:
        here = f"{model.path}: [{table}.{role}] variable '{channel.name}'"
        raise FmuProfileError(f"{here} {problem}, to [{table}.{role}]")
    gain = 1.0 if axis.gain is None else axis.gain
    if radius is not None:
        gain = gain / radius if role in DIVIDED else gain * radius
    factor, offset = (unit.factor, unit.offset) if unit is not None else (1.0, 0.0)
    scale, shift = gain * factor, gain * offset + axis.offset
    if not (1.0 / _LARGEST <= abs(scale) <= _LARGEST and abs(shift) <= _LARGEST):
        raise FmuProfileError(
            f"{model.path}: [{table}.{role}] variable '{channel.name}' = 1 would be {scale:g} "
            f"{usual} with an offset of {shift:g}; check unit, gain and offset of [{table}.{role}]"
        )
    return Wire(role, channel, scale, shift, name)


def _radius_problem(unit: Unit | None, role: str) -> str:
    """Return why a quantity does not turn into the role's with a radius, or an empty text."""
    turning = _TURNING.get(role)
    if turning is None:
        return "has a radius, which only forces and motions have; leave out radius"
    dimensions, usual = turning
    if unit is None:
        return f'has no unit; add the line unit = "{usual}", or what it is'
    if unit.dimension in dimensions and "Hz" not in unit.name:
        return ""
    found = units.quantity(unit.dimension)
    return (
        f"is in '{unit.name}', {found}, and not in {usual}; leave out radius, or add the true unit"
    )


def _unit_problem(unit: Unit | None, axis: Axis, dimension: Dimension, usual: str) -> str:
    """Return why a unit cannot be converted to SI, and the line to add, or an empty text."""
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
