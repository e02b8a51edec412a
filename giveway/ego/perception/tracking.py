"""The positions of people, estimated with bounds from positions of bounded error.

Set-membership estimation (Schweppe, IEEE TAC 1968), with boxes: who was within a box is, a step
later, within the box moved by the step's way and widened by what the way may differ; who is seen is
within the error's box about that place; so both hold. A promise needs that bound. Planning needs
the likeliest place instead: a running mean of the same, kept within the bound.

Velocities are seen exactly. Between two instants with velocities v and v', who accelerates by at
most a_max goes within a_max dt^2 / 4 of dt (v + v') / 2: the largest area between v(t) and its
chord.
"""

import numpy as np
from numpy.typing import NDArray

from giveway.ego.perception.protocol import OwnArrays, Percept
from giveway.geometry.kernel import Array, kernel

_LEAST = 0.02  # of an observation's weight in the mean: what is older than 50 steps fades
_COLUMNS = 9  # low x, y; high x, y; the estimate x, y [m]; velocity [m/s]; observations


class Tracker:
    """Follows people whom one ego sees, each by the number that the person keeps.

    Args:
        error: Largest error [m] of a position in x and in y, where the sensor claims no bound.
        acceleration: a_max [m/s^2] of people.
        time_step: dt [s] between two looks.
    """

    def __init__(self, error: float, acceleration: float, time_step: float) -> None:
        self._error, self._time_step = error, time_step
        self._slack = 0.25 * acceleration * time_step * time_step
        self._known = np.zeros((0, _COLUMNS))
        self._seen = np.zeros(0, dtype=np.int64)  # at which look each was seen last
        self._look = 1
        self._errors = np.zeros(0)
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
            self._errors = np.zeros(2 * n)
        self._look += 1
        errors = self._errors[:n]
        errors[:] = self._error if percept.position_bound is None else percept.position_bound
        _track(
            people.position,
            people.velocity,
            numbers,
            self._look,
            self._slack,
            self._time_step,
            self._known,
            self._seen,
            errors,
        )
        return Percept(people, numbers, percept.age, errors)


@kernel
def _track(
    position: Array,
    velocity: Array,
    numbers: NDArray[np.int64],
    look: int,
    slack: float,
    time_step: float,
    known: Array,
    seen: NDArray[np.int64],
    errors: Array,
) -> None:
    """Overwrite positions and ``errors`` (of each axis) by estimates and their bounds."""
    for row in range(len(numbers)):
        mine, error = known[numbers[row]], errors[row]
        lost = seen[numbers[row]] != look - 1
        seen[numbers[row]] = look
        for axis in range(2):
            place, v = position[row, axis], velocity[row, axis]
            way = 0.5 * time_step * (mine[6 + axis] + v)
            mine[axis] = max(mine[axis] + way - slack, place - error)
            mine[2 + axis] = min(mine[2 + axis] + way + slack, place + error)
            mine[4 + axis] += way
            mine[6 + axis] = v
            lost = lost or mine[axis] > mine[2 + axis]  # moved as nobody does
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
