"""The numbers of the planning MPC; docs/controllers.md says what each one gives."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, Literal, NamedTuple, Self

from controller.defaults import (
    FORCE_LIMIT,
    FORCE_RATE_LIMIT,
    ITERATION_LIMIT,
    REFERENCE_SPEED,
    SAFE_DISTANCE,
    SPEED_MAX,
)
from controller.parameters import require, require_not_negative, require_positive


@dataclass(frozen=True, slots=True)
class ManoeuvreParameters:
    """The bounds and costs of manoeuvres; each cost is per second of the horizon.

    Raises:
        ParameterError: a value is not finite or out of range.
    """

    accelerations: tuple[float, ...] = (2.5, 0.0, -1.5, -2.5, -2.5, -2.5, -5.0)  # [m/s^2] aimed at
    slowest: tuple[float, ...] = (0.0, 0.0, 0.6, 0.35, 0.175, 0.0, 0.0)  # of v_r: braking ends
    jerk: float = 8.0  # [m/s^3] with which they are approached
    deceleration: float = 6.0  # b [m/s^2]: a stop is kept possible that is no harder
    minimum_distance: float = 0.4  # [m] to a person in front at standstill
    headway: float = 0.1  # [s] more of it the faster
    time_weight: float = 1.0  # of the share of the reference speed that is not driven
    acceleration_weight: float = 0.05  # of (m/s^2)^2
    nearness_weight: float = 7.0  # of the share of d_safe that is missing, times v / v_r
    closeness_weight: float = 100.0  # of a metre too little to stop in, times v / v_r
    conflict_weight: float = 0.8  # of a person on a collision course, times sqrt(v / v_r)
    conflict_growth: float = 0.5  # of that weight which each further such person counts
    threat_weight: float = 1.5  # of the speed beyond the calm one, over v_r
    final_weight: float = 1.3  # [s] of the missing speed at the horizon's end
    later_weight: float = 0.8  # of the time that is lost beyond it
    persistence: float = 0.02  # [s] that another manoeuvre must be better than the last plan
    calm_time: float = 0.5  # [s] of the plan in which the calm speed is kept to

    def __post_init__(self) -> None:
        known = all(math.isfinite(a) for a in self.accelerations)
        drives_off = bool(self.accelerations) and self.accelerations[0] > 0.0
        require(
            known and drives_off,
            "accelerations",
            self.accelerations,
            "finite numbers [m/s^2], the first of them > 0",
        )
        matching = len(self.slowest) == len(self.accelerations)
        require(matching, "slowest", self.slowest, "a share of v_r for each acceleration")
        require_positive("jerk", self.jerk, "m/s^3")
        require_positive("deceleration", self.deceleration, "m/s^2")
        require_not_negative("minimum_distance", self.minimum_distance, "m")
        require_not_negative("headway", self.headway, "s")
        for name in _WEIGHTS:
            require_not_negative(name, getattr(self, name), "-")
        require_not_negative("calm_time", self.calm_time, "s")


_SLOW = 4.0  # [m/s] v_r of Yang & Özgüner 2019
_GENTLE = 3.0  # [m/s^2] that passengers put up with

_WEIGHTS = (
    "time_weight",
    "acceleration_weight",
    "nearness_weight",
    "closeness_weight",
    "conflict_weight",
    "conflict_growth",
    "threat_weight",
    "final_weight",
    "later_weight",
    "persistence",
)


StyleName = Literal["careful", "normal", "assertive"]

#: What a driving style sets of :class:`ManoeuvreParameters`: points on the front of the ego's time
#: against risk and people's delay, found by paired runs (docs/controllers.md).
STYLES: Final[Mapping[StyleName, Mapping[str, float]]] = MappingProxyType(
    {
        "careful": {"conflict_weight": 1.6, "nearness_weight": 10.0, "minimum_distance": 0.8},
        "normal": {"conflict_weight": 0.8, "nearness_weight": 7.0, "minimum_distance": 0.4},
        "assertive": {"conflict_weight": 0.4, "nearness_weight": 3.5, "minimum_distance": 0.4},
    }
)


@dataclass(frozen=True, slots=True)
class PlannerParameters:
    """The planning MPC: horizon, limits, and what its plan trades.

    Raises:
        ParameterError: a value is not finite or out of range.
    """

    horizon: int = 50  # N [steps]
    reference_speed: float = REFERENCE_SPEED  # v_r [m/s]
    safe_distance: float = SAFE_DISTANCE  # d_safe [m]
    speed_max: float = SPEED_MAX  # v_max [m/s]
    force_limit: float = FORCE_LIMIT  # u_max [N]
    force_rate_limit: float = FORCE_RATE_LIMIT  # du_max [N per step]
    effort_weight: float = 0.02  # of (m/s^2)^2 s, beside (m/s)^2 s of the speed error
    jerk_weight: float = 0.02  # of (m/s^3)^2 s
    iteration_limit: int = ITERATION_LIMIT  # of the QP solver
    manoeuvres: ManoeuvreParameters = ManoeuvreParameters()

    def __post_init__(self) -> None:
        whole = isinstance(self.horizon, int)
        require(whole and self.horizon >= 4, "horizon", self.horizon, "a whole number >= 4 [steps]")
        require_positive("reference_speed", self.reference_speed, "m/s")
        require_not_negative("safe_distance", self.safe_distance, "m")
        require_positive("speed_max", self.speed_max, "m/s")
        require_positive("force_limit", self.force_limit, "N")
        require_positive("force_rate_limit", self.force_rate_limit, "N per step")
        require_not_negative("effort_weight", self.effort_weight, "s")
        require_not_negative("jerk_weight", self.jerk_weight, "s^3")

    @property
    def calm_time(self) -> float:
        """The time [s] in which a plan keeps to calm speeds; it grows with the reference speed."""
        return self.manoeuvres.calm_time + max(0.0, self.reference_speed - _SLOW) / _GENTLE

    @property
    def calm_braking(self) -> float:
        """The largest braking [m/s^2] of a plan for what people could do, but need not.

        At walking pace, up to v_r of the paper, as hard as it takes.
        """
        return _GENTLE if self.reference_speed > _SLOW else math.inf


class Weights(NamedTuple):
    """The numbers of the cost.

    What is called from outside gets them as a plain tuple: numba looks the class of a named one up
    in each call, which takes 2 us.
    """

    reference_speed: float
    safe_distance: float
    minimum_distance: float
    headway: float
    deceleration: float
    time: float
    acceleration: float
    nearness: float
    closeness: float
    conflict: float
    growth: float
    threat: float
    final: float
    later: float

    @classmethod
    def of(cls, p: PlannerParameters, m: ManoeuvreParameters) -> Self:
        """The weights of a planner."""
        return cls(
            p.reference_speed,
            p.safe_distance,
            m.minimum_distance,
            m.headway,
            m.deceleration,
            m.time_weight,
            m.acceleration_weight,
            m.nearness_weight,
            m.closeness_weight,
            m.conflict_weight,
            m.conflict_growth,
            m.threat_weight,
            m.final_weight,
            m.later_weight,
        )
