"""The worst motion of people that the safety layer assumes, by the name in ``[safety] people``."""

from controller import PeopleName, WorstMotion, worst_motion
from giveway.config.files.presets import parameters_of


def people_at_worst(people: PeopleName, preset: str) -> WorstMotion:
    """Return the worst motion of people that a safety layer assumes.

    Args:
        people: Name of the assumption, as in ``[safety] people``.
        preset: Preset of the walking model.

    Raises:
        ConfigError: the preset cannot be used.
    """
    walking = parameters_of(preset)
    return worst_motion(people, WorstMotion(walking.max_acceleration, walking.max_speed))
