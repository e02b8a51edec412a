"""Generates crowds that an ego meets: groups from both sides, timed by the ego's free drive.

Sizes and formations of groups are those of groups.py, also for people who walk alone.
docs/encounters.md describes the distributions and their results.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from giveway.config.tables.crowd import CrowdConfig
from giveway.crowd.generation.groups import LARGEST, RATE, formation
from giveway.crowd.generation.kinds import desired_speeds
from giveway.errors import CrowdError
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath

_JITTER = 0.1  # largest offset [m] on each axis from the place in the formation
_SKEW, _MOST_SKEW = 10.0, 25.0  # standard and largest deviation [deg] from a right angle
_FIRST, _LAST = 12.0, 4.0  # length [m] of path before the first and after the last meeting point
_MEETING = (-2.5, 0.5)  # arrival [s] after the free ego of groups that meet it
_ANY = (-4.0, 8.0)  # arrival [s] after the free ego of all other groups
_SHARE_MEETING = 0.4  # share of groups that meet the ego; at least one does
_EARLIEST = 2.5  # shortest walk [s] from a start to the path
_BEYOND = 15.0  # distance [m] from the path to a destination
_ATTEMPTS = 2_000  # largest number of attempts to place one group


@dataclass(frozen=True)
class FreeDrive:
    """The drive of an ego without other road users.

    Attributes:
        path: Path of the front bumper.
        departure: Station [m] at which the drive begins.
        distance: Distance [m] to its goal.
        speed: Reference speed [m/s].
    """

    path: EgoPath
    departure: float
    distance: float
    speed: float


def meet(
    config: CrowdConfig, drive: FreeDrive, kinds: Sequence[str], random: np.random.Generator
) -> tuple[Array, Array, Array, list[int]]:
    """Draw ``config.pedestrians`` people in groups that cross the path of a free drive.

    Args:
        config: Number, speeds and spacing of the people.
        drive: Free drive that they meet.
        kinds: Kind (n,) of each person.
        random: Generator of the draws.

    Returns:
        Starts (n, 2) [m], destinations (n, 2) [m], desired speeds (n,) [m/s], and sizes of the
        groups.

    Raises:
        CrowdError: the drive is too short, or there is no room for so many people.
    """
    if drive.distance < _FIRST + _LAST:
        raise CrowdError(
            f"--sampler encounters: the ego drives {drive.distance:g} m: expected at least "
            f"{_FIRST + _LAST:g} m of way on which people meet it; raise --ego-travel-distance"
        )
    sizes = _sizes(config.pedestrians, random)
    sides = np.resize([1.0, -1.0], len(sizes))
    random.shuffle(sides)
    meeting = np.arange(len(sizes)) < max(1, round(_SHARE_MEETING * len(sizes)))
    random.shuffle(meeting)
    position, destination = np.empty((0, 2)), np.empty((0, 2))
    speeds: list[float] = []
    for size, side, meets in zip(sizes, sides, meeting, strict=True):
        for _ in range(_ATTEMPTS):
            first = len(position)
            speed = _speed(config, kinds[first : first + int(size)], random)
            starts, ends = _group(drive, int(size), side, speed, bool(meets), random)
            if _has_room(starts, position, config.minimum_spacing):
                break
        else:
            raise CrowdError(
                f"--pedestrians {config.pedestrians}: only {len(position)} find room on a way of "
                f"{drive.distance:g} m at a spacing of {config.minimum_spacing} m; lower the "
                "number or [crowd] minimum_spacing"
            )
        position, destination = np.vstack([position, starts]), np.vstack([destination, ends])
        speeds += [speed] * int(size)
    return position, destination, np.array(speeds), sizes


def _sizes(people: int, random: np.random.Generator) -> list[int]:
    """Draw sizes of groups from a zero-truncated Poisson distribution; the last has the rest."""
    sizes: list[int] = []
    while (left := people - sum(sizes)) > 0:
        size = int(random.poisson(RATE))
        if 1 <= size <= LARGEST:
            sizes.append(min(size, left))
    return sizes


def _speed(config: CrowdConfig, kinds: Sequence[str], random: np.random.Generator) -> float:
    """Return the desired speed [m/s] of a group; in a mixed group that of the slowest person."""
    members = kinds if any(kinds) else kinds[:1]
    return float(desired_speeds(config, members, random).min())


def _group(
    drive: FreeDrive,
    size: int,
    side: float,
    speed: float,
    meets: bool,
    random: np.random.Generator,
) -> tuple[Array, Array]:
    """Return starts and ends (size, 2) [m] of a group that walks to the left or right of the path.

    Args:
        drive: Free drive of the ego.
        size: Number of people.
        side: Direction: 1 to the left, -1 to the right.
        speed: Desired speed [m/s].
        meets: Whether the group meets the ego.
        random: Generator of the draws.
    """
    along = float(random.uniform(_FIRST, drive.distance - _LAST))
    delay = float(random.uniform(*(_MEETING if meets else _ANY)))
    skew = float(np.clip(random.normal(0.0, _SKEW), -_MOST_SKEW, _MOST_SKEW))
    arrival = max(along / drive.speed + delay, _EARLIEST)
    pose = drive.path.pose(drive.departure + along)
    heading = pose.heading + side * np.pi / 2.0 + np.radians(skew)
    ahead = np.array([np.cos(heading), np.sin(heading)])
    beside = np.array([-ahead[1], ahead[0]])
    formed = np.einsum("ij,jk", formation(size), np.vstack([beside, ahead]))
    place = np.array([pose.x, pose.y]) + formed
    place += random.uniform(-_JITTER, _JITTER, (size, 2))
    return place - speed * arrival * ahead, place + _BEYOND * ahead


def _has_room(starts: Array, others: Array, spacing: float) -> bool:
    """Return whether ``starts`` keep ``spacing`` [m] from one another and from ``others``."""
    everybody = np.vstack([others, starts])
    offsets = everybody[None] - starts[:, None]
    squares = np.einsum("ijk,ijk->ij", offsets, offsets)
    own = np.arange(len(starts))
    squares[own, len(others) + own] = np.inf
    return bool((squares >= spacing**2).all())
