"""The fitting of a profile to an FMU: each role gets a channel and its conversion to SI units."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import tan
from typing import NamedTuple

from fmus.description import units
from fmus.description.channels import find_channel, find_channels, known_names, start_channels
from fmus.description.model import NUMERIC_TYPES, REAL_TYPES, Channel, Interface, Model, Unit, Value
from fmus.errors import FmuVariableError
from fmus.profile.vehicle_profile import Inputs, VehicleAxis, VehicleProfile
from fmus.profile.wires import Wire, distinct, interface_of, is_output, make_wire

_INPUTS = (
    "force",
    "drive_force",
    "brake_force",
    "acceleration",
    "throttle",
    "brake",
    "speed_setpoint",
    "grade",
)
_OUTPUTS = ("speed", "position", "acceleration")


class Recorded(NamedTuple):
    """A variable that is recorded, as the FMU describes it."""

    name: str
    unit: str  # empty if it has none
    description: str


@dataclass(frozen=True)
class Wiring:
    """A profile that fits its FMU."""

    interface: Interface
    inputs: tuple[Wire, ...]
    outputs: tuple[Wire, ...]  # speed, position, acceleration, if the profile names them
    initial_speed: Wire | None
    initial_position: Wire | None
    start_values: Mapping[Channel, Value]
    # channels that are read besides the outputs, in the FMU's own units
    recorded: tuple[Channel, ...] = ()

    @property
    def read(self) -> list[Channel]:
        """All channels that are read after a step: the outputs, then the recorded variables."""
        return [*(wire.channel for wire in self.outputs), *self.recorded]

    @property
    def record(self) -> tuple[Recorded, ...]:
        """Recorded variables with their units and descriptions."""
        return tuple(
            Recorded(channel.name, channel.variable.unit, channel.variable.description)
            for channel in self.recorded
        )

    @property
    def grade(self) -> int | None:
        """The index of the road's grade among the inputs, or None if it is no input."""
        last = len(self.inputs) - 1
        return last if self.inputs[last].role in {"grade", "slope"} else None

    def grade_to_raw(self, grade: float) -> float:
        """Return a grade [rad] in the unit of the last input."""
        wire = self.inputs[-1]
        return wire.to_raw(tan(grade) if wire.role == "slope" else grade)

    def output(self, role: str) -> int | None:
        """Return the index of a role among the outputs, or None if the profile does not name it."""
        return next((i for i, wire in enumerate(self.outputs) if wire.role == role), None)


def wire(
    model: Model, profile: VehicleProfile, start_values: Mapping[str, Value] | None = None
) -> Wiring:
    """Find everything that ``profile`` names in an FMU.

    Args:
        model: Model of the FMU.
        profile: Roles of the FMU's variables.
        start_values: Start values by variable name, which are set after the profile's
            ``parameters``.

    Raises:
        FmuInterfaceError: the FMU does not have the interface that the profile names.
        FmuVariableError: a variable is missing, or cannot be used as the profile says.
        FmuProfileError: a unit is missing or of the wrong dimension.
    """
    outputs, initial = profile.outputs, profile.initial
    return Wiring(
        interface=interface_of(model, profile.fmu.kind),
        inputs=_input_wires(model, profile.inputs),
        outputs=tuple(
            make_wire(model, "outputs", role, axis)
            for role in _OUTPUTS
            if (axis := getattr(outputs, role)) is not None
        ),
        initial_speed=_initial(model, "speed", initial.speed),
        initial_position=_initial(model, "position", initial.position),
        start_values=start_channels(
            model,
            {
                **({} if model.system is None else model.system.values),
                **profile.parameters,
                **(start_values or {}),
            },
        ),
        recorded=tuple(_recorded(model, name) for name in profile.record),
    )


def _recorded(model: Model, name: str) -> Channel:
    """Return a variable whose value is recorded.

    Raises:
        FmuVariableError: there is no such variable, or it is no number that changes.
    """
    channel = find_channel(model, "record:", name)
    variable = channel.variable
    if variable.kind in NUMERIC_TYPES and is_output(variable):
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
    named = ((role, getattr(inputs, role)) for role in _INPUTS)
    return distinct(
        model,
        (
            _grade_wire(model, axis) if role == "grade" else make_wire(model, "inputs", role, axis)
            for role, axis in named
            if axis is not None
        ),
    )


def _grade_wire(model: Model, axis: VehicleAxis) -> Wire:
    """Return the wire of the road's grade: an angle, or its tangent for the units 1 and %."""
    variable = find_channels(model, "[inputs.grade]", axis.names[0])[0].variable
    name = axis.unit or variable.unit
    unit = units.to_si(model.units.get(name) or Unit(name)) if name else None
    tangent = unit is not None and unit.dimension == units.NONE and axis.gain is None
    return make_wire(model, "inputs", "slope" if tangent else "grade", axis)


def _initial(model: Model, role: str, axis: VehicleAxis | None) -> Wire | None:
    return None if axis is None else make_wire(model, "initial", role, axis)
