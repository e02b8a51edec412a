"""A role and the variable that plays it, with the conversion to SI units."""

from collections.abc import Iterable
from dataclasses import dataclass

from fmus.description import units
from fmus.description.channels import find_channel, known_names
from fmus.description.model import (
    NUMERIC_TYPES,
    Channel,
    Dimension,
    Interface,
    Kind,
    Model,
    Unit,
    Variable,
)
from fmus.errors import FmuInterfaceError, FmuProfileError, FmuVariableError
from fmus.profile.tables import Axis

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
    channel = find_channel(model, f"[{table}.{role}]", axis.variable)
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
    return _converted(model, table, role, axis, channel)


def distinct(model: Model, wires: Iterable[Wire]) -> tuple[Wire, ...]:
    """Return the wires of inputs, each with a variable of its own.

    Raises:
        FmuVariableError: two roles have the same variable.
    """
    taken: dict[Channel, Wire] = {}
    for wire in wires:
        if taken.setdefault(wire.channel, wire) is not wire:
            table = "grade" if wire.role == "slope" else wire.role
            raise FmuVariableError(
                f"{model.path}: [inputs.{table}] variable '{wire.channel.name}' is that of "
                f"[inputs.{taken[wire.channel].role}] already; expected another one"
            )
    return tuple(taken.values())


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
