"""The parameters of the planning MPC; docs/controllers.md says what each one does."""

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
from controller.driving_constants import AT_REST, CREEPS_NEARER, FIRM
from controller.parameters import require, require_not_negative, require_positive


@dataclass(frozen=True, slots=True)
class ManoeuvreParameters:
    """The bounds and weights of manoeuvres. Each cost is per second of the horizon.

    Raises:
        ParameterError: a value is not finite or out of range.
    """

    # accelerations [m/s^2] that the manoeuvres aim at
    accelerations: tuple[float, ...] = (2.5, 1.5, 1.5, 0.0, -1.5, -2.5, -2.5, -2.5, -5.0)
    # shares of v_r at which these manoeuvres end
    slowest: tuple[float, ...] = (0.0, 0.6, 0.35, 0.0, 0.6, 0.35, 0.175, 0.0, 0.0)
    jerk: float = 8.0  # jerk [m/s^3] with which accelerations change
    deceleration: float = 6.0  # deceleration b [m/s^2] with which a stop stays possible
    minimum_distance: float = AT_REST  # distance [m] to a person in front at standstill
    headway: float = 0.1  # additional distance per speed [s]
    time_weight: float = 1.0  # weight of the share of the reference speed that is lost
    acceleration_weight: float = 0.05  # weight of the squared acceleration [(m/s^2)^2]
    closeness_weight: float = 100.0  # weight of the missing stopping distance [m], times v / v_r
    threat_weight: float = 1.5  # weight of the speed above the threat-free one, over v_r
    precaution_weight: float = 30.0  # weight of the speed above the passing one, over v_r
    final_weight: float = 1.3  # weight [s] of the missing share of speed at the horizon's end
    later_weight: float = 0.8  # weight of the time that is lost beyond the horizon
    persistence: float = 0.02  # cost [s] by which another manoeuvre must beat the last plan
    calm_time: float = 0.5  # time [s] for which a plan keeps threat-free speeds

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


_WEIGHTS = (
    "time_weight",
    "acceleration_weight",
    "closeness_weight",
    "threat_weight",
    "precaution_weight",
    "final_weight",
    "later_weight",
    "persistence",
)


StyleName = Literal["careful", "normal", "assertive"]

#: Precaution weight by driving style: points on the Pareto front of the ego's time against close
#: passes and people's delay (docs/controllers.md).
STYLES: Final[Mapping[StyleName, float]] = MappingProxyType(
    {"careful": 60.0, "normal": 30.0, "assertive": 12.0}
)


@dataclass(frozen=True, slots=True)
class PlannerParameters:
    """The parameters of the planning MPC: horizon, limits and weights.

    Raises:
        ParameterError: a value is not finite or out of range.
    """

    horizon: int = 50  # prediction horizon N [steps]
    reference_speed: float = REFERENCE_SPEED  # v_r [m/s]
    safe_distance: float = SAFE_DISTANCE  # d_safe [m]
    speed_max: float = SPEED_MAX  # v_max [m/s]
    force_limit: float = FORCE_LIMIT  # u_max [N]
    force_rate_limit: float = FORCE_RATE_LIMIT  # du_max [N per step]
    effort_weight: float = 0.02  # weight of squared accelerations; speed errors have weight 1
    jerk_weight: float = 0.02  # weight of squared jerks
    iteration_limit: int = ITERATION_LIMIT  # largest number of iterations of the QP solver
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
        """The time [s] for which a plan keeps threat-free speeds; it grows with v_r."""
        return self.manoeuvres.calm_time + max(0.0, self.reference_speed - REFERENCE_SPEED) / FIRM

    @property
    def calm_braking(self) -> float:
        """The largest deceleration [m/s^2] of a plan for motions of people that are only possible.

        It is inf at low reference speeds, up to v_r of the paper.
        """
        return FIRM if self.reference_speed > REFERENCE_SPEED else math.inf


class Weights(NamedTuple):
    """The weights of the cost, and the speeds and distances that it refers to.

    Kernels that Python calls take them as a plain tuple.
    """

    reference_speed: float
    safe_distance: float
    minimum_distance: float
    headway: float
    deceleration: float
    time: float
    acceleration: float
    closeness: float
    threat: float
    precaution: float
    final: float
    later: float
    unaware: float = 0.0  # distance [m] by which people who may not see the ego count as nearer

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
            m.closeness_weight,
            m.threat_weight,
            m.precaution_weight,
            m.final_weight,
            m.later_weight,
        )

    def creeping(self) -> Self:
        """The weights of an ego that comes nearer to people in front who see it."""
        nearer = min(CREEPS_NEARER, self.minimum_distance)
        return self._replace(minimum_distance=self.minimum_distance - nearer, unaware=nearer)
