"""The fitting of a controller profile to an FMU: the variables of its inputs and its answer."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import count, takewhile

from fmus.description.channels import find_channel, start_channels
from fmus.description.model import Channel, Interface, Model, Value
from fmus.errors import FmuVariableError
from fmus.profile.controllers.controller_profile import (
    ANSWERS,
    SERIES,
    SETTINGS,
    TOLD,
    ControllerProfile,
)
from fmus.profile.tables import Axis
from fmus.profile.wires import Wire, distinct, interface_of, make_wire


@dataclass(frozen=True)
class ControllerWiring:
    """A controller profile that fits its FMU.

    Attributes:
        interface: Interface by which it is run.
        inputs: Wires of the inputs; those of a series follow one another.
        answer: Wire of its output.
        start_values: Start values of its parameters.
    """

    interface: Interface
    inputs: tuple[Wire, ...]
    answer: Wire
    start_values: Mapping[Channel, Value]

    @property
    def horizon(self) -> int:
        """Horizon N: the number of steps of its longest series, or 0 without a series."""
        roles = [wire.role for wire in self.inputs]
        return max(roles.count(series) for series in SERIES)


def wire_controller(
    model: Model,
    profile: ControllerProfile,
    setup: Mapping[str, float],
    start_values: Mapping[str, Value],
) -> ControllerWiring:
    """Find everything that ``profile`` names in an FMU.

    Args:
        model: Model of the FMU.
        profile: Roles of the FMU's variables.
        setup: Settings of the run, by the names of the profile's table ``setup`` [SI].
        start_values: Start values by variable name, which are set after the profile's own and
            ``setup``.

    Raises:
        FmuInterfaceError: the FMU does not have the interface that the profile names.
        FmuVariableError: a variable is missing, or cannot be used as the profile says.
        FmuProfileError: a unit is missing or of the wrong dimension.
    """
    (answer,) = (
        make_wire(model, "outputs", role, axis)
        for role in ANSWERS
        if (axis := getattr(profile.outputs, role)) is not None
    )
    own = {name: _typed(model, name, value) for name, value in start_values.items()}
    return ControllerWiring(
        interface=interface_of(model, profile.fmu.kind),
        inputs=_inputs(model, profile),
        answer=answer,
        start_values={
            **start_channels(model, profile.parameters),
            **_settings(model, profile, setup),
            **start_channels(model, own),
        },
    )


def _inputs(model: Model, profile: ControllerProfile) -> tuple[Wire, ...]:
    named = ((role, getattr(profile.inputs, role)) for role in TOLD)
    return distinct(
        model,
        (
            make_wire(model, "inputs", role, one)
            for role, axis in named
            if axis is not None
            for one in (_series(model, role, axis) if role in SERIES else [axis])
        ),
    )


def _series(model: Model, role: str, axis: Axis) -> list[Axis]:
    """Return an axis for each step ahead, of an array's elements or of numbered variables."""
    name, variables = axis.variable, model.variables
    names: Iterable[str]
    if "#" in name:
        names = takewhile(variables.__contains__, (name.replace("#", str(i)) for i in count(1)))
    elif name in variables:
        array = variables[name]
        names = [f"{name}[{i + 1}]" for i in range(array.size)] if array.shape else [name]
    else:
        names = takewhile(variables.__contains__, (f"{name}[{i}]" for i in count(1)))
    found = [axis.model_copy(update={"variable": one}) for one in names]
    if not found:
        find_channel(model, f"[inputs.{role}]", name)  # the error says which name is probably meant
        raise FmuVariableError(
            f"{model.path}: [inputs.{role}] variable '{name}' has no elements; expected an array, "
            f"variables x[1], x[2], ... named x, or variables x1, x2, ... named x#"
        )
    return found


def _settings(
    model: Model, profile: ControllerProfile, setup: Mapping[str, float]
) -> dict[Channel, Value]:
    """Return the parameters that get the settings of the run."""
    values: dict[str, Value] = {}
    for name in SETTINGS:
        axis = getattr(profile.setup, name)
        if axis is not None:
            wire = make_wire(model, "setup", name, axis)
            raw = wire.to_raw(setup[name])
            values[wire.channel.name] = round(raw) if wire.channel.variable.is_integer else raw
    return start_channels(model, values)


def _typed(model: Model, name: str, value: Value) -> Value:
    """Convert a whole number or a word of the command line to the variable's type."""
    variable = model.variables.get(name)
    if variable is None:
        return value
    if variable.is_boolean and value in {"true", "false"}:
        return value == "true"
    if variable.is_integer and isinstance(value, float) and value.is_integer():
        return int(value)
    if variable.kind == "String" and not isinstance(value, str):
        return str(value)
    return value
