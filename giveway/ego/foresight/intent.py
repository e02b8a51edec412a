"""The intent of people, to walk on or to let the ego pass, estimated from what they do.

A planner that believes in one model of people is wrong about those who walk by another. Of each
person beside the way who wants to cross it two hypotheses are kept:

* *walks on*, as the model says;
* *yields*: walks up to the edge of the way, or where their pace says that they stop, and stands
  there, whatever the ego does.

Both say how fast the person is one step of the prediction later. Seen speeds shift the log odds
between the two (sequential probability ratio, Wald 1945). Whoever more likely yields is predicted,
and thereby planned for, with that place as destination.
"""

from math import exp
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.ego.foresight.later_crossings import abreast
from giveway.geometry.kernel import Array, inlined, inner, kernel
from giveway.geometry.path import EgoPath, segment_at
from pedestrian_model import Crowd, Predictor

_ERROR = 0.1  # [m/s] of a speed predicted a step ahead: one standard deviation
_PRIOR = -3.0  # log odds of somebody who has not been seen yet: 1 in 21 yields
_SUREST = 4.0  # log odds go no farther than this, so that people may change their minds
_REACH = 25.0  # [m] ahead of the front
_ASIDE = 6.0  # [m] from the edge of the way; from there on nobody slows down for it yet
_TOWARDS = 0.3  # [m/s] of the wish towards the way, at least: others do not want to cross it
_EDGE = 0.05  # [m] before the edge of the way is where people stop: rounding leaves nobody on it
_SWAY = 0.1  # [m] farther than their pace says people may yet come: who stands is not pinned
_OPEN = 2.0  # log odds nearer to 0 than this leave somebody's intent open
_NEVER = -1  # a look that none is

Halting = tuple[NDArray[np.bool_], float, float, float]


class Otherwise(NamedTuple):
    """People of whom some do the less likely of two things."""

    people: Crowd  # the ways of those who then yield are changed
    halting: Halting  # as of :class:`Beliefs`
    likely: float  # how likely the other hypothesis is, the more likely one


class Beliefs:
    """Remembers of each person, by number, how likely they let the ego pass.

    Args:
        path: the ego's.
        half_width: Half width of its corridor [m], the way.
        predictor: Predictor of the model by which people walk on.
        time_step: [s] between two looks; the predictor's is some of them.
    """

    def __init__(
        self,
        path: EgoPath,
        half_width: float,
        predictor: Predictor,
        time_step: float,
    ) -> None:
        walking = predictor.parameters
        # People take up a wish v_d as by f_d = k_des (v_d - v).
        taken_up = 1.0 - exp(-predictor.time_step * walking.destination_gain / walking.mass)
        self._law = half_width, taken_up, walking.destination_smoothing
        self._step = predictor.time_step
        every = round(predictor.time_step / time_step)
        self._way = path.vertices, path.stations
        self._every, self._look = every, every
        self._odds = np.zeros(0)
        self._told = np.zeros((0, every), dtype=np.int64)
        self._expected = np.zeros((0, every, 3))
        self._numbers, self._yield = np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.bool_)

    def odds(self, number: int) -> float:
        """The log odds that a person yields."""
        return float(self._odds[number]) if number < len(self._odds) else _PRIOR

    @property
    def halting(self) -> Halting:
        """The people who yield, as of the latest look, and what :func:`walk_up` needs."""
        return self._yield, *self._law[1:], self._step

    def weigh(
        self, people: Crowd, numbers: NDArray[np.int64], front: float, expected: Array
    ) -> Otherwise | None:
        """Update, and return the alternative in which people of open intent do the less likely.

        None: nobody's is, or that is no other expectation.
        """
        if not _is_open(self._odds, numbers):
            self.update(people, numbers, front, expected)
            return None
        intent = np.abs(self._odds[numbers]) < _OPEN
        other = people.select(np.ones(len(people), dtype=np.bool_))
        self.update(people, numbers, front, expected)
        odds, yields = self._odds.copy(), np.zeros(len(numbers), dtype=np.bool_)
        odds[numbers[intent]] *= -1.0
        seen = (*other.state, other.desired_speed, *other.routes)
        none = np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.bool_), np.zeros(0)
        memory = odds, self._told, self._expected
        _update(*self._way, front, seen, numbers, _NEVER, none, memory, yields, self._law)
        differ = yields != self._yield
        if not differ.any():
            return None
        least = float(np.abs(odds[numbers[differ]]).min())
        halting = yields, *self._law[1:], self._step
        return Otherwise(other, halting, 1.0 / (1.0 + exp(-least)))

    def update(
        self, people: Crowd, numbers: NDArray[np.int64], front: float, expected: Array
    ) -> None:
        """See how people walk now, and send those who are believed to yield to the edge only.

        Args:
            people: People as they are seen; the ways of those who yield are changed.
            numbers: (n,) who they are.
            front: the front bumper's station [m].
            expected: (4 m,) x, y [m], v_x, v_y [m/s] of the m people of the latest look, where its
                prediction had them after a step; (0,): it made none.
        """
        yields = np.zeros(len(numbers), dtype=np.bool_)
        seen = (*people.state, people.desired_speed, *people.routes)
        latest = (self._numbers, self._yield, expected)
        while True:
            memory = (self._odds, self._told, self._expected)
            new = _update(
                *self._way, front, seen, numbers, self._look, latest, memory, yields, self._law
            )
            if new < 0:
                break
            self._grow(2 * (new + 1) - len(self._odds))
        self._numbers, self._yield = numbers, yields
        self._look += 1

    def _grow(self, more: int) -> None:
        """Make room for the numbers of more people."""
        self._odds = np.concatenate([self._odds, np.full(more, _PRIOR)])
        never = np.full((more, self._every), _NEVER)
        self._told = np.concatenate([self._told, never])
        self._expected = np.concatenate([self._expected, np.zeros((more, self._every, 3))])


@kernel
def _update(
    vertices: Array,
    stations: Array,
    front: float,
    people: tuple[Any, ...],
    numbers: NDArray[np.int64],
    look: int,
    latest: tuple[NDArray[np.int64], NDArray[np.bool_], Array],
    memory: tuple[Array, NDArray[np.int64], Array],
    yields: NDArray[np.bool_],
    law: tuple[float, float, float],
) -> int:
    """Update as :meth:`Beliefs.update` does; return -1, or a number that needs more memory.

    Args:
        vertices: Vertices of the path.
        stations: [m] of these.
        front: station [m].
        people: state, desired speeds and routes.
        numbers: (n,).
        look: counts the looks.
        latest: Latest of the latest look: numbers, who was believed to yield, what was expected.
        memory: Log odds by number; and by number and look: the look at which speeds [m/s] were
            expected, these speeds, and (1) whether those of a yielding person.
        yields: (n,) filled: who is believed to yield.
        law: half-width [m], share of a wish that is taken up in a step, s_des [m].
    """
    position, velocity, index, desired_speed, waypoints, passage, signal, start = people
    odds, told, expected = memory
    half_width, taken_up, smoothing = law
    for i in range(len(numbers)):
        if numbers[i] >= len(odds):
            return int(numbers[i])
    every = told.shape[1]
    before, yielded, outcome = latest
    if len(outcome) > 0:
        slot = (look - 1) % every
        for i in range(len(before)):
            n = before[i]
            told[n, slot] = look - 1
            expected[n, slot, 0], expected[n, slot, 1] = outcome[4 * i + 2], outcome[4 * i + 3]
            expected[n, slot, 2] = yielded[i]
    slot = look % every
    first, last = segment_at(stations, front), segment_at(stations, front + _REACH)
    for i in range(len(numbers)):
        x, y, n, at = position[i, 0], position[i, 1], numbers[i], start[i] + index[i]
        station, lateral, e_x, e_y = abreast(vertices, stations, first, last, x, y)
        ahead, aside = station - front, abs(lateral) - half_width
        to_x, to_y = waypoints[at, 0] - x, waypoints[at, 1] - y
        far = np.sqrt(to_x * to_x + to_y * to_y)
        if not (0.0 < ahead <= _REACH and 0.0 < aside <= _ASIDE and far > 0.0):
            continue
        side = -1.0 if lateral > 0.0 else 1.0
        n_x, n_y = -side * e_y, side * e_x  # towards the way
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
            yields[i] = True
            pace = max((velocity[i, 0] * to_x + velocity[i, 1] * to_y) / far, 0.0)
            missing = desired_speed[i] * desired_speed[i] - pace * pace
            if missing > 0.0:  # slowing down as VCI does towards a destination; where is that?
                room = min(room, _SWAY + smoothing * pace / np.sqrt(missing))
            for k in range(at, start[i + 1]):
                waypoints[k, 0] = x + room * to_x / far
                waypoints[k, 1] = y + room * to_y / far
                passage[k, 0], passage[k, 1], passage[k, 2] = 0.0, 0.0, 0.0
                signal[k] = -1
    return -1


@kernel
def _is_open(odds: Array, numbers: NDArray[np.int64]) -> bool:
    """Return whether anybody's intent is open, and all are known."""
    some = False
    for n in numbers:
        if n >= odds.size:
            return False
        some |= abs(odds[n]) < _OPEN
    return some


@inlined
def walk_up(
    halting: tuple[Any, ...], at: int, state: Array, scene: Any, position: Array, velocity: Array
) -> None:
    """Let those who yield go on for a step as by their wish alone; in place.

    Nobody's push, the ego's least of all, makes room that who stands at the edge does not give.

    Args:
        halting: see :attr:`Beliefs.halting`.
        at: where in ``state`` the step before begins.
        state: State by person: x, y [m], v_x, v_y [m/s].
        scene: Scene of the prediction.
        position: (n, 2) [m] of everybody after the step.
        velocity: (n, 2) [m/s].
    """
    yields, taken_up, smoothing, dt = halting
    waypoints, _, _, begin = scene.routes
    for p in range(position.shape[0]):
        if not yields[p]:
            continue
        base, last = at + 4 * p, begin[p + 1] - 1
        to_x, to_y = waypoints[last, 0] - state[base], waypoints[last, 1] - state[base + 1]
        gain = scene.desired_speed[p] / np.sqrt(to_x * to_x + to_y * to_y + smoothing * smoothing)
        v_x, v_y = state[base + 2], state[base + 3]
        v_x, v_y = v_x + taken_up * (gain * to_x - v_x), v_y + taken_up * (gain * to_y - v_y)
        velocity[p, 0], velocity[p, 1] = v_x, v_y
        position[p, 0], position[p, 1] = state[base] + dt * v_x, state[base + 1] + dt * v_y


@inner
def shifted(odds: float, off: float, slower: float, yields: bool) -> float:
    """The log odds that somebody yields, after a look.

    Args:
        odds: Odds before it.
        off: [m/s] by which the person is faster towards the way than was predicted.
        slower: [m/s] by which one who yields is slower than one who walks on.
        yields: whether that was predicted.
    """
    if yields:
        off -= slower
    # Neither hypothesis gains by what is beyond the other. Both have normal errors.
    off = min(max(off, -slower), 0.0)
    odds -= slower * (2.0 * off + slower) / (2.0 * _ERROR * _ERROR)
    return min(max(odds, -_SUREST), _SUREST)
