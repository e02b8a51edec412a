"""A vehicle's first state: the FMU's start values, and the check that it starts there."""

from fmus.description.model import Channel, Value
from fmus.driving.motion import Motion, names_of
from fmus.driving.run_up import run_up
from fmus.errors import FmuOutputError, FmuStartError, FmuStepError
from fmus.interfaces.vehicle import Drivable
from fmus.profile.preparation import Prepared

_FIT = 0.02  # [m/s] or [m], and relative: largest error of the first state


def start_values(prepared: Prepared, position: float, speed: float) -> dict[Channel, Value]:
    """Return the FMU's start values; its inputs start with their values for no force."""
    wiring = prepared.wiring
    at_rest = memoryview(bytearray(8 * len(wiring.inputs))).cast("d")
    prepared.command.apply(0.0, speed, at_rest)
    if wiring.grade is not None:
        at_rest[wiring.grade] = wiring.grade_to_raw(0.0)
    Motion(prepared).keep_bounds(at_rest)
    values: dict[Channel, Value] = {
        wire.channel: value
        for wire, value in zip(wiring.inputs, at_rest, strict=True)
        if wire.channel.variable.settable and wire.channel.variable.is_real
    }
    values |= wiring.start_values
    for initial, value in ((wiring.initial_position, position), (wiring.initial_speed, speed)):
        if initial is not None:
            raw = initial.to_raw(value)
            values[initial.channel] = round(raw) if initial.channel.variable.is_integer else raw
    return values


def reach(vehicle: Drivable, speed: float) -> float | None:
    """Check that the vehicle starts at a speed [m/s], or drive up to it.

    Returns:
        Duration of the drive [s], or None if the FMU starts at the speed.

    Raises:
        FmuStartError: the vehicle cannot get to the speed.
        FmuStepError: the FMU failed on the way there.
        FmuOutputError: the FMU's outputs were implausible on the way there.
    """
    if _fits(vehicle.speed, speed):
        return None
    wiring = vehicle.prepared.wiring
    name = names_of(wiring)["speed"]
    if wiring.initial_speed is not None:
        radius = " and the radius" if vehicle.prepared.profile.outputs.speed.radius else ""
        raise FmuStartError(
            f"{vehicle.path}: {wiring.initial_speed.channel.name} was set to start at {speed:g} "
            f"m/s, but {name} = {vehicle.speed:.6g} m/s; check the units of both{radius}, or leave "
            "out [initial.speed]"
        )
    if not vehicle.prepared.profile.initial.run_up or speed < 0.0:
        raise FmuStartError(
            f"{vehicle.path}: {name} starts at {vehicle.speed:.6g} m/s and not at {speed:g} m/s; "
            "name the FMU's parameter for it, [initial.speed] variable = ..., or start at this "
            "speed (--ego-initial-speed)"
        )
    try:
        return run_up(vehicle, speed)
    except (FmuStepError, FmuOutputError) as error:
        raise type(error)(
            f"{error} (before the start, driving up to the initial speed of {speed:g} m/s)"
        ) from None


def require_position(vehicle: Drivable, position: float) -> None:
    """Check that an FMU with a parameter for its first position [m] starts there.

    Raises:
        FmuStartError: the FMU starts elsewhere.
    """
    wiring = vehicle.prepared.wiring
    initial = wiring.initial_position
    if initial is not None and not _fits(vehicle.position, position):
        raise FmuStartError(
            f"{vehicle.path}: {initial.channel.name} was set to start at {position:g} m, but "
            f"{names_of(wiring)['position']} = {vehicle.position:.6g} m; check the units of both, "
            "or leave out [initial.position]"
        )


def _fits(found: float, wanted: float) -> bool:
    return abs(found - wanted) <= max(_FIT, _FIT * abs(wanted))
