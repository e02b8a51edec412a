"""The worst motion of people that the safety layer assumes, by the name in ``[safety] people``."""

from controller import WorstMotion, worst_motion
from giveway.config import EgoRunConfig
from giveway.config.files.presets import crowd_of
from pedestrian_model import HELD


def people_at_worst(config: EgoRunConfig) -> WorstMotion:
    """Return the worst motion of people that a safety layer assumes.

    Args:
        config: Configuration of the ego.

    Raises:
        ConfigError: the preset cannot be used.
    """
    walking = crowd_of(config)
    # walls and closed signals hold people by more than their own acceleration
    limits = WorstMotion(max(walking.max_acceleration, HELD), walking.max_speed)
    return worst_motion(config.safety.people, limits)
