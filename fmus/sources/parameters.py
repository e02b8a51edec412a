"""The start values of an exported controller, and how they reach its binary."""

import dataclasses
import math
import struct
from base64 import urlsafe_b64encode
from dataclasses import dataclass, field
from typing import Any, Final

from fmus.errors import FmuVariableError
from fmus.profile.bundled import FmiVersion

CONTROLLER: Final = "LongitudinalController"
CONTROLLER_FILES: Final[dict[FmiVersion, str]] = {
    "2.0": f"{CONTROLLER}.fmi2.fmu",
    "3.0": f"{CONTROLLER}.fmi3.fmu",
}
HORIZON_MAX: Final = 200  # [steps] HORIZON_MAX of parameters.h
FAR_AWAY: Final = 1e9  # Value [m] or [m/s] for "nobody in front" or "no limit", as in instance.c


def _parameter(default: float, symbol: str, unit: str | None, description: str) -> Any:
    metadata = {"symbol": symbol, "unit": unit, "description": description}
    return field(default=default, metadata=metadata)


@dataclass(frozen=True, slots=True)
class ControllerParameters:
    """The start values of an exported controller (Yang & Özgüner 2019, table 1).

    The order is that of ``Parameters`` in parameters.h. K_p is not the printed 300, because that
    contradicts the paper's own steady-state error.

    Raises:
        FmuVariableError: a value is out of range.
    """

    mass: float = _parameter(1000.0, "M", "kg", "Mass of the vehicle as the MPC sees it")
    friction: float = _parameter(100.0, "alpha", "N.s/m", "Its viscous friction coefficient")
    time_step: float = _parameter(0.05, "dt", "s", "Time between two decisions")
    reference_speed: float = _parameter(4.0, "v_r", "m/s", "Desired speed")
    safe_distance: float = _parameter(8.0, "d_safe", "m", "Distance to keep to the obstacle")
    margin: float = _parameter(
        0.0, "d_margin", "m", "Added to d_safe in plans: how far the vehicle may miss the model"
    )
    buffer_distance: float = _parameter(
        10.0, "d_buffer", "m", "Distance over which the PID's reference speed rises to v_r"
    )
    speed_min: float = _parameter(0.0, "v_min", "m/s", "Lowest speed of a plan")
    speed_max: float = _parameter(20.0, "v_max", "m/s", "Highest speed of a plan")
    force_limit: float = _parameter(8000.0, "u_max", "N", "Largest force, either way")
    force_rate_limit: float = _parameter(
        1000.0, "du_max", "N", "Largest change of a plan's force from one step to the next"
    )
    proportional_gain: float = _parameter(2400.0, "K_p", "N.s/m", "Proportional gain of the PID")
    integral_gain: float = _parameter(10.0, "K_i", "N/m", "Integral gain of the PID")
    derivative_gain: float = _parameter(100.0, "K_d", "N.s2/m", "Derivative gain of the PID")
    horizon: int = _parameter(15, "N", None, "Horizon of the MPC in steps of dt")
    mpc: bool = _parameter(
        True, "mpc", None, "true: the MPC, with the PID as its fallback; false: the PID alone"
    )

    def __post_init__(self) -> None:
        for entry in dataclasses.fields(self)[:REALS]:
            value = getattr(self, entry.name)
            may_be_zero = entry.metadata["symbol"] in MAY_BE_ZERO
            good = math.isfinite(value) and (value >= 0.0 if may_be_zero else value > 0.0)
            expected = f"a finite number {'>=' if may_be_zero else '>'} 0"
            _require(good, entry.name, value, f"{expected} [{entry.metadata['unit']}]")
        expected = f"more than speed_min = {self.speed_min:g} [m/s]"
        _require(self.speed_max > self.speed_min, "speed_max", self.speed_max, expected)
        whole = isinstance(self.horizon, int) and 2 <= self.horizon <= HORIZON_MAX
        _require(whole, "horizon", self.horizon, f"a whole number from 2 to {HORIZON_MAX} [steps]")
        lost = self.friction * self.time_step / self.mass
        expected = "at most 1, or forward Euler is unstable; lower friction or time_step"
        _require(lost <= 1.0 or not self.mpc, "friction * time_step / mass", lost, expected)


REALS: Final = 14  # parameters before the horizon
MAY_BE_ZERO: Final = frozenset({"alpha", "d_safe", "d_margin", "v_min", "K_p", "K_i", "K_d"})


def _require(good: bool, name: str, value: object, expected: str) -> None:
    if not good:
        raise FmuVariableError(f"controller FMU: {name} = {value}: expected {expected}")


def token_of(build: str, parameters: ControllerParameters) -> str:
    """Return the GUID or instantiation token of an export.

    The binaries are the same for all exports, and of the model description a host passes only this
    text to them. Therefore it contains, bit by bit, the start values that differ from the paper's.
    It stays below 255 characters, because some hosts name a folder after it.
    """
    entries = ""
    paper = dataclasses.astuple(ControllerParameters())
    for number, value in enumerate(dataclasses.astuple(parameters)):
        if value != paper[number]:
            digits = urlsafe_b64encode(struct.pack(">d", float(value))).decode().rstrip("=")
            entries += chr(ord("a") + number) + digits
    return build + entries
