"""Makes the foresight of an ego from its options, before it departs."""

from giveway.ego.foresight.contingency import load
from giveway.ego.foresight.crowd_foresight import CrowdForesight, EgoAssumptions
from giveway.ego.foresight.intent import IntentEstimator
from giveway.ego.waiting_ego import WaitingEgo
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import EgoPath
from pedestrian_model import Predictor


def foresight_of(
    waiting: WaitingEgo, path: EgoPath, shape: VehicleShape, half_width: float, time_step: float
) -> CrowdForesight | None:
    """Return the foresight for a planning controller, or None if no controller asks for it.

    Args:
        waiting: Ego before its departure.
        path: Path of the ego.
        shape: Shape of its body.
        half_width: Half width of its corridor [m].
        time_step: Control step [s].
    """
    config, predictor = waiting.config, waiting.predictor
    if not waiting.controller.foresees or predictor is None:
        return None
    estimator = None
    if config.perception.model == "vci":
        assert isinstance(predictor, Predictor)
        load()
        estimator = IntentEstimator(path, half_width, predictor, time_step)
    ego = EgoAssumptions(
        shape,
        half_width,
        waiting.clearance,
        config.vehicle.acceleration_limit,
        None if waiting.safety is None else waiting.safety.worst,
        0.0 if waiting.safety is None else waiting.safety.actuator.reaction_time,
    )
    return CrowdForesight(
        predictor, path, ego, horizon=waiting.horizon, time_step=time_step, estimator=estimator
    )
