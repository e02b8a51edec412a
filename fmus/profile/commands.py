"""The inverse maps: from the controller's force to the inputs of an FMU.

The controller's model is M v' + alpha v = u (Yang & Özgüner 2019, eq. (2)). An FMU without a force
input gets the values that give the same motion in this model, with M and alpha of the profile's
``inverse_map``.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass

from fmus.profile.vehicle_profile import VehicleProfile
from fmus.profile.wires import Wire

HELD = 0.4  # [m/s] speed below which a vehicle that is not driven is held ever more firmly


class Command(ABC):
    """Turns a force into the values of the FMU's inputs."""

    @abstractmethod
    def apply(self, force: float, speed: float, inputs: memoryview[float], /) -> None:
        """Fill the inputs, in the FMU's units.

        Args:
            force: Force u [N], forwards positive.
            speed: Present speed v [m/s].
            inputs: Inputs to be filled.
        """


@dataclass(frozen=True)
class ForceCommand(Command):
    """The force u itself; at a standstill a brake holds and does not push backwards."""

    scale: float
    shift: float
    block_reverse: bool

    def apply(self, force: float, speed: float, inputs: memoryview[float], /) -> None:
        """Fill the inputs; see :class:`Command`."""
        if self.block_reverse and force < 0.0 and speed <= 0.0:
            force = 0.0
        inputs[0] = (force - self.shift) / self.scale


@dataclass(frozen=True)
class SplitForceCommand(Command):
    """Drive force max(u, 0) and brake force max(-u, 0); at a standstill the brake is released."""

    drive: Wire
    brake: Wire
    block_reverse: bool

    def apply(self, force: float, speed: float, inputs: memoryview[float], /) -> None:
        """Fill the inputs; see :class:`Command`."""
        if self.block_reverse and force < 0.0 and speed <= 0.0:
            force = 0.0
        inputs[0] = self.drive.to_raw(max(force, 0.0))
        inputs[1] = self.brake.to_raw(max(-force, 0.0))


@dataclass(frozen=True)
class AccelerationCommand(Command):
    """The acceleration (u - alpha v) / M."""

    wire: Wire
    mass: float  # M [kg]
    friction: float  # alpha [N.s/m]
    block_reverse: bool

    def apply(self, force: float, speed: float, inputs: memoryview[float], /) -> None:
        """Fill the inputs; see :class:`Command`."""
        acceleration = (force - self.friction * speed) / self.mass
        if self.block_reverse and acceleration < 0.0 and speed <= 0.0:
            acceleration = 0.0
        inputs[0] = self.wire.to_raw(acceleration)


@dataclass(frozen=True)
class PedalCommand(Command):
    """Pedal positions: the share of the force at full throttle or full brake, up to 1."""

    throttle: Wire
    brake: Wire
    full_drive: float  # [N]
    full_brake: float  # [N]

    def apply(self, force: float, _speed: float, inputs: memoryview[float], /) -> None:
        """Fill the inputs; see :class:`Command`."""
        inputs[0] = self.throttle.to_raw(min(max(force / self.full_drive, 0.0), 1.0))
        inputs[1] = self.brake.to_raw(min(max(-force / self.full_brake, 0.0), 1.0))


@dataclass(frozen=True)
class SetpointCommand(Command):
    """The speed setpoint v + T (u - alpha v) / M, never below 0.

    A speed loop v' = (v_set - v) / T then accelerates as the controller's model does.
    """

    wire: Wire
    mass: float  # M [kg]
    friction: float  # alpha [N.s/m]
    lead: float  # T [s]

    def apply(self, force: float, speed: float, inputs: memoryview[float], /) -> None:
        """Fill the inputs; see :class:`Command`."""
        acceleration = (force - self.friction * speed) / self.mass
        inputs[0] = self.wire.to_raw(max(0.0, speed + self.lead * acceleration))


@dataclass(frozen=True)
class HoldingCommand(Command):
    """Another command, and a brake that is held at a standstill unless the vehicle is to drive."""

    command: Command
    hold: float  # [N]

    def apply(self, force: float, speed: float, inputs: memoryview[float], /) -> None:
        """Fill the inputs; see :class:`Command`."""
        if speed < HELD and force <= 0.0:
            force = min(force, -self.hold * (1.0 - max(speed, 0.0) / HELD))
        self.command.apply(force, speed, inputs)


def make_command(profile: VehicleProfile, wires: Sequence[Wire], step_size: float) -> Command:
    """Return the inverse map for the inputs that a profile names.

    Args:
        profile: Profile of the FMU.
        wires: Wires of its inputs, in the order of :func:`fmus.profile.wiring.wire`.
        step_size: Step size of the controller [s].
    """
    inputs, M, alpha = profile.inputs, profile.inverse_map.mass, profile.inverse_map.friction
    if inputs.hold:
        own = inputs.model_copy(update={"hold": None, "block_reverse": False})
        unheld = make_command(profile.model_copy(update={"inputs": own}), wires, step_size)
        return HoldingCommand(unheld, inputs.hold)
    if inputs.force is not None:
        wire = wires[0]
        return ForceCommand(wire.scale, wire.shift, inputs.block_reverse)
    if inputs.drive_force is not None:
        return SplitForceCommand(wires[0], wires[1], inputs.block_reverse)
    if inputs.acceleration is not None:
        return AccelerationCommand(wires[0], M, alpha, inputs.block_reverse)
    if inputs.throttle is not None and inputs.brake is not None:
        full_drive, full_brake = inputs.throttle.full_force, inputs.brake.full_force
        return PedalCommand(wires[0], wires[1], full_drive, full_brake)
    assert inputs.speed_setpoint is not None  # the profile has one of the five kinds of input
    return SetpointCommand(wires[0], M, alpha, inputs.speed_setpoint.lead or step_size)
