"""The model that moves a run's people, from the configuration."""

from giveway.config import RunConfig
from giveway.config.presets import parameters_of
from pedestrian_model import CrowdModel, PedestrianModel, PlainModel


def model_of(config: RunConfig, time_step: float, *, threads: int = 1) -> PedestrianModel:
    """What moves the crowd of a run.

    Args:
        config: the run's.
        time_step: of the co-simulation [s].
        threads: that step a large crowd by VCI.

    Raises:
        ConfigError: the preset cannot be used.
    """
    crowd = config.crowd
    parameters = parameters_of(crowd.preset)
    if crowd.model != "vci":
        return PlainModel(crowd.model, parameters, time_step)
    return CrowdModel(
        parameters, time_step, detour=crowd.detour, creep=crowd.creep, threads=threads
    )
