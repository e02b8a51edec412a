"""The departure time of an inserted ego: given, or drawn from the run's seed."""

import numpy as np

from giveway.config import EgoRunConfig

_STREAM = 0xDE9  # Random stream of this draw, different from others of the same seed


def departure_time(config: EgoRunConfig) -> float:
    """The time at which an ego is to be inserted [s].

    A drawn time is uniform between the earliest and the latest, in whole milliseconds as in SUMO.
    It depends on the run's seed and the ego's id only, so that the ego departs at the same instant
    with every controller.

    Args:
        config: Configuration of the ego.
    """
    times = config.ego.depart_time
    if isinstance(times, float):
        return times
    random = np.random.default_rng((config.seed, _STREAM, *config.ego_id.encode()))
    return round(float(random.uniform(*times)), 3)
