"""A vehicle profile: the roles, units and limits of an FMU's variables.

The same tables are a TOML file (``car.toml``), the draft that ``giveway fmu inspect`` prints, and
the argument of :class:`fmus.VehicleFmu`. Whatever stands in a file is checked here; whether it
fits an FMU is checked by :mod:`fmus.profile.wiring`.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Final

from pydantic import Field, field_validator, model_validator

from fmus.profile.tables import Axis, Parameters, Stepping, read_tables, validated
from fmus.strict_table import StrictTable

TOGETHER: Final = 1e-6  # largest error of a sum of shares


class VehicleAxis(Axis):
    """A quantity of the vehicle, which one variable has, or several, such as those of the wheels.

    SI = gain * radius * (factor * raw + unit_offset) + offset; for a torque, with 1 / radius.
    """

    variable: str = Field("", min_length=1)
    # variables or elements, or an array for all of its elements; they all have the same unit
    variables: tuple[Annotated[str, Field(min_length=1)], ...] = Field((), max_length=100)
    # share of a force for each variable, or None for equal ones; other inputs get it whole
    share: tuple[Annotated[float, Field(ge=0, le=1)], ...] | None = None
    # [m] radius of the wheels, for torques, angles and their derivatives
    radius: float | None = Field(None, gt=0.01, le=10)

    @model_validator(mode="after")
    def _named_once(self) -> VehicleAxis:
        if bool(self.variable) == bool(self.variables):
            raise ValueError('expected variable = "..." or variables = ["...", "..."]')
        if self.share is not None and not self.variables:
            raise ValueError('share without variables: add variables = ["...", "..."]')
        if self.share is not None and abs(sum(self.share) - 1.0) > TOGETHER:
            raise ValueError(f"share: the sum is {sum(self.share):g}; expected 1 (see `gain`)")
        return self

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the variables."""
        return self.variables or (self.variable,)


class Pedal(VehicleAxis):
    """A throttle or brake: 0 is released, 1 is fully pressed (per cent where its unit says so)."""

    full_force: float = Field(gt=0, le=1e7)  # [N] force at the wheels when fully pressed


class SpeedSetpoint(VehicleAxis):
    """The speed that the FMU's own controller is to drive at."""

    # [s] time constant of the FMU's speed controller, or None for one step
    lead: float | None = Field(None, gt=0, le=60)


class Inputs(StrictTable):
    """The inputs that drive the FMU.

    One of these is given: force, drive_force and brake_force, acceleration, throttle and brake,
    speed_setpoint.
    """

    force: VehicleAxis | None = None  # [N] forwards positive
    drive_force: VehicleAxis | None = None  # [N] never negative
    brake_force: VehicleAxis | None = None  # [N] never negative
    acceleration: VehicleAxis | None = None  # [m/s2] commanded acceleration
    throttle: Pedal | None = None
    brake: Pedal | None = None
    speed_setpoint: SpeedSetpoint | None = None  # [m/s] speed to drive at
    # [rad] grade of the road, uphill positive, or its tangent, as % or 1
    grade: VehicleAxis | None = None
    # True: at a standstill, no braking force or acceleration is passed on
    block_reverse: bool = True
    # [N] brake force at a standstill unless the vehicle is to drive; None: a run finds it
    hold: float | None = Field(None, ge=0, le=1e7)

    @model_validator(mode="after")
    def _one_way(self) -> Inputs:
        ways = [
            name
            for name, present in (
                ("force", self.force),
                ("drive_force and brake_force", self.drive_force or self.brake_force),
                ("acceleration", self.acceleration),
                ("throttle and brake", self.throttle or self.brake),
                ("speed_setpoint", self.speed_setpoint),
            )
            if present
        ]
        if len(ways) != 1:
            expected = (
                "one of force; drive_force and brake_force; acceleration; throttle and brake; "
                "speed_setpoint"
            )
            raise ValueError(f"{'; '.join(ways) or 'no input'}: expected {expected}")
        for one, other in (("drive_force", "brake_force"), ("throttle", "brake")):
            for present, missing in ((one, other), (other, one)):
                if getattr(self, present) is not None and getattr(self, missing) is None:
                    raise ValueError(f"{present} without {missing}: add [inputs.{missing}]")
        return self


class Outputs(StrictTable):
    """The outputs that are read; without a position the speed is integrated (trapezoid rule)."""

    speed: VehicleAxis  # [m/s]
    position: VehicleAxis | None = None  # [m] position along the path
    # [m/s2], or None for the speed's difference over a step
    acceleration: VehicleAxis | None = None


class Initial(StrictTable):
    """The variables that set the FMU's first position and speed."""

    speed: VehicleAxis | None = None  # [m/s] parameter, or input with a start value
    position: VehicleAxis | None = None  # [m], or None: positions count from where the FMU starts
    run_up: bool = True  # True: without a parameter for the speed, drive up to it before the start


class Fmu(Stepping):
    """The settings for stepping a vehicle's FMU."""

    self_check: bool = True  # True: compare one step with two half steps before the run


class Limits(StrictTable):
    """The limits that no car exceeds. Beyond them the FMU is at fault and the run ends."""

    speed: float = Field(100.0, gt=0, le=1e9)  # [m/s] largest absolute value
    # [m] largest difference between position and integrated speed
    position_jump: float = Field(1.0, gt=0, le=1e9)
    # [m/s2] largest mean acceleration or deceleration over a step; 0.3 times as much is a warning
    acceleration: float = Field(50.0, gt=0, le=1e12)
    # [s] time without any change while driven, after which a warning is given
    frozen_time: float = Field(2.0, gt=0, le=1e6)


class InverseMap(StrictTable):
    """M and alpha with which a force becomes an acceleration or a speed; not for force inputs."""

    mass: float = Field(1000.0, gt=0, le=1e6)  # [kg]
    friction: float = Field(100.0, ge=0, le=1e6)  # [N.s/m]


class SideModel(StrictTable):
    """The answer of a vehicle to forces of one sign: driving, or braking."""

    mass: float = Field(gt=0, le=1e6)  # M [kg]
    lag: float = Field(0.0, ge=0, le=3)  # [s] first-order time constant of the actuator
    delay: float = Field(0.0, ge=0, le=2)  # [s] dead time
    # [m/s2] largest force over M, at low speed for driving; None if no limit was seen
    limit: float | None = Field(None, gt=0, le=1e3)
    # [m/s] speed above which the power is constant: limit * power_from / v; None if none was seen
    power_from: float | None = Field(None, gt=0, le=200)
    # [m/s3] largest change of force over M; None if none was seen
    rate: float | None = Field(None, gt=0, le=1e4)


class FittedModel(StrictTable):
    """M v' + alpha v = u as identified, for the MPC, and how well it fits."""

    mass: float = Field(gt=0, le=1e6)  # M [kg]
    friction: float = Field(ge=0, le=1e6)  # alpha [N.s/m]
    lag: float = Field(0.0, ge=0, le=3)  # [s] first-order time constant of the actuator
    # [s] dead time; a vehicle with a longer one cannot be driven
    delay: float = Field(0.0, ge=0, le=2)
    # [s] first-order lag of the speed output behind the motion
    sensor_lag: float = Field(0.0, ge=0, le=3)
    r_squared: float = Field(le=1)  # share of the variation of speed changes that is explained
    speed_error: float = Field(ge=0)  # [m/s] root mean square, one step ahead
    # [m] value that 95 % of the errors at the horizon do not exceed
    position_error: float = Field(ge=0, le=1e4)
    horizon: float = Field(ge=1e-3, le=1e3)  # [s] horizon of position_error
    time_step: float = Field(gt=0)  # [s] time step of the fit
    # [m] position_error of the prediction by `drive` and `brake`, or None if it is not known
    sides_error: float | None = Field(None, ge=0, le=1e4)
    drive: SideModel | None = None  # model for driving forces, or None if it is not known
    brake: SideModel | None = None  # model for braking forces, or None if it is not known

    @model_validator(mode="after")
    def _power_is_of_driving(self) -> FittedModel:
        for side, other in (("drive", self.drive), ("brake", self.brake)):
            if other is None or other.power_from is None:
                continue
            if side == "brake":
                raise ValueError("brake.power_from: brakes have no limit of power; leave it out")
            if other.limit is None:
                raise ValueError("drive.power_from without drive.limit: add `limit` [m/s2]")
        return self

    def later(self, delay: float) -> FittedModel:
        """Return the model of the vehicle that gets each force later by ``delay`` [s]."""
        sides = {"drive": self.drive, "brake": self.brake}
        later: dict[str, object] = {
            name: side.model_copy(update={"delay": max(side.delay + delay, 0.0)})
            for name, side in sides.items()
            if side is not None
        }
        return self.model_copy(update={"delay": max(self.delay + delay, 0.0), **later})


class VehicleProfile(StrictTable):
    """The settings that giveway needs to drive a foreign FMU."""

    record: tuple[str, ...] = Field((), max_length=100)  # variables whose values the rows keep
    fmu: Fmu = Fmu()
    inputs: Inputs
    outputs: Outputs
    initial: Initial = Initial()
    parameters: Parameters = Field(default_factory=dict)
    limits: Limits = Limits()
    inverse_map: InverseMap = InverseMap()
    model: FittedModel | None = None
    # settings of the parts of a vehicle of several FMUs, by the part's name
    parts: dict[str, Stepping] = Field(default_factory=dict)

    @field_validator("record")
    @classmethod
    def _each_once(cls, names: tuple[str, ...]) -> tuple[str, ...]:
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"record: '{name}' is given twice; keep one")
        return names


def read_profile(path: Path) -> VehicleProfile:
    """Read the vehicle profile in a TOML file.

    Raises:
        FmuProfileError: the file is missing, not TOML, or a key or value cannot be used.
    """
    draft = "'giveway fmu inspect FMU' prints a draft of a profile"
    return make_profile(read_tables(path, "a vehicle profile", draft), str(path))


def make_profile(values: dict[str, Any], origin: str) -> VehicleProfile:
    """Return the vehicle profile in nested dictionaries.

    Args:
        values: Values with the keys of the TOML file.
        origin: Name of the source in errors.

    Raises:
        FmuProfileError: a key or value cannot be used.
    """
    return validated(VehicleProfile, values, origin, "docs/vehicles.md")
