"""Whether a profile fits an FMU: roles become channels, with the conversion of each to SI units."""

from __future__ import annotations

import re
from dataclasses import dataclass
from difflib import get_close_matches
from math import isfinite
from typing import TYPE_CHECKING

from fmus import units
from fmus.errors import FmuInterfaceError, FmuProfileError, FmuVariableError
from fmus.model import NUMERIC_TYPES, Channel, Kind, Unit

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from fmus.model import Dimension, Interface, Model, Variable
    from fmus.profile import Axis, Value, VehicleProfile

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
_ELEMENT = re.compile(r"(?P<name>.*)\[(?P<number>\d+)\]")
_SHOWN = 8  # variables that a message lists


@dataclass(frozen=True)
class Wire:
    """A role of the vehicle, the FMU's variable that plays it: SI = scale * raw + shift."""

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


@dataclass(frozen=True)
class Wiring:
    """A profile that fits its FMU."""

    interface: Interface
    inputs: tuple[Wire, ...]
    outputs: tuple[Wire, ...]  # speed, position, acceleration: as far as there are
    initial_speed: Wire | None
    initial_position: Wire | None
    start_values: Mapping[Channel, Value]

    def output(self, role: str) -> int | None:
        """The index among the outputs; None: the FMU does not give it."""
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
    inputs, outputs, initial = profile.inputs, profile.outputs, profile.initial
    return Wiring(
        interface=_interface(model, profile.fmu.kind),
        inputs=tuple(
            _wire(model, "inputs", role, axis)
            for role in _INPUTS
            if (axis := getattr(inputs, role)) is not None
        ),
        outputs=tuple(
            _wire(model, "outputs", role, axis)
            for role in _OUTPUTS
            if (axis := getattr(outputs, role)) is not None
        ),
        initial_speed=_initial(model, "speed", initial.speed),
        initial_position=_initial(model, "position", initial.position),
        start_values=_start_values(model, {**profile.parameters, **(start_values or {})}),
    )


def _initial(model: Model, role: str, axis: Axis | None) -> Wire | None:
    return None if axis is None else _wire(model, "initial", role, axis)


def _interface(model: Model, wanted: str | None) -> Interface:
    if wanted is None:
        first = Kind.CO_SIMULATION if Kind.CO_SIMULATION in model.interfaces else None
        return model.interfaces[first or next(iter(model.interfaces))]
    kind = Kind(wanted)
    if kind not in model.interfaces:
        msg = (
            f"{model.path}: [fmu] kind = '{wanted}': the FMU has {', '.join(model.interfaces)} "
            "only; change the line, or export the model again"
        )
        raise FmuInterfaceError(msg)
    return model.interfaces[kind]


def _wire(model: Model, table: str, role: str, axis: Axis) -> Wire:
    channel = _channel(model, f"[{table}.{role}]", axis.variable)
    variable = channel.variable
    problem = ""
    if variable.kind not in NUMERIC_TYPES:
        problem = f"is {variable.kind}; expected a number"
    elif table == "inputs" and not _is_input(variable):
        fitting = _listed(v.name for v in model.variables.values() if v.causality == "input")
        problem = f"is {variable.causality}; expected an input: {fitting}"
    elif table == "outputs" and not _is_output(variable):
        fitting = _listed(v.name for v in model.variables.values() if v.causality == "output")
        problem = f"is {variable.causality}; expected an output: {fitting}"
    elif table == "initial" and not variable.settable:
        problem = f"is {variable.causality} and cannot be set before the start; leave it out"
    if problem:
        msg = f"{model.path}: [{table}.{role}] variable '{channel.name}' {problem}"
        raise FmuVariableError(msg)
    return _converted(model, table, role, axis, channel)


def _is_input(variable: Variable) -> bool:
    return variable.causality == "input" or variable.variability == "tunable"


def _is_output(variable: Variable) -> bool:
    changes = variable.variability not in {"constant", "fixed"}
    return changes and variable.causality in {"output", "local", "internal"}


def _channel(model: Model, place: str, name: str) -> Channel:
    """The variable, or the element of an array, that is called ``name``."""
    variables = model.variables
    element = _ELEMENT.fullmatch(name)
    if name in variables:
        variable = variables[name]
        if variable.size == 1:
            return Channel(variable)
        msg = (
            f"{model.path}: {place} variable '{name}' is an array of {variable.size}; name one "
            f"element, '{name}[1]' to '{name}[{variable.size}]'"
        )
        raise FmuVariableError(msg)
    if element is not None and element["name"] in variables:
        variable, number = variables[element["name"]], int(element["number"])
        if variable.shape and 1 <= number <= variable.size:
            return Channel(variable, number - 1)
        msg = f"{model.path}: {place} variable '{name}': '{variable.name}' has {variable.size} "
        raise FmuVariableError(f"{msg}element(s), counted from 1")
    close = get_close_matches(name, variables, n=1)
    hint = f"did you mean '{close[0]}'?" if close else f"it has {_listed(variables)}"
    msg = f"{model.path}: {place} no variable '{name}' in the FMU; {hint}"
    raise FmuVariableError(msg)


def _converted(model: Model, table: str, role: str, axis: Axis, channel: Channel) -> Wire:
    """With the unit's factor and offset, and the user's gain and offset."""
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
    return Wire(role, channel, gain * factor, gain * offset + axis.offset, name)


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


def _start_values(model: Model, values: Mapping[str, Value]) -> dict[Channel, Value]:
    """The start values by channel; a whole array stands as its first element.

    Raises:
        FmuVariableError: one is missing, cannot be set, or not to this value.
    """
    return {start_channel(model, name, value): value for name, value in values.items()}


def start_channel(model: Model, name: str, value: Value) -> Channel:
    """The variable for a start value, which must be fit for it.

    Raises:
        FmuVariableError: it is missing, cannot be set, or not to this value.
    """
    whole = name in model.variables and isinstance(value, list)
    channel = Channel(model.variables[name]) if whole else _channel(model, "start value", name)
    variable = channel.variable
    problem = ""
    if not variable.settable:
        problem = f"'{name}' is {variable.causality}; expected a parameter or an input"
    elif isinstance(value, list):
        if len(value) != variable.size:
            problem = f"expected {variable.size} number(s)"
    else:
        problem = _misfit(variable, value)
    if problem:
        msg = f"{model.path}: start value {name} = {value}: {problem}"
        raise FmuVariableError(msg)
    return channel


def _misfit(variable: Variable, value: bool | float | str) -> str:
    """What is wrong with a start value; empty if nothing is."""
    if variable.is_boolean:
        return "" if isinstance(value, bool) else "expected true or false"
    if variable.kind == "String":
        return "" if isinstance(value, str) else "expected text"
    if variable.is_integer:
        whole = isinstance(value, int) and not isinstance(value, bool)
        return "" if whole else "expected a whole number"
    if not variable.is_real:
        return f"'{variable.name}' is {variable.kind}; expected a number, text, true or false"
    if isinstance(value, bool | str) or not isfinite(value):
        return "expected a finite number"
    return _out_of_range(variable, value)


def _out_of_range(variable: Variable, value: float) -> str:
    low, high = variable.minimum, variable.maximum
    allowed = ""
    if low is not None and value < low:
        allowed = f"at least {low:g}"
    elif high is not None and value > high:
        allowed = f"at most {high:g}"
    return f"expected {allowed} {variable.unit}".rstrip() if allowed else ""


def _listed(names: Iterable[str]) -> str:
    names = list(names)
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    return (", ".join(names[:_SHOWN]) + more) or "the FMU has none"
