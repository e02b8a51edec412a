"""The short members of the chain behind a sensor: noise, desired speeds, goals."""

from dataclasses import replace
from functools import cached_property
from math import sqrt

import numpy as np

from giveway.crowd.motion.noise import BOUND, planar_noise
from giveway.ego.perception.desired_speeds import Pace
from giveway.ego.perception.protocol import OwnArrays, Percept
from pedestrian_model import Crowd

_FAR = 1000.0  # Distance [m] along the heading to an expected goal, beyond every horizon
_STANDS = 0.1  # Speed [m/s] below which a person has no heading and is expected to stay


class PositionNoise:
    """Adds noise to each perceived position, drawn anew at each instant.

    Args:
        deviation: Standard deviation [m] on each axis. Noise is cut off at twice this value.
        seed: Seed of the draws.
    """

    def __init__(self, deviation: float, seed: tuple[int, ...]) -> None:
        self._deviation, self._seed = deviation, seed
        self._bound = sqrt(2.0) * BOUND * deviation
        self._own = OwnArrays("position")

    @cached_property
    def _random(self) -> np.random.Generator:
        return np.random.default_rng(self._seed)

    def refine(self, percept: Percept) -> Percept:
        """The percept with noise on its positions. Bounds that the sensor claims grow by it."""
        people = percept.people
        if not len(people):
            return percept
        noise = planar_noise(self._random, len(people))
        noise *= self._deviation
        noisy, bound = self._own.of(people), percept.position_bound
        np.add(people.position, noise, out=noisy.position)
        bound = None if bound is None else bound + self._bound
        return percept._replace(people=noisy, position_bound=bound)


class DesiredSpeeds:
    """Replaces desired speeds, which no sensor sees, by a typical or an estimated one.

    Args:
        typical: Desired speed [m/s] that is assumed of a new person.
        pace: Estimator of desired speeds, or None to keep the typical one.
    """

    def __init__(self, typical: float, pace: Pace | None) -> None:
        self._typical, self._pace = typical, pace
        self._own = OwnArrays("desired_speed")

    def refine(self, percept: Percept) -> Percept:
        """The percept with desired speeds that are estimated."""
        people = percept.people
        if not len(people):
            return percept
        own, pace = self._own.of(people), self._pace
        own.desired_speed[:] = (
            self._typical if pace is None else pace.learn(people, percept.person_ids)
        )
        return percept._replace(people=own)


class HeadingGoals:
    """Replaces the routes of all people by straight ones along their present headings."""

    def refine(self, percept: Percept) -> Percept:
        """The percept in which everybody walks straight on and standing people stay."""
        people = percept.people
        return percept._replace(people=_walking_on(people)) if len(people) else percept


def _walking_on(crowd: Crowd) -> Crowd:
    """The crowd with straight routes. Nothing else differs."""
    n = len(crowd)
    speed = np.hypot(crowd.velocity[:, 0], crowd.velocity[:, 1])
    reach = np.where(speed > _STANDS, _FAR / np.maximum(speed, _STANDS), 0.0)
    return replace(
        crowd,
        waypoints=crowd.position + crowd.velocity * reach[:, None],
        waypoint_start=np.arange(n + 1),
        waypoint_index=np.zeros(n, dtype=np.int64),
        waypoint_passage=np.zeros((n, 3)),
        waypoint_signal=np.full(n, -1, dtype=np.int64),
    )
