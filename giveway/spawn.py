"""The pedestrians of a run, drawn from its seed: where each starts, goes, and how fast."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from giveway.errors import CrowdError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from giveway.config import CrowdConfig
    from giveway.ego_path import EgoPath

    Array = NDArray[np.float64]

_ATTEMPTS_PER_PERSON = 2_000  # rejection sampling up to a third of the densest packing


@dataclass(frozen=True)
class Spawned:
    """Drawn pedestrians, in the order of their ids."""

    ids: tuple[str, ...]
    position: Array  # (n, 2) [m]
    destination: Array  # (n, 2) [m]
    desired_speed: Array  # (n,) [m/s]


def spawn(config: CrowdConfig, path: EgoPath, seed: int) -> Spawned:
    """Draw ``config.pedestrians`` people, uniformly in the spawn area, none closer than allowed.

    With ``two_sided`` every second one stands on, and walks to, the mirror image about the ego's
    path at the start. The first k of a larger crowd of the same seed are not the same people:
    the spacing rule couples them.

    Raises:
        CrowdError: the area is too small for so many people at this spacing.
    """
    random = np.random.default_rng(seed)
    position = _scatter(config, random)
    desired_speed = _truncated_normal(config, random)
    destination = position + np.asarray(config.walk)
    if config.two_sided:
        position[1::2] = _mirror(position[1::2], path)
        destination[1::2] = _mirror(destination[1::2], path)
    ids = tuple(f"ped{i}" for i in range(config.pedestrians))
    return Spawned(ids, position, destination, desired_speed)


def _scatter(config: CrowdConfig, random: np.random.Generator) -> Array:
    """(n, 2) places in the spawn area, none closer to another than the minimum spacing.

    Two mirrored halves are spaced as if they stood together, which is stricter than needed.
    """
    x_min, y_min, x_max, y_max = config.spawn_area
    low, high = np.array([x_min, y_min]), np.array([x_max, y_max])
    places = np.empty((config.pedestrians, 2))
    for count in range(config.pedestrians):
        for _ in range(_ATTEMPTS_PER_PERSON):
            candidate = random.uniform(low, high)
            offsets = places[:count] - candidate
            if not (np.einsum("ij,ij->i", offsets, offsets) < config.minimum_spacing**2).any():
                places[count] = candidate
                break
        else:
            area = (x_max - x_min) * (y_max - y_min)
            msg = (
                f"--pedestrians {config.pedestrians}: only {count} fit into the spawn area of "
                f"{area:.0f} m2 at a spacing of {config.minimum_spacing} m; enlarge --spawn-area "
                "or lower the number or [crowd] minimum_spacing"
            )
            raise CrowdError(msg)
    return places


def _truncated_normal(config: CrowdConfig, random: np.random.Generator) -> Array:
    """(n,) desired speeds [m/s]: normal, redrawn until inside the bounds."""
    mean, deviation = config.desired_speed_mean, config.desired_speed_sd
    low, high = config.desired_speed_min, config.desired_speed_max
    speeds = random.normal(mean, deviation, config.pedestrians)
    while (outside := (speeds < low) | (speeds > high)).any():
        speeds[outside] = random.normal(mean, deviation, int(outside.sum()))
    return speeds


def _mirror(points: Array, path: EgoPath) -> Array:
    """The mirror image of ``points`` (n, 2) about the path's first segment."""
    origin = path.vertices[0]
    heading = path.headings[0]
    normal = np.array([-np.sin(heading), np.cos(heading)])
    return points - 2.0 * np.outer((points - origin) @ normal, normal)
