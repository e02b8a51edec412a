"""The pedestrians of a run, drawn from its seed: where each starts, goes, and how fast."""

from dataclasses import dataclass

import numpy as np

from giveway.config.crowd import ENCOUNTERS, CrowdConfig
from giveway.crowd.encounters import FreeDrive, meet
from giveway.errors import CrowdError
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath, Pose

_REDRAWS = 1_000
_ATTEMPTS_PER_PERSON = 2_000  # rejection sampling up to a third of the densest packing

PREFIX = "ped"  # of the ids of the pedestrians that giveway adds


@dataclass(frozen=True)
class Spawned:
    """Drawn pedestrians, in the order of their ids."""

    ids: tuple[str, ...]
    position: Array  # (n, 2) [m]
    destination: Array  # (n, 2) [m]
    desired_speed: Array  # (n,) [m/s]


def spawn(
    config: CrowdConfig,
    path: EgoPath | None,
    seed: int,
    prefix: str = PREFIX,
    drive: FreeDrive | None = None,
) -> Spawned:
    """Draw ``config.pedestrians`` pedestrians, none closer to another than allowed.

    They start uniform in the spawn area; with the sampler ``encounters`` so as to meet ``drive``.

    With ``two_sided`` every second one stands on, and walks to, the mirror image about the ego's
    path where it passes the spawn area. The first k of a larger crowd of the same seed are not the
    same people: the spacing rule couples them.

    Args:
        config: how many, where, where to, how fast.
        path: the ego's, for ``two_sided``; None where no ego is inserted.
        seed: of the draw.
        prefix: of their ids; a number follows.
        drive: that is met, for the sampler ``encounters``; None where no way is known.

    Raises:
        CrowdError: there is no room for so many at this spacing, or no ego about whose path to
            mirror, or whom to meet.
    """
    random = np.random.default_rng(seed)
    ids = tuple(f"{prefix}{i}" for i in range(config.pedestrians))
    if config.sampler == ENCOUNTERS:
        if drive is None:
            raise CrowdError(
                "--sampler encounters: people meet an ego on its route, and there is none; name "
                "one (--ego-route)"
            )
        return Spawned(ids, *meet(config, drive, random))
    axis = None
    if config.two_sided:
        if path is None:
            raise CrowdError(
                "--two-sided: mirrors about the way of an inserted ego; name it (--ego-route)"
            )
        axis = _axis(config, path)
    position = _scatter(config, random, axis)
    desired_speed = _truncated_normal(config, random)
    destination = position + np.asarray(config.walk)
    if axis is not None:
        unmirrored = _mirror(position[1::2], axis)
        destination[1::2] = _mirror(unmirrored + np.asarray(config.walk), axis)
    return Spawned(ids, position, destination, desired_speed)


def _axis(config: CrowdConfig, path: EgoPath) -> Pose:
    """The ego's path where it is nearest to the middle of the spawn area."""
    x_min, y_min, x_max, y_max = config.spawn_area
    stations, _ = path.project([((x_min + x_max) / 2, (y_min + y_max) / 2)])
    return path.pose(float(stations[0]))


def _scatter(config: CrowdConfig, random: np.random.Generator, axis: Pose | None) -> Array:
    """(n, 2) places, none closer to another than the minimum spacing.

    All in the spawn area, or every second one in its mirror image about ``axis``.
    """
    x_min, y_min, x_max, y_max = config.spawn_area
    low, high = np.array([x_min, y_min]), np.array([x_max, y_max])
    places = np.empty((config.pedestrians, 2))
    for count in range(config.pedestrians):
        for _ in range(_ATTEMPTS_PER_PERSON):
            candidate = random.uniform(low, high)
            if axis is not None and count % 2:
                candidate = _mirror(candidate[None], axis)[0]
            offsets = places[:count] - candidate
            if not (np.einsum("ij,ij->i", offsets, offsets) < config.minimum_spacing**2).any():
                places[count] = candidate
                break
        else:
            area = (x_max - x_min) * (y_max - y_min)
            raise CrowdError(
                f"--pedestrians {config.pedestrians}: only {count} fit into the spawn area of "
                f"{area:.0f} m2 at a spacing of {config.minimum_spacing} m; enlarge --spawn-area "
                "or lower the number or [crowd] minimum_spacing"
            )
    return places


def _truncated_normal(config: CrowdConfig, random: np.random.Generator) -> Array:
    """(n,) desired speeds [m/s]: normal, redrawn until inside the bounds."""
    mean, deviation = config.desired_speed_mean, config.desired_speed_sd
    low, high = config.desired_speed_min, config.desired_speed_max
    speeds = random.normal(mean, deviation, config.pedestrians)
    for _ in range(_REDRAWS):
        outside = (speeds < low) | (speeds > high)
        if not outside.any():
            return speeds
        speeds[outside] = random.normal(mean, deviation, int(outside.sum()))
    return np.clip(speeds, low, high)  # bounds so narrow that hardly any draw falls between them


def _mirror(points: Array, axis: Pose) -> Array:
    """The mirror image of ``points`` (n, 2) about the line through ``axis``."""
    origin = np.array([axis.x, axis.y])
    normal = np.array([-np.sin(axis.heading), np.cos(axis.heading)])
    return points - 2.0 * np.outer((points - origin) @ normal, normal)
