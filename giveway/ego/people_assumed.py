"""The worst motion of people that the safety layer assumes, by the name in ``[safety] people``."""

from controller import WorstMotion, worst_motion
from giveway.config import EgoRunConfig
from giveway.config.files.presets import crowd_of


def people_at_worst(config: EgoRunConfig) -> WorstMotion:
    """Return the worst motion of people that a safety layer assumes.

    Args:
        config: Configuration of the ego.

    Raises:
        ConfigError: the preset cannot be used.
    """
    walking = crowd_of(config)
    return worst_motion(
        config.safety.people, WorstMotion(walking.max_acceleration, walking.max_speed)
    )
