"""The way ahead of a body's front as the safety layer gets it."""

import numpy as np

from giveway.ego.safety_layer import MOST_POSES, fill_front_poses, spacing_of
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath


def front_poses(path: EgoPath, front: float, reach: float, length: float) -> tuple[Array, float]:
    """The poses (k, 4) x, y [m], cos, sin from the station ``front`` on, and their spacing [m].

    Args:
        path: of the front's middle, and of the rear's.
        front: station [m].
        reach: [m] ahead of it.
        length: of the body [m].
    """
    poses, spacing = np.zeros((MOST_POSES, 4)), spacing_of(reach, MOST_POSES)
    way = path.vertices, path.stations, path.headings
    return poses[: fill_front_poses(way, front, length, reach, spacing, poses)], spacing
