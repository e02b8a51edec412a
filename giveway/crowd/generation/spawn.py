"""Draws the pedestrians of a run from its seed: starts, destinations and desired speeds."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from giveway.config.tables.crowd import DRAWS_PER_PERSON, ENCOUNTERS, CrowdConfig
from giveway.crowd.generation.encounters import FreeDrive, meet
from giveway.crowd.generation.groups import facing, of_parties, party_sizes, slowest
from giveway.crowd.generation.kinds import desired_speeds, draw_kinds, speeds_at
from giveway.crowd.roster import Trait
from giveway.errors import CrowdError
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath, Pose

_ATTEMPTS_PER_PERSON = 2_000  # enough for up to a third of the densest packing

_KINDS = 0x41D  # key of the random stream of kinds, which differs from all others

PREFIX = "ped"  # prefix of the ids of the pedestrians that giveway adds


@dataclass(frozen=True)
class Spawned:
    """Drawn pedestrians, in the order of their ids."""

    ids: tuple[str, ...]
    position: Array  # starts (n, 2) [m]
    destination: Array  # destinations (n, 2) [m]
    desired_speed: Array  # desired speeds (n,) [m/s]
    kinds: tuple[str, ...]  # kinds (n,), as in kinds.py; empty without a kind
    groups: tuple[str, ...]  # ids (n,) of the group's first member; empty for single people

    @property
    def traits(self) -> dict[str, Trait]:
        """The traits of those pedestrians who have any, by their ids."""
        told = zip(self.ids, self.kinds, self.groups, strict=True)
        return {name: Trait(kind, group) for name, kind, group in told if kind or group}


def spawn(
    config: CrowdConfig,
    path: EgoPath | None,
    seed: int,
    prefix: str = PREFIX,
    drive: FreeDrive | None = None,
) -> Spawned:
    """Draw ``config.pedestrians`` pedestrians that keep the minimum spacing.

    Starts are uniform in the spawn area. With the sampler ``encounters`` people meet ``drive``.

    With ``two_sided`` every second group or single person is mirrored about the ego's path at the
    spawn area. The first k people of a larger crowd of the same seed differ from a crowd of k,
    because the spacing rule couples all of them.

    With ``config.draws`` the seed only draws places again that are too close to another person, and
    kinds and groups. The distribution is the same.

    Args:
        config: Number, places, destinations and speeds of the people.
        path: Path of the ego, for ``two_sided``; None if no ego is inserted.
        seed: Seed of the draw.
        prefix: Prefix of their ids; a number follows.
        drive: Free drive for the sampler ``encounters``; None if no route is known.

    Raises:
        CrowdError: there is no room for so many people at this spacing, or there is no ego to
            mirror about or to meet.
    """
    random = np.random.default_rng(seed)
    ids = tuple(f"{prefix}{i}" for i in range(config.pedestrians))
    kinds = draw_kinds(config.people, len(ids), np.random.default_rng((seed, _KINDS)))
    if config.sampler == ENCOUNTERS:
        if drive is None:
            raise CrowdError(
                "--sampler encounters: people meet an ego on its route, and there is none; name "
                "one (--ego-route)"
            )
        position, destination, desired_speed, sizes = meet(config, drive, kinds, random)
        return Spawned(ids, position, destination, desired_speed, kinds, of_parties(sizes, ids))
    axis = None
    if config.two_sided:
        if path is None:
            raise CrowdError(
                "--two-sided: mirrors about the way of an inserted ego; name it (--ego-route)"
            )
        axis = _axis(config, path)
    sizes = party_sizes(len(ids), config.groups, random)
    draws = np.reshape(config.draws, (-1, DRAWS_PER_PERSON))
    position = _scatter(config, sizes, random, axis, draws[:, :2])
    if len(draws):
        speeds = speeds_at(config, kinds, draws[:, 2])
    else:
        speeds = desired_speeds(config, kinds, random)
    desired_speed = slowest(speeds, sizes)
    destination = position + np.asarray(config.walk)
    if axis is not None:
        across = np.repeat(np.arange(len(sizes)) % 2 == 1, sizes)
        unmirrored = _mirror(position[across], axis)
        destination[across] = _mirror(unmirrored + np.asarray(config.walk), axis)
    return Spawned(ids, position, destination, desired_speed, kinds, of_parties(sizes, ids))


def _axis(config: CrowdConfig, path: EgoPath) -> Pose:
    """Return the pose of the ego's path at its nearest point to the middle of the spawn area."""
    x_min, y_min, x_max, y_max = config.spawn_area
    stations, _ = path.project([((x_min + x_max) / 2, (y_min + y_max) / 2)])
    return path.pose(float(stations[0]))


def _scatter(
    config: CrowdConfig,
    sizes: Sequence[int],
    random: np.random.Generator,
    axis: Pose | None,
    draws: Array,
) -> Array:
    """Draw places (n, 2) [m] of groups that keep the minimum spacing from one another.

    All are in the spawn area. With an ``axis`` every second group is in its mirror image. ``draws``
    (n, 2) are standard normal numbers for each group's first attempt, or none.
    """
    shares = _probabilities(draws)
    x_min, y_min, x_max, y_max = config.spawn_area
    low, high = np.array([x_min, y_min]), np.array([x_max, y_max])
    places = np.empty((config.pedestrians, 2))
    count = 0
    for number, size in enumerate(sizes):
        shape = facing(size, np.asarray(config.walk))
        for attempt in range(_ATTEMPTS_PER_PERSON):
            if len(shares) and not attempt:
                candidate = low + shares[count] * (high - low) + shape
            else:
                candidate = random.uniform(low, high) + shape
            if size > 1 and not ((candidate >= low) & (candidate <= high)).all():
                continue
            if axis is not None and number % 2:
                candidate = _mirror(candidate, axis)
            if has_room(candidate, places[:count], config.minimum_spacing):
                places[count : count + size] = candidate
                count += size
                break
        else:
            area = (x_max - x_min) * (y_max - y_min)
            raise CrowdError(
                f"--pedestrians {config.pedestrians}: only {count} fit into the spawn area of "
                f"{area:.0f} m2 at a spacing of {config.minimum_spacing} m; enlarge --spawn-area "
                "or lower the number or [crowd] minimum_spacing"
            )
    return places


def _probabilities(draws: Array) -> Array:
    """Return the probability of each standard normal number not to be exceeded."""
    if not len(draws):
        return draws
    from scipy.special import ndtr  # only here, since its import takes long

    return np.asarray(ndtr(draws))


def has_room(places: Array, others: Array, spacing: float) -> bool:
    """Return whether ``places`` (k, 2) keep ``spacing`` [m] from all ``others`` (n, 2)."""
    offsets = others[None] - places[:, None]
    return not (np.einsum("ijk,ijk->ij", offsets, offsets) < spacing**2).any()


def _mirror(points: Array, axis: Pose) -> Array:
    """Return the mirror images of ``points`` (n, 2) [m] about the line through ``axis``."""
    origin = np.array([axis.x, axis.y])
    normal = np.array([-np.sin(axis.heading), np.cos(axis.heading)])
    return points - 2.0 * np.outer(np.einsum("ij,j", points - origin, normal), normal)
