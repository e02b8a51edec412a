"""What a waiting ego will foresee the crowd with, made of its options."""

from giveway.ego.foresight.contingency import load
from giveway.ego.foresight.crowd_foresight import CrowdForesight
from giveway.ego.foresight.intent import Beliefs
from giveway.ego.waiting_ego import WaitingEgo
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import EgoPath
from pedestrian_model import Predictor


def foresight_of(
    waiting: WaitingEgo, path: EgoPath, shape: VehicleShape, half_width: float, time_step: float
) -> CrowdForesight | None:
    """What answers a planning controller how pedestrians would react; None: nobody asks.

    Args:
        waiting: the ego before its departure.
        path: of it.
        shape: of its body.
        half_width: of its corridor [m].
        time_step: [s] of the control.
    """
    config, predictor = waiting.config, waiting.predictor
    if not waiting.controller.foresees or predictor is None:
        return None
    beliefs = None
    if config.perception.model == "vci":
        assert isinstance(predictor, Predictor)
        load()
        beliefs = Beliefs(path, half_width, predictor, time_step)
    return CrowdForesight(
        predictor,
        path,
        shape,
        horizon=waiting.horizon,
        time_step=time_step,
        half_width=half_width,
        clearance=waiting.clearance,
        braking=config.vehicle.acceleration_limit,
        worst=None if waiting.safety is None else waiting.safety.worst,
        beliefs=beliefs,
    )
