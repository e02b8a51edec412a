"""Who drives an ego: its FMU, loaded, and its controller, from the configuration."""

from __future__ import annotations

from math import inf, sqrt
from typing import TYPE_CHECKING

from controller import (
    ControllerError,
    LongitudinalModel,
    ManoeuvreParameters,
    Mpc,
    MpcParameters,
    Pid,
    PidParameters,
    Planner,
    PlannerParameters,
    PlanningController,
    ReferenceParameters,
    SafetyParameters,
    SpeedController,
    TunedPid,
    TunedPidParameters,
)
from fmus import FmuError
from giveway.config.presets import parameters_of
from giveway.ego.ego import Driver
from giveway.ego.vehicle import identified_reaction_time, model_margin, open_for
from giveway.errors import ControlError, VehicleError
from pedestrian_model import Predictor

if TYPE_CHECKING:
    from contextlib import ExitStack

    from controller import Controller
    from giveway.config import EgoRunConfig


_WITHIN = 2.0 * sqrt(2.0)  # standard deviations: the noise is cut at two in x and in y


def make_controller(config: EgoRunConfig, time_step: float) -> Controller:
    """The controller of one ego.

    Args:
        config: of the ego.
        time_step: of the co-simulation [s].

    Raises:
        ControlError: its parameters contradict each other, or its solver is missing.
    """
    regulation = config.regulation
    try:
        if config.controller == "pid-tuned":
            return SpeedController(None, _tuned_pid(config, time_step))
        if config.controller == "mpc":
            return _planning(config, time_step)
        pid = Pid(
            PidParameters(
                K_p=config.pid.proportional_gain,
                K_i=config.pid.integral_gain,
                K_d=config.pid.derivative_gain,
                reference_speed=regulation.reference_speed,
                safe_distance=regulation.safe_distance,
                buffer_distance=config.pid.buffer_distance,
                force_limit=config.mpc.force_limit,
            ),
            time_step,
        )
        if not config.optimises:
            return SpeedController(None, pid)
        model = LongitudinalModel(
            mass=config.vehicle.mass,
            friction=config.vehicle.friction,
            time_step=time_step,
        )
        mpc = Mpc(
            model,
            MpcParameters(
                horizon=config.mpc.horizon,
                reference_speed=regulation.reference_speed,
                safe_distance=regulation.safe_distance + model_margin(config, time_step),
                speed_min=config.mpc.speed_min,
                speed_max=config.mpc.speed_max,
                force_limit=config.mpc.force_limit,
                force_rate_limit=config.mpc.force_rate_limit,
                solver=config.mpc.solver,
            ),
        )
    except ControllerError as error:
        raise ControlError(str(error)) from error
    return SpeedController(mpc, pid)


def _tuned_pid(config: EgoRunConfig, time_step: float) -> TunedPid:
    """The well-tuned PID, with the actuator's limits of the MPC."""
    regulation, tuned, vehicle = config.regulation, config.tuned_pid, config.vehicle
    return TunedPid(
        TunedPidParameters(
            bandwidth=tuned.bandwidth,
            damping=tuned.damping,
            acceleration_feed_forward=tuned.acceleration_feed_forward,
            force_limit=config.mpc.force_limit,
            force_rate_limit=config.mpc.force_rate_limit,
            reference=ReferenceParameters(
                reference_speed=regulation.reference_speed,
                safe_distance=regulation.safe_distance,
                profile=tuned.profile,
                buffer_distance=tuned.buffer_distance,
                deceleration=tuned.deceleration,
                approach_lag=tuned.approach_lag,
                acceleration=tuned.acceleration,
                jerk=tuned.jerk,
                firm_deceleration=tuned.firm_deceleration,
                last_distance=tuned.last_distance,
            ),
        ),
        LongitudinalModel(vehicle.mass, vehicle.friction, time_step),
    )


def _planning(config: EgoRunConfig, time_step: float) -> PlanningController:
    """The planning MPC, with the tuned PID where a hard corridor leaves it no plan."""
    regulation, planner, limits = config.regulation, config.planner, config.mpc
    margin = model_margin(config, time_step)
    parameters = PlannerParameters(
        horizon=plan_steps(config, time_step),
        reference_speed=regulation.reference_speed,
        safe_distance=regulation.safe_distance + margin,
        speed_max=limits.speed_max,
        force_limit=limits.force_limit,
        force_rate_limit=limits.force_rate_limit,
        effort_weight=planner.effort_weight,
        jerk_weight=planner.jerk_weight,
        block_growth=planner.block_growth,
        gap_choice=planner.gap_choice,
        soft=planner.soft,
        terminal=planner.terminal,
        solver=limits.solver,
        manoeuvres=ManoeuvreParameters(
            deceleration=planner.deceleration,
            minimum_distance=planner.minimum_distance + margin,
            nearness_weight=planner.nearness_weight,
            conflict_weight=planner.conflict_weight,
            threat_weight=planner.threat_weight,
            calm_time=planner.calm_time,
        ),
    )
    model = LongitudinalModel(config.vehicle.mass, config.vehicle.friction, time_step)
    return PlanningController(Planner(model, parameters), _tuned_pid(config, time_step))


def plan_steps(config: EgoRunConfig, time_step: float) -> int:
    """The planner's horizon in steps."""
    return max(4, round(config.planner.horizon / time_step))


def make_driver(
    config: EgoRunConfig,
    controller: Controller,
    time_step: float,
    stack: ExitStack,
) -> Driver:
    """One ego's FMU, loaded, with its controller.

    Args:
        config: of the ego.
        controller: decides on its force.
        time_step: of the co-simulation [s].
        stack: closes the FMU.

    Raises:
        VehicleError: the FMU cannot be loaded.
    """
    crowd = parameters_of(config.crowd.preset)
    expected = parameters_of(config.perception.preset or config.crowd.preset)
    try:
        vehicle, description = open_for(config, time_step, stack)
    except FmuError as error:
        raise VehicleError(str(error)) from error
    ahead = controller.horizon
    predictor = Predictor(expected, time_step, ahead) if ahead else None
    fastest = max(crowd.max_speed, expected.max_speed)
    safety = safety_parameters(config, time_step) if config.safety_layer else None
    return Driver(config, vehicle, description, controller, predictor, fastest, safety)


def safety_parameters(config: EgoRunConfig, time_step: float) -> SafetyParameters:
    """The limits that the safety layer counts on; the body's width is not known yet.

    Args:
        config: of the ego.
        time_step: of the co-simulation [s].
    """
    safety, people = config.safety, parameters_of(config.crowd.preset)
    reaction = safety.reaction_time
    return SafetyParameters(
        walking_acceleration=people.max_acceleration,
        walking_speed=people.max_speed,
        body_radius=people.body_radius,
        margin=safety.margin + model_margin(config, time_step),
        position_error=_WITHIN * config.perception.position_noise,
        force_limit=config.mpc.force_limit,
        force_rate_limit=config.mpc.force_rate_limit if safety.rate_limited else inf,
        reaction_time=identified_reaction_time(config) if reaction is None else reaction,
    )
