"""The tables of the configuration about controllers and the safety layer."""

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
        "Gain K_p. The printed 300 contradicts the printed error",
        ge=0,
        le=1e6,
        because="with a larger gain, the smallest error demands the whole force",
    )
    integral_gain: float = option(
        10.0,
        "N/m",
        "Gain K_i",
        ge=0,
        le=1e6,
        because="with a larger gain, the smallest error demands the whole force",
    )
    derivative_gain: float = option(
        100.0,
        "N.s^2/m",
        "Gain K_d",
        ge=0,
        le=1e6,
        because="with a larger gain, the smallest error demands the whole force",
    )
    buffer_distance: float = option(
        10.0,
        "m",
        "Distance d_buffer over which the reference speed rises to v_r",
        gt=0,
        le=500,
        least=0.1,
        because=BUFFER,
    )
    gap_from: Literal["bumper", "centre"] = option(
        "bumper",
        None,
        "Point of the ego, bumper or centre, at which the distance to people and vehicles in front "
        "starts",
    )
    corridor_half_width: float | None = option(
        None,
        "m",
        "Largest distance between the ego's path and the centre of a body that counts as in front. "
        f"By default it is half the ego's width plus {CORRIDOR_MARGIN:g} m",
        gt=0,
        le=20,
        least=0.1,
        because="a corridor is about as wide as a vehicle or its lane",
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
        "Prediction horizon N",
        ge=2,
        le=200,
        because=("a plan has several steps", "nothing is known about people after 200"),
    )


class TunedPidOptions(Section):
    """Options of the well-tuned PID, the fair rival (controller = "pid-tuned"); docs/pid.md."""

    profile: Literal["braking-curve", "linear"] = option(
        "braking-curve",
        None,
        "Shape of the reference speed as the gap in front closes: braking-curve or linear",
    )
    buffer_distance: float = option(
        10.0,
        "m",
        "Distance over which the linear profile rises to v_r",
        gt=0,
        le=500,
        least=0.1,
        because=BUFFER,
    )
    deceleration: float = option(
        1.0,
        "m/s^2",
        "Deceleration b of the braking curve, and of braking in comfort",
        gt=0,
        le=10,
        least=0.1,
        because=TYRES,
    )
    approach_lag: float = option(
        0.5,
        "s",
        "Time tau. Near d_safe the braking curve is the line (gap - d_safe)/tau",
        gt=0,
        le=10,
        least=0.01,
        because="a loop's time constant is between a step and some seconds",
    )
    acceleration: float = option(
        3.0, "m/s^2", "Acceleration of driving off", gt=0, le=10, least=0.1, because=TYRES
    )
    jerk: float = option(
        10.0,
        "m/s^3",
        "Jerk of a change of acceleration in comfort",
        gt=0,
        le=200,
        least=0.1,
        because="a brake needs between an instant and a minute to build up its force",
    )
    firm_deceleration: float = option(
        3.0,
        "m/s^2",
        "Largest deceleration that keeps d_safe. Where it is not enough, last_distance is kept",
        ge=0,
        le=10,
        least=0.1,
        because=TYRES,
    )
    last_distance: float = option(
        2.0,
        "m",
        "Distance that is kept to people in front however hard the braking is",
        ge=0,
        le=100,
        least=MILLIMETRE,
        because=GAP,
    )
    bandwidth: float = option(
        2.5,
        "rad/s",
        "Bandwidth omega of the closed loop's poles",
        gt=0,
        le=100,
        least=0.05,
        because="a loop's time constant is between a step and some seconds",
    )
    damping: float = option(
        0.85,
        None,
        "Damping zeta of the closed loop's poles",
        gt=0,
        le=10,
        least=0.1,
        because=("a loop with less damping oscillates", "one with more creeps"),
    )
    acceleration_feed_forward: bool = option(
        True, None, "The force M dv_ref/dt is fed forward beside alpha v_ref"
    )


class PlannerOptions(Section):
    """Options of the planning MPC (controller = "mpc"): its weights; docs/planner.md."""

    horizon: float = option(
        2.5,
        "s",
        "Prediction horizon. Beyond it people walk on and the ego adapts its speed",
        ge=0.3,
        le=10,
        because=("a stop takes longer", "nothing is known about people after 10 s"),
    )
    style: Literal["careful", "normal", "assertive"] = option(
        "normal",
        None,
        "Driving style, careful, normal or assertive: how much delay the ego accepts for people's "
        "sake. It sets precaution_weight",
        flag="--style",
    )
    effort_weight: float = option(
        0.02,
        "s",
        "Weight of squared accelerations in the plan",
        ge=0,
        le=100,
        because="with a larger weight, a plan depends on this term alone",
    )
    jerk_weight: float = option(
        0.02,
        "s^3",
        "Weight of squared jerks in the plan",
        ge=0,
        le=100,
        because="with a larger weight, a plan depends on this term alone",
    )
    precaution_weight: float | None = option(
        None,
        None,
        "Weight of precaution: seconds of delay for one second at v_r where a person is so near "
        "that drivers would stand. By default the style sets it: 60, 30 or 12",
        ge=0,
        le=1e3,
        because="with a larger weight, a plan depends on this term alone",
    )
    threat_weight: float = option(
        1.5,
        None,
        "Weight of threats: seconds of delay for one second in which a person could force an "
        "emergency stop",
        ge=0,
        le=1e3,
        because="with a larger weight, a plan depends on this term alone",
    )
    later_weight: float = option(
        0.8,
        None,
        "Weight of each second that is lost beyond the horizon until people have crossed",
        ge=0,
        le=1e3,
        because="with a larger weight, a plan depends on this term alone",
    )
    minimum_distance: float = option(
        1.3,
        "m",
        "Least distance to the middle of a person in front, at standstill",
        ge=0,
        le=100,
        least=MILLIMETRE,
        because=GAP,
    )
    deceleration: float = option(
        6.0,
        "m/s^2",
        "Largest deceleration of a stop that a manoeuvre keeps possible before the end of the way",
        gt=0,
        le=10,
        least=0.1,
        because=TYRES,
    )
    calm_time: float = option(
        0.5,
        "s",
        "Duration of the first part of a plan in which no person may be able to force an "
        "emergency stop. Above v_r = 4 m/s it is longer by (v_r - 4 m/s)/(3 m/s²), and the plan "
        "brakes for it with 3 m/s² at most",
        ge=0,
        le=10,
        because="no plan is longer",
    )


class SafetyConfig(Section):
    """The safety layer below every controller: a stop stays possible; docs/safety.md."""

    enabled: bool | None = option(
        None,
        None,
        "The safety layer brakes where the controller would not. By default it does, but not for "
        "the paper's controllers",
        flag="--safety",
    )
    people: Literal["worst-case", "recorded-99.9", "responsible"] = option(
        "recorded-99.9",
        None,
        "Assumption about people at worst. worst-case: all that the simulated ones can do. "
        "recorded-99.9: 3 m/s^2 and 3.3 m/s, exceeded at 0.00 % (CITR) and 0.13 % (DUT, "
        "roundabout) of recorded instants within 10 m of a vehicle. responsible: 2.2 m/s^2 and "
        "2.8 m/s, 0.03 % and 0.58 %. On a sidewalk the last two assume 0.6 m/s^2 towards the road",
        flag="--safety-people",
    )
    vehicles: bool = option(
        True,
        None,
        "The safety layer keeps a safe distance (RSS) to vehicles ahead as well, where it is on "
        "and the ego heeds [rules] following",
        flag="--safety-vehicles",
    )
    hidden_speed: float = option(
        0.3,
        "m/s",
        "Speed at which people who are not seen may come out of hiding, where a sensor tells what "
        "it does not see. By default that of who has stood there and set out half a second ago; "
        "Euro NCAP's obstructed child runs at 1.39. 0: nobody comes out",
        ge=0,
        le=10,
        least=0.01,
        because=("slower people hardly move", "nobody runs faster"),
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
