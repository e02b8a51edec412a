"""A vehicle profile: which variable of an FMU plays which part, in which unit, with what limits.

The same tables are a TOML file (``car.toml``), the draft that ``giveway fmu inspect`` prints, and
the argument of :class:`fmus.VehicleFmu`. Whatever stands in a file is checked here; whether it
fits an FMU is checked by :mod:`fmus.profile.wiring`.
"""

from __future__ import annotations

import tomllib
from math import isfinite
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator, model_validator

from fmus.description.model import Value  # pydantic reads it at run time
from fmus.errors import FmuProfileError
from fmus.text import printable


class Table(BaseModel):
    """A table of a profile: frozen, finite numbers only, unknown keys refused."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Axis(Table):
    """One quantity: SI = gain * (factor * raw + unit_offset) + offset.

    ``factor`` and ``unit_offset`` belong to the unit. ``variable`` may be one element of an FMI 3
    array, ``x[2]``, counted from 1.
    """

    variable: str = Field(min_length=1)
    unit: str | None = None  # where the FMU declares none, or a wrong one
    gain: float | None = None  # None: 1, and the unit must be of the right dimension
    offset: float = 0.0

    @model_validator(mode="after")
    def _invertible(self) -> Axis:
        if self.gain == 0.0:
            raise ValueError("gain = 0: expected a number that is not 0")
        return self


class Pedal(Axis):
    """A throttle or brake: 0 is released, 1 is fully pressed (per cent where its unit says so)."""

    full_force: float = Field(gt=0, le=1e7)  # [N] at the wheels, fully pressed


class SpeedSetpoint(Axis):
    """The speed that the FMU's own controller is to drive at."""

    lead: float | None = Field(None, gt=0, le=60)  # [s] the FMU's time constant; None: one step


class Inputs(Table):
    """How the FMU is driven; one of: force, drive_force and brake_force, acceleration, throttle and
    brake, speed_setpoint.
    """  # noqa: D205 - one sentence

    force: Axis | None = None  # [N] forwards positive
    drive_force: Axis | None = None  # [N] never negative
    brake_force: Axis | None = None  # [N] never negative
    acceleration: Axis | None = None  # [m/s2] wanted
    throttle: Pedal | None = None
    brake: Pedal | None = None
    speed_setpoint: SpeedSetpoint | None = None  # [m/s]
    block_reverse: bool = True  # at a standstill no braking force or acceleration is passed on

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


class Outputs(Table):
    """The outputs that are read; without a position the speed is integrated (trapezoid rule)."""

    speed: Axis  # [m/s]
    position: Axis | None = None  # [m] along the path
    acceleration: Axis | None = None  # [m/s2]; None: the speed's difference over a step


class Initial(Table):
    """The variables that set where and how fast the FMU starts."""

    speed: Axis | None = None  # [m/s] parameter or input with a start value
    position: Axis | None = None  # [m]; None: the position counts from where the FMU starts
    run_up: bool = True  # without a parameter for the speed: drive up to it before the start


class Fmu(Table):
    """How the FMU is stepped."""

    kind: Literal["co-simulation", "model-exchange"] | None = None  # None: the former if it can
    step: float | None = Field(None, gt=0, le=10)  # [s] the FMU's own; None: the control step
    stop_time: float | None = Field(None, gt=0, le=1e9)  # [s] told to the FMU; None: no stop time
    solver: Literal["cvode", "rk4"] | None = None  # of Model Exchange; None: cvode where it runs
    tolerance: float | None = Field(None, gt=0, le=0.1)  # relative, of Model Exchange
    self_check: bool = True  # compare one step with two half steps before the run
    start_timeout: float = Field(60.0, gt=0, le=3600)  # [s] wall clock
    step_timeout: float = Field(10.0, gt=0, le=3600)  # [s] wall clock


class Limits(Table):
    """Limits that no car exceeds: beyond them the FMU is at fault and the run ends."""

    speed: float = Field(100.0, gt=0, le=1e9)  # [m/s] absolute
    position_jump: float = Field(1.0, gt=0, le=1e9)  # [m] more or less than the speed accounts for
    frozen_time: float = Field(2.0, gt=0, le=1e6)  # [s] without any change while driven: a warning


class InverseMap(Table):
    """M and alpha with which a force becomes an acceleration or a speed; not for force inputs."""

    mass: float = Field(1000.0, gt=0, le=1e6)  # [kg]
    friction: float = Field(100.0, ge=0, le=1e6)  # [N.s/m]


class FittedModel(Table):
    """M v' + alpha v = u as identified, for the MPC, and how well it fits."""

    mass: float = Field(gt=0, le=1e6)  # M [kg]
    friction: float = Field(ge=0, le=1e6)  # alpha [N.s/m]
    lag: float = Field(0.0, ge=0, le=3)  # [s] first-order time constant of the actuator
    delay: float = Field(0.0, ge=0, le=2)  # [s] dead time; who answers later cannot be driven
    r_squared: float = Field(le=1)  # of the speed's change per step
    speed_error: float = Field(ge=0)  # [m/s] root mean square, one step ahead
    position_error: float = Field(ge=0, le=1e4)  # [m] 95 % of the errors at the horizon are smaller
    horizon: float = Field(ge=1e-3, le=1e3)  # [s] of position_error
    time_step: float = Field(gt=0)  # [s] of the fit


class VehicleProfile(Table):
    """Everything that giveway needs to drive a foreign FMU."""

    record: tuple[str, ...] = Field((), max_length=100)  # variables whose values the rows keep
    fmu: Fmu = Fmu()
    inputs: Inputs
    outputs: Outputs
    initial: Initial = Initial()
    parameters: dict[str, Value] = {}  # start values by variable name, in the FMU's own units
    limits: Limits = Limits()
    inverse_map: InverseMap = InverseMap()
    model: FittedModel | None = None

    @field_validator("record")
    @classmethod
    def _each_once(cls, names: tuple[str, ...]) -> tuple[str, ...]:
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"record: '{name}' stands twice; keep one")
        return names

    @field_validator("parameters", mode="before")
    @classmethod
    def _flat(cls, values: Any) -> Any:
        """An unquoted ``vehicle.mass = 1`` is a table in TOML; here it is the variable's name."""
        if not isinstance(values, dict):
            return values
        flat: dict[str, Any] = {}
        tables = [("", values)]
        while tables:
            prefix, table = tables.pop()
            for key, value in table.items():
                name = f"{prefix}{key}"
                if isinstance(value, dict):
                    tables.append((f"{name}.", value))
                elif not _is_value(value):
                    expected = "a finite number, true, false, text, or a list of finite numbers"
                    raise ValueError(f"{name} = {str(value)[:60]}: expected {expected}")
                else:
                    flat[name] = value
        return flat


def _is_value(value: object) -> bool:
    if isinstance(value, list):
        return all(_is_number(item) for item in value)
    return isinstance(value, bool | str) or _is_number(value)


def _is_number(value: object) -> bool:
    if isinstance(value, int):
        return not isinstance(value, bool) and abs(value) < 1 << 64
    return isinstance(value, float) and isfinite(value)


def read_profile(path: Path) -> VehicleProfile:
    """The profile in a TOML file.

    Raises:
        FmuProfileError: the file is missing, not TOML, or a key or value cannot be used.
    """
    try:
        values = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except FileNotFoundError:
        raise FmuProfileError(
            f"{path}: no such file; 'giveway fmu inspect FMU' prints a draft of a profile"
        ) from None
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "not UTF-8 text"
        raise FmuProfileError(
            f"{path}: cannot be read ({reason}); expected a vehicle profile (TOML)"
        ) from None
    except (ValueError, RecursionError) as error:  # not TOML's own: a number of thousands of digits
        raise FmuProfileError(f"{path}: not valid TOML: {error}; mend the line named") from None
    return make_profile(values, str(path))


def make_profile(values: dict[str, Any], origin: str) -> VehicleProfile:
    """The profile in nested dictionaries.

    Args:
        values: with the keys of the TOML file.
        origin: named in errors.

    Raises:
        FmuProfileError: a key or value cannot be used.
    """
    try:
        return VehicleProfile.model_validate(values)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        raise FmuProfileError(f"{origin}: {_explained(first)}") from None


def _explained(error: Any) -> str:
    *tables, key = (str(part) for part in error["loc"]) if error["loc"] else ("",)
    place = f"[{'.'.join(tables)}] {key}" if tables else f"[{key}]" if key else "profile"
    if error["type"] == "extra_forbidden":
        return f"{place}: unknown key; docs/vehicles.md lists the keys"
    if error["type"] == "missing":
        return f"{place}: missing; add it (docs/vehicles.md)"
    if error["type"] == "value_error":
        table = ".".join((*tables, key))
        return f"[{table}]: {error['ctx']['error']}" if table else str(error["ctx"]["error"])
    given = printable(repr(error["input"]), 60)
    return f"{place} = {given}: {str(error['msg']).removeprefix('Input ')}"
