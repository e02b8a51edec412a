"""The controller of an ego, from the configuration."""

from __future__ import annotations

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
    SpeedController,
    TunedPid,
    TunedPidParameters,
)
from giveway.ego.vehicle import model_margin
from giveway.errors import ControlError

if TYPE_CHECKING:
    from controller import Controller
    from giveway.config import EgoRunConfig


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
