"""Makes the predictor of the crowd for an ego: the pedestrian model that its controller uses."""

from controller import Controller
from giveway.config import EgoRunConfig
from giveway.crowd.models import believed_model
from giveway.ego.foresight.crowd_foresight import plan_predictor, steps_at_once
from pedestrian_model import (
    JUPEDSIM_MODELS,
    CrowdPredictor,
    Predictor,
    StepwisePredictor,
    VciParameters,
    unmoved,
)
from pedestrian_model.drift.predictor import DriftPredictor


def predictor_of(
    config: EgoRunConfig, controller: Controller, time_step: float, parameters: VciParameters
) -> CrowdPredictor | None:
    """Return the predictor for a controller, or None if the controller does not look ahead.

    VCI is compiled into the planner's search over manoeuvres. So is constant velocity, as VCI
    without forces. Any other model is asked step by step.

    Args:
        config: Configuration of the ego.
        controller: Controller of the ego.
        time_step: Time step of the co-simulation [s].
        parameters: Bodies and limits that the prediction assumes of people.

    Raises:
        ConfigError: an option of another package's model cannot be used.
        ControlError: another package's model is not installed.
        CrowdError: the model cannot be made.
    """
    horizon, believed = controller.horizon, config.perception.model
    if not horizon:
        return None
    if believed == "drift":
        every = steps_at_once(time_step, horizon) if controller.foresees else 1
        step, bodies = every * time_step, unmoved(parameters)
        return DriftPredictor(bodies, step, horizon // every, interval=time_step)
    if believed in {"vci", "constant-velocity"}:
        readings = dict(config.vci_options)
        if believed != "vci":
            parameters, readings["detour"] = unmoved(parameters), False
        make = plan_predictor if controller.foresees else Predictor
        return make(parameters, time_step, horizon, **readings)
    # Giveway's models divide a longer step themselves. Others are asked at their own step.
    hosted = config.perception.plugged_in or believed in JUPEDSIM_MODELS
    own = hosted or not controller.foresees
    every = 1 if own else steps_at_once(time_step, horizon)
    return StepwisePredictor(
        believed_model(config, every * time_step, parameters), horizon // every
    )
