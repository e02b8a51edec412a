"""The drive that the first ego would make on a free road, which the encounter sampler uses."""

from giveway.config import RunConfig
from giveway.config.option import LANE
from giveway.config.tables.basics import DEFAULT_SPEED
from giveway.crowd.generation.encounters import FreeDrive
from giveway.geometry.path import EgoPath


def free_drive(config: RunConfig, path: EgoPath | None) -> FreeDrive | None:
    """The free drive along ``path``; None if there is no path.

    If the reference speed follows the lanes' limits, the speed at departure is used instead.

    Args:
        config: Configuration of the run, with or without egos.
        path: Path of the first ego that is inserted, or would be.
    """
    if path is None:
        return None
    own = next((ego for ego in config.each_ego() if not ego.ego.take_over), config)
    ego, wanted = own.ego, own.reference_speed
    speed = (ego.initial_speed or DEFAULT_SPEED) if wanted == LANE else float(wanted)
    distance = ego.travel_distance or path.length - ego.depart_position
    return FreeDrive(path, ego.depart_position, distance, speed)
