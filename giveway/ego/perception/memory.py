"""The memory of a sensor: who was seen last when and where, and is expected where by now."""

import numpy as np
from numpy.typing import NDArray

from giveway.ego.perception.protocol import Ids, Percept
from giveway.geometry.kernel import Array, kernel
from pedestrian_model import Crowd

_ROUNDING = 1e-9
_NEVER = -1.0
_COLUMNS = 7  # x, y [m]; velocity [m/s]; time when seen; until when missed [s]; error [m]
_SEEN, _MISSED, _ERROR = 4, 5, 6


class Memory:
    """Remembers people who were seen, as walking on.

    Args:
        span: Time [s] for which a person is remembered.
        turns: Largest error [m/s] of velocities.
        acceleration: Largest acceleration [m/s^2] of people.
    """

    def __init__(self, span: float, turns: float, acceleration: float) -> None:
        self._span, self._turns, self._acceleration = span, turns, acceleration
        self._rows = np.zeros((0, _COLUMNS))
        self._room: Crowd | None = None

    def rows(self, person_ids: Ids) -> Array:
        """Return the memory, with a row for each person."""
        most = int(person_ids.max(initial=-1)) + 1
        if most > len(self._rows):
            more = np.zeros((2 * most - len(self._rows), _COLUMNS))
            more[:, _SEEN] = _NEVER
            self._rows = np.concatenate([self._rows, more])
        return self._rows

    def noticed(
        self, person_ids: Ids, draws: Array, begins: float, now: float, span: float
    ) -> NDArray[np.bool_]:
        """Return which people (n,) are not missed now; who is missed is so for a while.

        Args:
            person_ids: Their ids.
            draws: Random number of each row of the memory.
            begins: Probability by which a miss begins.
            now: Present time [s].
            span: Length [s] of a miss.
        """
        until = self.rows(person_ids)[:, _MISSED]
        until[person_ids[(until[person_ids] <= now) & (draws[person_ids] < begins)]] = now + span
        noticed: NDArray[np.bool_] = until[person_ids] <= now
        return noticed

    def learn(
        self,
        person_ids: Ids,
        position: Array,
        velocity: Array,
        seen: NDArray[np.bool_],
        error: Array,
        then: float,
    ) -> None:
        """Remember the people (n,) who were seen at an instant.

        Args:
            person_ids: Ids of all people.
            position: Perceived positions (n, 2) [m].
            velocity: Perceived velocities (n, 2) [m/s].
            seen: Marks of who was seen.
            error: Largest errors (n,) of the positions [m].
            then: Time [s] of the instant.
        """
        fill_memory(self.rows(person_ids), person_ids, position, velocity, seen, error, then)

    def percept(self, people: Crowd, person_ids: Ids, now: float, delay: float) -> Percept:
        """Return the people of whom something is known, moved on to where they should be.

        Args:
            people: All people as they are.
            person_ids: Their ids.
            now: Present time [s].
            delay: Time [s] by which the sensor is late.
        """
        known, kept = self.rows(person_ids), np.empty(len(person_ids), dtype=np.bool_)
        oldest = now - delay - self._span - _ROUNDING
        count = mark_remembered(known, person_ids, oldest, kept)
        self._room = people = people.select(kept, self._room)
        ids, bounds = person_ids[kept], np.empty((3, count))
        assumed = now, self._turns, self._acceleration
        fill_expected(known, ids, assumed, people.position, people.velocity, bounds)
        return Percept(people, ids, *bounds)


@kernel
def fill_memory(
    known: Array,
    ids: Ids,
    position: Array,
    velocity: Array,
    seen: NDArray[np.bool_],
    error: Array,
    then: float,
) -> None:
    """Fill in the rows of the people who were seen."""
    for i in range(ids.shape[0]):
        if seen[i]:
            row = known[ids[i]]
            row[0:2], row[2:4] = position[i], velocity[i]
            row[_SEEN], row[_ERROR] = then, error[i]


@kernel
def mark_remembered(known: Array, ids: Ids, oldest: float, kept: NDArray[np.bool_]) -> int:
    """Mark the people (n,) who were not seen before ``oldest`` [s], and return their number."""
    count = 0
    for i in range(ids.shape[0]):
        kept[i] = known[ids[i], _SEEN] >= max(oldest, 0.0)
        count += kept[i]
    return count


@kernel
def fill_expected(
    known: Array,
    ids: Ids,
    assumed: tuple[float, float, float],
    position: Array,
    velocity: Array,
    bounds: Array,
) -> None:
    """Fill in where people should be by now, and age, position's and velocity's bound (3, n).

    Args:
        known: Memory.
        ids: Ids (n,) of the people.
        assumed: Present time [s], largest error [m/s] of velocities and acceleration [m/s^2].
        position: Result (n, 2) [m].
        velocity: Result (n, 2) [m/s].
        bounds: Result (3, n) [s, m, m/s].
    """
    now, turns, acceleration = assumed
    for i in range(ids.shape[0]):
        row = known[ids[i]]
        age = now - row[_SEEN]
        for axis in range(2):
            velocity[i, axis] = row[2 + axis]
            position[i, axis] = row[axis] + age * row[2 + axis]
        bounds[0, i] = age
        bounds[1, i] = row[_ERROR] + age * (turns + 0.5 * acceleration * age)
        bounds[2, i] = turns + acceleration * age
