"""What the safety layer takes people to be able to do, by the name in ``[safety] people``."""

from controller import PeopleName, WorstMotion, worst_motion
from giveway.config.files.presets import parameters_of


def people_at_worst(people: PeopleName, preset: str) -> WorstMotion:
    """What a safety layer takes people to be able to do.

    Args:
        people: as in ``[safety] people``.
        preset: that they walk by.

    Raises:
        ConfigError: the preset cannot be used.
    """
    walking = parameters_of(preset)
    return worst_motion(people, WorstMotion(walking.max_acceleration, walking.max_speed))
