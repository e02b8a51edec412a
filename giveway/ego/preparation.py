"""Prepares an ego before it departs: its vehicle FMU, its predictor and its safety layer."""

from contextlib import ExitStack
from math import sqrt

from controller import Actuator, Controller, SafetyParameters
from fmus import FmuError
from giveway.config import EgoRunConfig
from giveway.config.files.presets import crowd_of, expected_of
from giveway.ego.foresight.predictors import predictor_of
from giveway.ego.people_assumed import people_at_worst
from giveway.ego.recorded_ego import NoController, RecordedVehicle
from giveway.ego.vehicle import open_for
from giveway.ego.vehicle_model import actuator_of, model_margin
from giveway.ego.waiting_ego import WaitingEgo
from giveway.errors import VehicleError, retold
from giveway.run_data.tracks import EgoTrack

_MARGIN = 0.05  # least distance [m] between the front bumper and a person; docs/safety.md
_WITHIN = 2.0 * sqrt(2.0)  # largest position noise in standard deviations: two on each axis


def make_waiting_ego(
    config: EgoRunConfig,
    controller: Controller,
    time_step: float,
    stack: ExitStack,
) -> WaitingEgo:
    """Load one ego's vehicle FMU and join it with its controller.

    Args:
        config: Configuration of the ego.
        controller: Controller, which decides on the force.
        time_step: Control step of the co-simulation [s].
        stack: Exit stack that closes the FMU.

    Raises:
        VehicleError: the FMU cannot be loaded.
    """
    crowd, expected = crowd_of(config), expected_of(config)
    with retold(FmuError, VehicleError):
        vehicle, description, rests = open_for(config, time_step, stack)
    predictor = predictor_of(config, controller, time_step, expected)
    fastest = max(crowd.max_speed, expected.max_speed)
    safety = safety_parameters(config, time_step) if config.safety_layer else None
    ego = WaitingEgo(config, vehicle, description, controller, predictor, fastest, safety, rests)
    stack.callback(ego.close)
    return ego


def recorded_ego(config: EgoRunConfig, track: EgoTrack, time_step: float) -> WaitingEgo:
    """An ego that repeats its recorded drive of an earlier run.

    Args:
        config: Configuration of the ego.
        track: Recorded rows of the ego.
        time_step: Control step of the co-simulation [s].
    """
    vehicle = RecordedVehicle(track, time_step)
    fastest = crowd_of(config).max_speed
    return WaitingEgo(config, vehicle, {}, NoController(), None, fastest, None)


def safety_parameters(config: EgoRunConfig, time_step: float) -> SafetyParameters:
    """The limits that the safety layer assumes, still without the width of the ego's body.

    Args:
        config: Configuration of the ego.
        time_step: Control step of the co-simulation [s].
    """
    walking, worst = crowd_of(config), people_at_worst(config)
    return SafetyParameters(
        walking_acceleration=worst.acceleration,
        walking_speed=worst.speed,
        setting_out=worst.setting_out,
        body_radius=walking.body_radius,
        margin=_MARGIN + model_margin(config, time_step),
        position_error=_WITHIN * config.perception.position_noise,
        force_limit=config.vehicle.force_limit,
        actuator=actuator_of(config, time_step) or Actuator(),
    )
