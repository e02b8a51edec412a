"""The tables of the configuration about who drives: controllers, safety."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Literal

from giveway.config.option import Section, option
from giveway.config.reasons import BUFFER, GAP, MILLIMETRE, TYRES
from giveway.config.tables.regulation import CORRIDOR_MARGIN


class PaperPidOptions(Section):
    """Options of the paper's PID (Yang & Özgüner 2019, section 3.4, table 1), and of its gap."""

    proportional_gain: float = option(
        2400.0,
        "N.s/m",
        "K_p; the printed 300 contradicts the printed error",
        ge=0,
        le=1e6,
        because="with more, the least error is all the force there is",
    )
    integral_gain: float = option(
        10.0,
        "N/m",
        "K_i",
        ge=0,
        le=1e6,
        because="with more, the least error is all the force there is",
    )
    derivative_gain: float = option(
        100.0,
        "N.s^2/m",
        "K_d",
        ge=0,
        le=1e6,
        because="with more, the least error is all the force there is",
    )
    buffer_distance: float = option(
        10.0,
        "m",
        "d_buffer over which the reference speed rises to v_r",
        gt=0,
        le=500,
        least=0.1,
        because=BUFFER,
    )
    gap_from: Literal["bumper", "centre"] = option(
        "bumper",
        None,
        "point of the ego at which the distance to people and vehicles in front starts",
    )
    corridor_half_width: float | None = option(
        None,
        "m",
        "largest distance between the ego's path and the centre of a body that counts as in front; "
        f"by default half the ego's width plus {CORRIDOR_MARGIN:g} m",
        gt=0,
        le=20,
        least=0.1,
        because="it holds a vehicle and its lane",
    )

    def corridor(self, width: float) -> float:
        """Return the half width [m] of the corridor of an ego that is ``width`` [m] wide."""
        half = self.corridor_half_width
        return width / 2 + CORRIDOR_MARGIN if half is None else half


class PaperMpcOptions(PaperPidOptions):
    """Options of the paper's MPC (Yang & Özgüner 2019, section 3), whose fallback is its PID."""

    horizon: int = option(
        15,
        "steps",
        "prediction horizon N",
        ge=2,
        le=200,
        because="one step is no plan, and of 200 nothing is known",
    )


class TunedPidOptions(Section):
    """Options of the well-tuned PID, the fair rival (controller = "pid-tuned"); docs/pid.md."""

    profile: Literal["braking-curve", "linear"] = option(
        "braking-curve", None, "how the reference speed falls towards who is in front"
    )
    buffer_distance: float = option(
        10.0,
        "m",
        "over which the linear profile rises to v_r",
        gt=0,
        le=500,
        least=0.1,
        because=BUFFER,
    )
    deceleration: float = option(
        1.0,
        "m/s^2",
        "b of the braking curve, and of braking in comfort",
        gt=0,
        le=10,
        least=0.1,
        because=TYRES,
    )
    approach_lag: float = option(
        0.5,
        "s",
        "near d_safe the braking curve is the line (gap - d_safe)/tau",
        gt=0,
        le=10,
        least=0.01,
        because="a loop answers within a step or some seconds",
    )
    acceleration: float = option(
        3.0, "m/s^2", "of driving off", gt=0, le=10, least=0.1, because=TYRES
    )
    jerk: float = option(
        10.0,
        "m/s^3",
        "of a change of acceleration in comfort",
        gt=0,
        le=200,
        least=0.1,
        because="a brake takes between a minute and a blink to bite",
    )
    firm_deceleration: float = option(
        3.0,
        "m/s^2",
        "that keeping d_safe may take; where it is not enough, last_distance",
        ge=0,
        le=10,
        least=0.1,
        because=TYRES,
    )
    last_distance: float = option(
        2.0,
        "m",
        "it stops before this distance however hard that is",
        ge=0,
        le=100,
        least=MILLIMETRE,
        because=GAP,
    )
    bandwidth: float = option(
        2.5,
        "rad/s",
        "omega of the closed loop's poles",
        gt=0,
        le=100,
        least=0.05,
        because="a loop answers within a step or some seconds",
    )
    damping: float = option(
        0.85,
        None,
        "zeta of the closed loop's poles",
        gt=0,
        le=10,
        least=0.1,
        because="below it the loop swings, far above it creeps",
    )
    acceleration_feed_forward: bool = option(
        True, None, "M dv_ref/dt is fed forward beside alpha v_ref"
    )


class PlannerOptions(Section):
    """Options of the planning MPC (controller = "mpc"): its weights; docs/planner.md."""

    horizon: float = option(
        2.5,
        "s",
        "how far it plans; beyond, people walk on and it adapts its speed",
        ge=0.3,
        le=10,
        because="a stop takes longer than 0.3 s, and of people nothing is known after 10 s",
    )
    style: Literal["careful", "normal", "assertive"] = option(
        "normal",
        None,
        "careful, normal or assertive: how much delay it takes for people's sake, by two "
        "weights and a distance",
        flag="--style",
    )
    effort_weight: float = option(
        0.02,
        "s",
        "of squared accelerations in the plan",
        ge=0,
        le=100,
        because="beyond, a plan is made of that weight alone",
    )
    jerk_weight: float = option(
        0.02,
        "s^3",
        "of squared jerks in the plan",
        ge=0,
        le=100,
        because="beyond, a plan is made of that weight alone",
    )
    conflict_weight: float | None = option(
        None,
        None,
        "seconds of delay that one person-second at v_r with less than 1.5 s to a collision is "
        "worth; none: the style's, 1.6, 0.8 or 0.4",
        ge=0,
        le=1e3,
        because="beyond, a plan is made of that weight alone",
    )
    nearness_weight: float | None = option(
        None,
        None,
        "seconds of delay that a second at v_r right before somebody is worth, 0 at d_safe; none: "
        "the style's, 10, 7 or 3.5",
        ge=0,
        le=1e3,
        because="beyond, a plan is made of that weight alone",
    )
    threat_weight: float = option(
        1.5,
        None,
        "seconds of delay that a second is worth in which somebody could force an emergency stop",
        ge=0,
        le=1e3,
        because="beyond, a plan is made of that weight alone",
    )
    later_weight: float = option(
        0.8,
        None,
        "of each second that is lost beyond the horizon until people have crossed",
        ge=0,
        le=1e3,
        because="beyond, a plan is made of that weight alone",
    )
    minimum_distance: float | None = option(
        None,
        "m",
        "least distance to a person in front, at standstill; none: the style's, 0.8, 0.4 or 0.4",
        ge=0,
        le=100,
        least=MILLIMETRE,
        because=GAP,
    )
    deceleration: float = option(
        6.0,
        "m/s^2",
        "of a stop before where the way ends",
        gt=0,
        le=10,
        least=0.1,
        because=TYRES,
    )
    calm_time: float = option(
        0.5,
        "s",
        "of the plan in which nobody may be able to force an emergency stop; "
        "above v_r = 4 m/s longer by (v_r - 4 m/s)/(3 m/s²), and braked for with 3 m/s² at most",
        ge=0,
        le=10,
        because="no plan is longer",
    )


class SafetyConfig(Section):
    """The safety layer below every controller: a stop stays possible; docs/safety.md."""

    enabled: bool | None = option(
        None,
        None,
        "brakes where the controller would not; none: yes, but not for the paper's controllers",
        flag="--safety",
    )
    people: Literal["worst-case", "recorded-99.9", "responsible"] = option(
        "recorded-99.9",
        None,
        "what it takes them to do at worst: worst-case, all that the simulated ones can; "
        "recorded-99.9, 3 m/s^2, which real people near cars exceed once in 1,000 instants; "
        "responsible, 2.2 m/s^2, once in 100; on a sidewalk these two: 0.6 m/s^2 towards the road",
        flag="--safety-people",
    )


class NoOptions(Section):
    """Options of a controller that has none."""


OWN_OPTIONS: Mapping[str, type[Section]] = MappingProxyType(
    {
        "mpc": PlannerOptions,
        "pid-tuned": TunedPidOptions,
        "mpc-paper": PaperMpcOptions,
        "pid-paper": PaperPidOptions,
    }
)
"""Options of each of giveway's controllers by its public name, in [controller_options]."""
