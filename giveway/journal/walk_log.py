"""The log of how people progress on their routes, kept in this process's memory.

Unlike the rows of a run, it does not have to survive a crash: it only serves the comparison with
the counterfactual run that follows.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from giveway.geometry.kernel import Array, kernel
from giveway.journal.journal import JournalRows
from giveway.run_data.walks import WalkTrack
from pedestrian_model import Crowd, remaining_distance

REACH = 30.0
"""Largest distance [m] from an ego's path of the people who are noted."""
_LOOKS = 0.5  # Interval [s] between two searches for people who come close
_SWAY = 0.1  # Smallest distance [m] that counts as walked; standing people sway by less
_NUMBERS = ("x", "y", "vx", "vy", "remaining", "walked")
_COLUMNS = ("step", "pedestrian", *_NUMBERS)  # as the kernel fills them


class _People(NamedTuple):
    """The crowd at one instant as the kernel takes it, n pedestrians."""

    person_ids: NDArray[np.int64]  # (n,) index of each pedestrian in the log
    position: Array  # (n, 2) [m]
    velocity: Array  # (n, 2) [m/s]
    desired_speed: Array  # (n,) [m/s]
    remaining: Array  # (n,) [m] to the end of the walk


class WalkLog:
    """Notes the positions of people on their routes.

    Args:
        time_step: Time [s] between two control instants.
        counts: Function that returns whether the person of a name is noted from the beginning. With
            None, a person is noted from the instant on at which they come close to a path given to
            :meth:`add_way`.
    """

    def __init__(self, time_step: float, counts: Callable[[str], bool] | None = None) -> None:
        self._time_step = time_step
        self._counts = counts
        self._every = max(1, round(_LOOKS / time_step))
        self._ways: list[shapely.LineString] = []
        self._rows = JournalRows(_COLUMNS)
        self._arrivals: list[tuple[int, int]] = []
        self._ids: list[str] = []
        self._near = np.zeros(0, dtype=np.bool_)
        # x, y, distance walked [m], desired speed [m/s]; nan if not known
        self._memory = np.zeros((0, 4))
        self._last = -1

    def add_way(self, way: Array) -> None:
        """Note from now on who comes close to an ego's path, (k, 2) [m]."""
        line = shapely.LineString(way)
        shapely.prepare(line)
        self._ways.append(line)

    def stop_looking(self) -> None:
        """End the search: who comes close after the egos have gone was not in their way."""
        self._ways.clear()

    def note(
        self, step: int, ids: Sequence[str], person_ids: NDArray[np.int64], crowd: Crowd
    ) -> None:
        """Note the positions of ``person_ids`` at a control instant, once per instant.

        Args:
            step: Index of the control instant.
            ids: Ids of all people who ever were in the crowd.
            person_ids: Index (n,) into ``ids`` of each person in the crowd.
            crowd: Crowd of n pedestrians.
        """
        if step <= self._last:
            return
        self._last = step
        if len(ids) > len(self._ids):
            self._learn(ids[len(self._ids) :])
        if self._ways and step % self._every == 0:
            self._look(person_ids, crowd.position)
        if not len(person_ids):
            return
        block = self._rows.block(len(person_ids))
        people = _People(
            person_ids,
            crowd.position,
            crowd.velocity,
            crowd.desired_speed,
            remaining_distance(crowd),
        )
        filled = _fill(step, people, self._near, self._memory, block)
        self._rows.give_back(len(person_ids) - filled)

    def _learn(self, ids: Sequence[str]) -> None:
        self._ids += ids
        near = [self._counts is not None and self._counts(name) for name in ids]
        self._near = np.concatenate([self._near, np.array(near, dtype=np.bool_)])
        unseen = np.full((len(ids), self._memory.shape[1]), np.nan)
        self._memory = np.concatenate([self._memory, unseen])

    def _look(self, person_ids: NDArray[np.int64], position: Array) -> None:
        far = np.flatnonzero(~self._near[person_ids])
        if not len(far):
            return
        points = shapely.points(position[far])
        for way in self._ways:
            self._near[person_ids[far[shapely.dwithin(way, points, REACH)]]] = True

    def arrive(self, step: int, pedestrians: NDArray[np.int64]) -> None:
        """Note that pedestrians, by their indices, reached the last way-point at ``step``."""
        self._arrivals += [(step, int(pedestrian)) for pedestrian in pedestrians]

    def awaits(self, person_ids: NDArray[np.int64]) -> bool:
        """Return whether a person who counts is among ``person_ids``."""
        return bool(self._near[person_ids].any())

    @property
    def near(self) -> frozenset[str]:
        """The names of the people who count."""
        return frozenset(self._ids[i] for i in np.flatnonzero(self._near))

    @property
    def track(self) -> WalkTrack:
        """Return all records so far."""
        rows = self._rows.filled
        arrivals = np.array(self._arrivals, dtype=np.int64).reshape(-1, 2)
        return WalkTrack(
            step=rows["step"].astype(np.int64),
            pedestrian=rows["pedestrian"].astype(np.int64),
            **{name: np.ascontiguousarray(rows[name]) for name in _NUMBERS},
            arrival_step=arrivals[:, 0],
            arrival_pedestrian=arrivals[:, 1],
            desired_speed=self._memory[:, 3].copy(),
            near=self._near.copy(),
            ids=tuple(self._ids),
            time_step=self._time_step,
            last=self._last,
        )


@kernel
def _fill(step: int, people: _People, near: NDArray[np.bool_], memory: Array, block: Array) -> int:
    """Fill the rows of an instant with the people who count, note the others; return the count."""
    person_ids, position, velocity, desired_speed, remaining = people
    count = 0
    for i in range(len(person_ids)):
        p, x, y = person_ids[i], position[i, 0], position[i, 1]
        if np.isnan(memory[p, 0]):
            memory[p, 0], memory[p, 1], memory[p, 2] = x, y, 0.0
        moved = np.hypot(x - memory[p, 0], y - memory[p, 1])
        walked = memory[p, 2] + moved
        memory[p, 3] = desired_speed[i]
        if moved >= _SWAY:
            memory[p, 0], memory[p, 1], memory[p, 2] = x, y, walked
        if near[p]:
            block[count, 0] = step
            block[count, 1] = p
            block[count, 2], block[count, 3] = x, y
            block[count, 4], block[count, 5] = velocity[i, 0], velocity[i, 1]
            block[count, 6], block[count, 7] = remaining[i], walked
            count += 1
    return count
