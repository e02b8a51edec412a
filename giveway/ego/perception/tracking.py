"""Estimates people's positions, with bounds, from positions of bounded error.

The method is set-membership estimation (Schweppe, IEEE TAC 1968) with boxes. A person within a box
is, one step later, within the box moved by the step's displacement and widened by its possible
error. A perceived person is also within the box of the perception error. The intersection of both
is the new box. The safety layer needs this bound. Planning needs the likeliest position, which is a
running mean, kept within the bound.

Velocities are perceived exactly. A person with velocities v and v' at two instants and an
acceleration of at most a_max moves by dt (v + v') / 2, with an error of at most a_max dt^2 / 4 on
each axis: the largest area between v(t) and its chord. If velocities are off by at most dv, the
error is larger by dv dt.
"""

import numpy as np
from numpy.typing import NDArray

from giveway.ego.perception.protocol import OwnArrays, Percept
from giveway.geometry.kernel import Array, kernel

_LEAST = 0.02  # least weight of a new position in the mean, reached after 50 observations
_COLUMNS = 9  # low x, y; high x, y; estimate x, y [m]; velocity [m/s]; number of observations


class Tracker:
    """Tracks the people that one ego perceives, by person id.

    Args:
        error: Largest error [m] of a position on each axis if the sensor claims no bound.
        acceleration: Largest acceleration a_max [m/s^2] of people.
        time_step: Time dt [s] between two looks.
    """

    def __init__(self, error: float, acceleration: float, time_step: float) -> None:
        self._error, self._time_step = error, time_step
        self._slack = 0.25 * acceleration * time_step * time_step
        self._known = np.zeros((0, _COLUMNS))
        self._seen = np.zeros(0, dtype=np.int64)  # number of the last look at each person
        self._look = 1
        self._errors, self._slacks = np.zeros(0), np.zeros(0)
        self._own = OwnArrays("position")

    def refine(self, percept: Percept) -> Percept:
        """The percept with estimated positions, and with bounds of their errors."""
        seen, numbers = percept.people, percept.person_ids
        if percept.position_bound is None and not self._error:
            return percept  # positions are exact
        people = self._own.of(seen) if len(seen) else seen
        if len(seen):
            people.position[:] = seen.position
        n = len(numbers)
        most = int(numbers.max(initial=-1)) + 1
        if most > len(self._known):
            more = 2 * most - len(self._known)
            self._known = np.concatenate([self._known, np.zeros((more, _COLUMNS))])
            self._seen = np.concatenate([self._seen, np.zeros(more, dtype=np.int64)])
        if n > len(self._errors):
            self._errors, self._slacks = np.zeros(2 * n), np.zeros(2 * n)
        self._look += 1
        errors = self._errors[:n]
        errors[:] = self._error if percept.position_bound is None else percept.position_bound
        slacks = self._slacks[:n]
        slacks[:] = self._slack
        if percept.velocity_bound is not None:
            slacks += self._time_step * percept.velocity_bound
        _track(
            (people.position, people.velocity),
            numbers,
            self._look,
            (slacks, self._time_step),
            (self._known, self._seen),
            errors,
        )
        return percept._replace(people=people, position_bound=errors)


@kernel
def _track(
    people: tuple[Array, Array],
    numbers: NDArray[np.int64],
    look: int,
    motion: tuple[Array, float],
    memory: tuple[Array, NDArray[np.int64]],
    errors: Array,
) -> None:
    """Overwrite positions by estimates, and ``errors`` by the bounds of their distances.

    Args:
        people: Positions (n, 2) [m], changed, and velocities (n, 2) [m/s].
        numbers: Person ids (n,).
        look: Number of this look.
        motion: Largest error (n,) [m] of a step's displacement on each axis, and time [s] between
            two looks.
        memory: State of each person by id, see ``_COLUMNS``, and number of the last look at each
            person; changed.
        errors: Largest errors (n,) [m] on each axis; filled with those of the estimates.
    """
    (position, velocity), (slacks, time_step), (known, seen) = people, motion, memory
    for row in range(len(numbers)):
        mine, error, slack = known[numbers[row]], errors[row], slacks[row]
        lost = seen[numbers[row]] != look - 1
        seen[numbers[row]] = look
        for axis in range(2):
            place, v = position[row, axis], velocity[row, axis]
            way = 0.5 * time_step * (mine[6 + axis] + v)
            mine[axis] = max(mine[axis] + way - slack, place - error)
            mine[2 + axis] = min(mine[2 + axis] + way + slack, place + error)
            mine[4 + axis] += way
            mine[6 + axis] = v
            lost = lost or mine[axis] > mine[2 + axis]  # the bounds contradict each other
        mine[8] = 1.0 if lost else mine[8] + 1.0
        off = 0.0
        for axis in range(2):
            place = position[row, axis]
            if lost:
                mine[axis], mine[2 + axis], mine[4 + axis] = place - error, place + error, place
            estimate = mine[4 + axis] + max(1.0 / mine[8], _LEAST) * (place - mine[4 + axis])
            estimate = min(max(estimate, mine[axis]), mine[2 + axis])
            mine[4 + axis] = position[row, axis] = estimate
            farthest = max(estimate - mine[axis], mine[2 + axis] - estimate)
            off += farthest * farthest
        errors[row] = np.sqrt(off)
