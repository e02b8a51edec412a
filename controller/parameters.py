"""The controllers' parameters: Yang & Özgüner 2019, table 1, and what the paper leaves open."""

import math
from dataclasses import dataclass

from controller.defaults import (
    BUFFER_DISTANCE,
    FORCE_LIMIT,
    FORCE_RATE_LIMIT,
    ITERATION_LIMIT,
    REFERENCE_SPEED,
    SAFE_DISTANCE,
    SPEED_MAX,
)
from controller.errors import ParameterError


def require(condition: bool, name: str, value: object, expected: str) -> None:
    """Refuse a parameter if ``condition`` does not hold.

    Raises:
        ParameterError: the parameter is refused.
    """
    if not condition:
        raise ParameterError(f"{name} = {value}: expected {expected}")


def require_positive(name: str, value: float, unit: str) -> None:
    """Refuse a number that is not finite and greater than zero."""
    require(math.isfinite(value) and value > 0.0, name, value, f"a finite number > 0 [{unit}]")


def require_not_negative(name: str, value: float, unit: str) -> None:
    """Refuse a number that is not finite and at least zero."""
    require(math.isfinite(value) and value >= 0.0, name, value, f"a finite number >= 0 [{unit}]")


@dataclass(frozen=True, slots=True)
class MpcParameters:
    """The parameters of the model predictive controller (Yang & Özgüner 2019, table 1)."""

    horizon: int = 15  # prediction horizon N [steps]
    reference_speed: float = REFERENCE_SPEED  # v_r [m/s]
    safe_distance: float = SAFE_DISTANCE  # d_safe [m]
    speed_min: float = 0.0  # v_min [m/s]
    speed_max: float = SPEED_MAX  # v_max [m/s]
    force_limit: float = FORCE_LIMIT  # u_max [N]
    force_rate_limit: float = FORCE_RATE_LIMIT  # du_max [N per step]
    speed_weight: float = 1.0  # weight Q = speed_weight * I of speed errors
    iteration_limit: int = ITERATION_LIMIT  # largest number of iterations of the QP solver
    position_tolerance: float = 1e-6  # largest accepted violation [m] of position constraints
    speed_tolerance: float = 1e-6  # largest accepted violation [m/s] of speed constraints
    force_tolerance: float = 1e-2  # largest accepted violation [N] of force constraints

    def __post_init__(self) -> None:
        whole = isinstance(self.horizon, int)
        require(whole and self.horizon >= 2, "horizon", self.horizon, "a whole number >= 2 [steps]")
        require_positive("reference_speed", self.reference_speed, "m/s")
        require_not_negative("safe_distance", self.safe_distance, "m")
        require_not_negative("speed_min", self.speed_min, "m/s")
        require(
            math.isfinite(self.speed_max) and self.speed_max > self.speed_min,
            "speed_max",
            self.speed_max,
            f"a finite number > speed_min = {self.speed_min} [m/s]",
        )
        require_positive("force_limit", self.force_limit, "N")
        require_positive("force_rate_limit", self.force_rate_limit, "N per step")
        require_positive("speed_weight", self.speed_weight, "-")
        whole = isinstance(self.iteration_limit, int)
        require(
            whole and self.iteration_limit >= 1,
            "iteration_limit",
            self.iteration_limit,
            "a whole number >= 1",
        )
        require_positive("position_tolerance", self.position_tolerance, "m")
        require_positive("speed_tolerance", self.speed_tolerance, "m/s")
        require_positive("force_tolerance", self.force_tolerance, "N")


@dataclass(frozen=True, slots=True)
class PidParameters:
    """The parameters of the PID controller (Yang & Özgüner 2019, section 3.4 and table 1).

    The default K_p = 2400 differs from the printed value of 300. The paper's "steady-state error of
    about 0.16 m/s at 4 m/s", alpha v_r / (K_p + alpha), needs 2400. ``PRINTED_PID`` has the printed
    value.
    """

    K_p: float = 2400.0  # proportional gain [N s/m]
    K_i: float = 10.0  # integral gain [N/m]
    K_d: float = 100.0  # derivative gain [N s^2/m]
    reference_speed: float = REFERENCE_SPEED  # v_r [m/s]
    safe_distance: float = SAFE_DISTANCE  # d_safe [m]
    buffer_distance: float = BUFFER_DISTANCE  # d_buffer [m]
    force_limit: float = FORCE_LIMIT  # u_max [N]

    def __post_init__(self) -> None:
        require_not_negative("K_p", self.K_p, "N s/m")
        require_not_negative("K_i", self.K_i, "N/m")
        require_not_negative("K_d", self.K_d, "N s^2/m")
        require_positive("reference_speed", self.reference_speed, "m/s")
        require_not_negative("safe_distance", self.safe_distance, "m")
        require_positive("buffer_distance", self.buffer_distance, "m")
        require_positive("force_limit", self.force_limit, "N")


PRINTED_PID = PidParameters(K_p=300.0)
