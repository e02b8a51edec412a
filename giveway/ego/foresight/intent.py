"""Estimates the intent of people, to walk on or to yield to the ego, from their motion.

There are two hypotheses for each person beside the ego's corridor who wants to cross it:

* *walks on*: the person walks as the model says;
* *yields*: the person walks up to the edge of the corridor, or to an earlier point at which they
  are about to stop by their present speed, and stands there, whatever the ego does.

Both predict the speed one prediction step later, and observed speeds change the log odds between
them (sequential probability ratio test, Wald 1945). Who more likely yields is predicted with the
stopping point as destination. Who is on the way keeps on, and stops once they become slower.
"""

from math import exp
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.ego.foresight.expected_motions import (
    KEEPS_ON,
    STANDS,
    STOPS,
    YIELDS,
    Yielding,
)
from giveway.ego.foresight.later_crossings import abreast
from giveway.geometry.kernel import Array, inner, kernel
from giveway.geometry.path import EgoPath, segment_at
from pedestrian_model import Crowd, Predictor

_ERROR = 0.1  # standard deviation [m/s] of a speed that is predicted one step ahead
_PRIOR = -3.0  # log odds that a new person yields: 1 in 21
_SUREST = 4.0  # bound of the log odds, so that people may change their minds
_SIGHT = 60.0  # distance [m] ahead of the front, within which people may stand on the way
_REACH = 25.0  # distance [m] ahead of the front, within which intent is estimated
_ASIDE = 6.0  # distance [m] to the corridor's edge, beyond which people do not slow down for it
_TOWARDS = 0.3  # desired speed [m/s] towards the corridor, above which a person wants to cross
_EDGE = 0.05  # distance [m] to the corridor's edge at which people who yield stop
_SWAY = 0.1  # distance [m] that people may walk beyond the stopping point of their speed
_OPEN = 2.0  # absolute log odds below which a person's intent is uncertain
_SEES = -0.17  # cosine of 100 degrees, the half angle about a person's course that they see
_TURNED = 0.1  # share of a change of velocity that changes the course of a person, per look
_SLOWS = 0.7  # share of the speed on this course below which a person on the way is stopping
_NEVER = -1  # number of a look that never took place


class AlternativeHypothesis(NamedTuple):
    """The alternative hypothesis: people of uncertain intent do what is less likely."""

    people: Crowd  # crowd in which the routes of those who yield are changed
    yielding: Yielding  # yielding state, as in :class:`IntentEstimator`
    likely: float  # probability of the other, likelier hypothesis


class IntentEstimator:
    """Estimates for each person, by number, the log odds that they yield to the ego.

    Args:
        path: Path of the ego.
        half_width: Half width of its corridor [m].
        predictor: Predictor of people who walk on.
        time_step: Time [s] between two looks. The predictor's step is a multiple of it.
    """

    def __init__(
        self,
        path: EgoPath,
        half_width: float,
        predictor: Predictor,
        time_step: float,
    ) -> None:
        walking = predictor.parameters
        # The share of a desired change of velocity in one step, by f_d = k_des (v_d - v)
        taken_up = 1.0 - exp(-predictor.time_step * walking.destination_gain / walking.mass)
        self._law = half_width, taken_up, walking.destination_smoothing
        self._step = predictor.time_step
        every = round(predictor.time_step / time_step)
        self._way = path.vertices, path.stations
        self._every, self._look = every, every
        self._odds = np.zeros(0)
        self._told = np.zeros((0, every), dtype=np.int64)
        self._expected = np.zeros((0, every, 3))
        self._numbers, self._yield = np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int8)
        self._course, self._unaware = np.zeros((0, 2)), np.zeros(0, dtype=np.bool_)

    def odds(self, number: int) -> float:
        """Return the log odds that the person of this number yields."""
        return float(self._odds[number]) if number < len(self._odds) else _PRIOR

    @property
    def unaware(self) -> NDArray[np.bool_]:
        """The marks (n,) of people who may not see the ego at the latest look.

        People see what is within 100 degrees of the direction in which they walk, or walked last.
        """
        return self._unaware

    @property
    def yielding(self) -> Yielding:
        """The yielding state of the latest look.

        It consists of marks (n,) of people who yield, the share of a desired change of velocity in
        one step, s_des [m], and the prediction step [s].
        """
        return self._yield, *self._law[1:], self._step

    def update_both(
        self, people: Crowd, numbers: NDArray[np.int64], front: float, expected: Array
    ) -> AlternativeHypothesis | None:
        """Update, and return the alternative hypothesis for people of uncertain intent.

        Arguments are as for :meth:`update`.

        Returns:
            The alternative hypothesis, or None if no intent is uncertain or nobody would yield or
            walk on differently.
        """
        if not _is_open(self._odds, numbers):
            self.update(people, numbers, front, expected)
            return None
        uncertain = np.abs(self._odds[numbers]) < _OPEN
        other = people.select(np.ones(len(people), dtype=np.bool_))
        self.update(people, numbers, front, expected)
        odds, yields = self._odds.copy(), np.zeros(len(numbers), dtype=np.int8)
        odds[numbers[uncertain]] *= -1.0
        seen = (*other.state, other.desired_speed, *other.routes)
        none = _NEVER, np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int8), np.zeros(0)
        marks = numbers, yields, np.empty_like(self._unaware)
        memory = odds, self._told, self._expected, self._course
        _update(self._way, front, seen, marks, none, memory, self._law)
        differ = yields != self._yield
        if not differ.any():
            return None
        least = float(np.abs(odds[numbers[differ]]).min())
        yielding = yields, *self._law[1:], self._step
        return AlternativeHypothesis(other, yielding, 1.0 / (1.0 + exp(-least)))

    def update(
        self, people: Crowd, numbers: NDArray[np.int64], front: float, expected: Array
    ) -> None:
        """Update the log odds, and let the routes of people who yield end at the corridor's edge.

        Args:
            people: People as the ego perceives them. The routes of those who yield are changed.
            numbers: Numbers (n,) that identify the people.
            front: Station of the front bumper [m].
            expected: States (4 m,), x, y [m], v_x, v_y [m/s], of the m people of the latest look
                one prediction step later, as predicted then; (0,) without a prediction.
        """
        yields, unaware = np.zeros(len(numbers), np.int8), np.zeros(len(numbers), np.bool_)
        seen = (*people.state, people.desired_speed, *people.routes)
        latest = (self._look, self._numbers, self._yield, expected)
        while True:
            memory = (self._odds, self._told, self._expected, self._course)
            marks = numbers, yields, unaware
            new = _update(self._way, front, seen, marks, latest, memory, self._law)
            if new < 0:
                break
            self._grow(2 * (new + 1) - len(self._odds))
        self._numbers, self._yield, self._unaware = numbers, yields, unaware
        self._look += 1

    def _grow(self, more: int) -> None:
        """Extend the arrays by ``more`` numbers of people."""
        self._odds = np.concatenate([self._odds, np.full(more, _PRIOR)])
        never = np.full((more, self._every), _NEVER)
        self._told = np.concatenate([self._told, never])
        self._expected = np.concatenate([self._expected, np.zeros((more, self._every, 3))])
        self._course = np.concatenate([self._course, np.zeros((more, 2))])


@kernel
def _update(
    path: tuple[Array, Array],
    front: float,
    people: tuple[Any, ...],
    marked: tuple[NDArray[np.int64], NDArray[np.int8], NDArray[np.bool_]],
    latest: tuple[int, NDArray[np.int64], NDArray[np.int8], Array],
    memory: tuple[Array, NDArray[np.int64], Array, Array],
    law: tuple[float, float, float],
) -> int:
    """Update the log odds as :meth:`IntentEstimator.update` does.

    Return -1, or the first person's number for which the arrays are too short.

    Args:
        path: Vertices of the path, and their stations [m].
        front: Station of the front bumper [m].
        people: State, desired speeds and routes of the n people.
        marked: Numbers (n,) that identify the people; marks (n,) of their motions by the
            estimate, and of those who may not see the ego, both filled.
        latest: Number of this look. Of the latest look: numbers of the people, marks of those who
            yielded by the estimate, and predicted states.
        memory: Log odds by number. By number and look: the look in which velocities were
            predicted, these velocities [m/s], and 1 if the person was predicted to yield. By
            number: velocity [m/s] with which the person walked last.
        law: Half width of the corridor [m], share of a desired change of velocity in one step,
            s_des [m].
    """
    position, velocity, index, desired_speed, waypoints, passage, signal, start = people
    (vertices, stations), (numbers, yields, unaware) = path, marked
    odds, told, expected, course = memory
    half_width, taken_up, smoothing = law
    for i in range(len(numbers)):
        if numbers[i] >= len(odds):
            return int(numbers[i])
    every = told.shape[1]
    look, before, yielded, outcome = latest
    if len(outcome) > 0:
        slot = (look - 1) % every
        for i in range(len(before)):
            n = before[i]
            told[n, slot] = look - 1
            expected[n, slot, 0], expected[n, slot, 1] = outcome[4 * i + 2], outcome[4 * i + 3]
            expected[n, slot, 2] = yielded[i] == YIELDS
    slot = look % every
    first, last = segment_at(stations, front), segment_at(stations, front + _SIGHT)
    for i in range(len(numbers)):
        x, y, n, at = position[i, 0], position[i, 1], numbers[i], start[i] + index[i]
        station, lateral, e_x, e_y = abreast(vertices, stations, first, last, x, y)
        ahead, aside = station - front, abs(lateral) - half_width
        stands = velocity[i, 0] ** 2 + velocity[i, 1] ** 2 < STANDS * STANDS
        for axis in range(0 if stands else 2):
            course[n, axis] += _TURNED * (velocity[i, axis] - course[n, axis])
        c_x, c_y = course[n, 0], course[n, 1]
        off = np.copysign(max(aside, 0.0), lateral)  # to the nearest point of the ego's front
        facing = off * (c_x * e_y - c_y * e_x) - ahead * (c_x * e_x + c_y * e_y)
        far = np.sqrt((c_x * c_x + c_y * c_y) * (ahead * ahead + off * off))
        unaware[i] = ahead > 0.0 and facing <= _SEES * far
        near = ahead <= _REACH
        if ahead > 0.0 and (aside <= 0.0 or (near and stands)):
            slows = velocity[i, 0] ** 2 + velocity[i, 1] ** 2 < _SLOWS**2 * (c_x * c_x + c_y * c_y)
            yields[i] = STOPS if slows else KEEPS_ON
        to_x, to_y = waypoints[at, 0] - x, waypoints[at, 1] - y
        far = np.sqrt(to_x * to_x + to_y * to_y)
        if not (0.0 < ahead <= _REACH and 0.0 < aside <= _ASIDE and far > 0.0):
            continue
        side = -1.0 if lateral > 0.0 else 1.0
        n_x, n_y = -side * e_y, side * e_x  # unit vector towards the path
        share = (to_x * n_x + to_y * n_y) / far
        wish = desired_speed[i] * share
        if wish <= _TOWARDS:
            continue
        room = max(aside - _EDGE, 0.0) / share
        if told[n, slot] == look - every:
            was = expected[n, slot]
            off = (velocity[i, 0] - was[0]) * n_x + (velocity[i, 1] - was[1]) * n_y
            slower = taken_up * wish * (1.0 - room / np.sqrt(room * room + smoothing * smoothing))
            odds[n] = shifted(odds[n], off, slower, was[2] > 0.0)
        if odds[n] > 0.0:
            yields[i] = YIELDS
            pace = max((velocity[i, 0] * to_x + velocity[i, 1] * to_y) / far, 0.0)
            missing = desired_speed[i] * desired_speed[i] - pace * pace
            if missing > 0.0:  # the stopping point that VCI's slowing down implies
                room = min(room, _SWAY + smoothing * pace / np.sqrt(missing))
            for k in range(at, start[i + 1]):
                waypoints[k, 0] = x + room * to_x / far
                waypoints[k, 1] = y + room * to_y / far
                passage[k, 0], passage[k, 1], passage[k, 2] = 0.0, 0.0, 0.0
                signal[k] = -1
    return -1


@kernel
def _is_open(odds: Array, numbers: NDArray[np.int64]) -> bool:
    """Return whether all people are known and the intent of at least one is uncertain."""
    some = False
    for n in numbers:
        if n >= odds.size:
            return False
        some |= abs(odds[n]) < _OPEN
    return some


@inner
def shifted(odds: float, off: float, slower: float, yields: bool) -> float:
    """The log odds that a person yields, after a look.

    Args:
        odds: Log odds before the look.
        off: Observed minus predicted speed [m/s] towards the path.
        slower: Difference [m/s] by which a person who yields is slower than one who walks on.
        yields: Whether the prediction was that of a yielding person.
    """
    if yields:
        off -= slower
    # Speeds beyond those of the two hypotheses are clipped. Both have normal errors.
    off = min(max(off, -slower), 0.0)
    odds -= slower * (2.0 * off + slower) / (2.0 * _ERROR * _ERROR)
    return min(max(odds, -_SUREST), _SUREST)
