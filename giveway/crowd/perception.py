"""What an ego's controllers see of the crowd, as far as it is not the truth.

Prediction and control work on what is seen here; tables and metrics on the truth.
"""

from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from giveway.config import EgoRunConfig
from giveway.crowd.motion.noise import BOUND, planar_noise
from giveway.crowd.pace import Pace
from giveway.crowd.tracking import Tracker
from giveway.geometry.kernel import Array
from pedestrian_model import Crowd

_STREAM = 0x5EE  # tells these draws from others of the same seed
_FAR = 1000.0  # [m] along the heading: beyond every horizon
_STANDS = 0.1  # [m/s] who is slower has no heading, and is expected to stay


class Perception:
    """One ego's eyes: positions with noise, and desired speeds and goals that cannot be seen.

    Each observation draws new noise for all, from a generator of this ego's own: equal runs see the
    same, whatever other egos there are. A tracker makes the most of them, and learns desired speeds
    from the pace that it sees, unless it is switched off; the paper's controllers have none.

    Args:
        config: of the ego.
        acceleration: [m/s^2] that no person exceeds, as far as the tracker is concerned.
        time_step: [s] between two observations.

    Attributes:
        errors: (n,) [m] that the positions of the latest observation are off at most; None: none.
    """

    def __init__(self, config: EgoRunConfig, acceleration: float, time_step: float) -> None:
        self._noise = config.perception.position_noise
        known = config.perception.desired_speeds == "known"
        self._speed = None if known else config.crowd.desired_speed_mean
        self._goals = config.perception.goals == "known"
        self._seed = (config.seed, _STREAM, *config.ego_id.encode())
        self._truth: Crowd | None = None
        self._seen: Crowd | None = None
        self._tracker: Tracker | None = None
        self._pace: Pace | None = None
        if self._noise and config.tracks_people:
            self._tracker = Tracker(BOUND * self._noise, acceleration, time_step)
        if self._speed is not None and config.tracks_people:
            self._pace = Pace(self._speed, time_step)
        self.errors: Array | None = None

    @cached_property
    def _random(self) -> np.random.Generator:
        return np.random.default_rng(self._seed)

    @property
    def exact(self) -> bool:
        """Whether it sees the truth."""
        return not self._noise and self._speed is None and self._goals

    def observe(self, crowd: Crowd, numbers: NDArray[np.int64]) -> Crowd:
        """The crowd as it is seen.

        Args:
            crowd: as it is; not changed. Its arrays are shared where they are seen as they are.
            numbers: (n,) one for each person, which the person keeps.

        Returns:
            A crowd of the same pedestrians in the same order, which the next call overwrites.
        """
        if self.exact:
            return crowd
        if not len(crowd):
            if self._tracker is not None:  # it has looked, and seen nobody
                self.errors = self._tracker.update(crowd, numbers)
            return crowd
        if crowd is not self._truth or self._seen is None:
            self._truth, self._seen = crowd, self._look_at(crowd)
        if self._pace is not None:
            self._seen.desired_speed[:] = self._pace.learn(crowd, numbers)
        if self._noise:
            noise = planar_noise(self._random, len(crowd))
            noise *= self._noise
            np.add(crowd.position, noise, out=self._seen.position)
            if self._tracker is not None:
                self.errors = self._tracker.update(self._seen, numbers)
        return self._seen if self._goals else _walking_on(self._seen)

    def _look_at(self, crowd: Crowd) -> Crowd:
        """A crowd that shares with ``crowd``, which is stepped in place, what is seen exactly."""
        position = crowd.position.copy() if self._noise else crowd.position
        speed = crowd.desired_speed if self._speed is None else np.full(len(crowd), self._speed)
        return replace(crowd, position=position, desired_speed=speed)


def _walking_on(crowd: Crowd) -> Crowd:
    """Everybody goes on along the present heading; who stands stays. Nothing but ways differs."""
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
