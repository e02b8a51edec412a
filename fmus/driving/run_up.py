"""The run-up of a vehicle to its initial speed, if the FMU has no parameter for it."""

from fmus.errors import FmuStartError
from fmus.interfaces.vehicle import Drivable
from fmus.profile.advice import gain_line
from fmus.text import printable

_NEAR = 0.01  # [m/s] largest error of the final speed
_SETTLED = 0.5  # [s] time over which the speed must keep that error
_CLOSE = 0.3  # [m/s] error below which the integrator works
_LIMIT = 120.0  # [s] longest simulated time
_RESPONSE = 0.5  # [s] time constant of the approach
_INTEGRATION = 4.0  # [s] time constant of the integrator, for resistance beyond the model's
_BACKWARDS = 1.0  # [m/s] backward speed that is more than creeping
_STILL = 0.02  # [m/s] change of speed up to which the vehicle stands still
_STRONGEST = 3.0  # Largest commanded acceleration [m/s2]


def run_up(vehicle: Drivable, speed: float) -> float:
    """Drive ``vehicle`` until it keeps ``speed`` [m/s], and return the time that it took [s].

    Raises:
        FmuStartError: the vehicle does not reach the speed.
    """
    profile = vehicle.prepared.profile
    known = profile.model or profile.inverse_map
    mass, friction = known.mass, known.friction
    h, integral, settled, first = vehicle.step_size, 0.0, 0.0, vehicle.speed
    for _ in range(round(_LIMIT / h)):
        error = speed - vehicle.speed
        acceleration = min(max(error / _RESPONSE + integral, -_STRONGEST), _STRONGEST)
        if abs(error) < _CLOSE:  # farther away, the integrator would wind up
            integral += error * h / (_RESPONSE * _INTEGRATION)
        vehicle.step(mass * acceleration + friction * speed)
        settled = settled + h if abs(speed - vehicle.speed) <= _NEAR else 0.0
        if settled >= _SETTLED and vehicle.between_steps:
            return vehicle.time
    if vehicle.speed < first - _BACKWARDS:
        role = vehicle.prepared.wiring.inputs[0].role
        raise FmuStartError(
            f"{vehicle.path}: forces forwards drive it backwards (it is at {vehicle.speed:.4g} m/s "
            f"after {_LIMIT:g} s, and not at its initial speed of {speed:g} m/s); turn the sign "
            f"with {gain_line(profile, 'inputs', role, -1.0, '')}, or in [outputs.speed]"
        )
    if abs(vehicle.speed - first) < _STILL:
        raise FmuStartError(
            f"{vehicle.path}: does not reach its initial speed of {speed:g} m/s: no force moves it "
            f"(it is at {vehicle.speed:.4g} m/s after {_LIMIT:g} s); a gear, ignition or brake may "
            f"have to be set under [parameters]{_idle(vehicle)}"
        )
    raise FmuStartError(
        f"{vehicle.path}: does not reach its initial speed of {speed:g} m/s within {_LIMIT:g} s "
        f"(it is at {vehicle.speed:.4g} m/s); name its parameter for it, [initial.speed] variable "
        "= ..., or start slower (--ego-initial-speed)"
    )


def _idle(vehicle: Drivable) -> str:
    """Return the inputs that the profile does not use, as the end of a message."""
    prepared = vehicle.prepared
    wires = prepared.wiring.inputs
    driven = {channel.variable.name for wire in wires for channel, _ in wire.channel.parts}
    idle = [
        f"{v.name} = {v.start or '?'}"
        for v in prepared.model.variables.values()
        if v.causality == "input" and v.name not in driven
    ]
    return f"; inputs that keep their start values: {printable(', '.join(idle))}" if idle else ""
