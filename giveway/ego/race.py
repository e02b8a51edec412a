"""A race between manoeuvres in one compiled call: the cheapest so far is rolled out by a step.

A manoeuvre's cost never falls along its way, so that one whose cost so far exceeds another's whole
cost need not be looked at any farther: branch and bound, best first. Manoeuvres that begin alike
share the crowd's answer until they part. Neither changes a number of the winner.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from controller import Prospect, Verdict, add_cost_of_others, own_cost
from giveway.ego.corridor import set_pose
from giveway.ego.prospects import View, assess_step
from giveway.geometry.kernel import Array, inlined, kernel
from pedestrian_model import march, start

Arrays = tuple[NDArray[Any], ...]

_FINE = -1  # no pedestrian whose state is not finite


class Lanes:
    """Memory of a race: what each manoeuvre has led to so far.

    Args:
        count: of manoeuvres.
        horizon: N [steps].
        people: n, at most.

    Attributes:
        arrays: what the kernel takes.
    """

    def __init__(self, count: int, horizon: int, people: int) -> None:
        self.count, self.people, self._horizon = count, people, horizon
        self._state = np.empty(count * horizon * people * 4)
        self._index = np.empty(count * horizon * people, dtype=np.int64)
        self._prospects = np.zeros((3, count, horizon))  # gap, conflicts, calm
        self._sums = np.zeros((4, count))  # own cost, of others, missing distance, the whole
        self._steps = np.zeros((2, count), dtype=np.int64)  # predicted, assessed
        self._alike = np.zeros((count, count), dtype=np.int64)  # steps before they part
        self._entrants = np.zeros(count + 1, dtype=np.int64)
        self._bad = np.zeros(1, dtype=np.int64)
        self.arrays: Arrays = (
            self._state,
            self._index,
            self._prospects,
            self._sums,
            self._steps,
            self._alike,
            self._bad,
        )

    @property
    def bad(self) -> int:
        """A pedestrian whose predicted state is not finite; -1: none."""
        return int(self._bad[0])

    def order(self, entrants: list[int]) -> NDArray[np.int64]:
        """The entrants as an array."""
        order = self._entrants[: len(entrants)]
        order[:] = entrants
        return order

    def positions(self, k: int, n: int) -> Array:
        """(N, n, 2) [m] of the people under a manoeuvre that has finished."""
        size = self._horizon * n * 4
        return self._state[k * size : (k + 1) * size].reshape(self._horizon, n, 4)[:, :, :2]

    def verdict(self, best: int, first: int) -> Verdict:
        """How the race ended."""
        _, others, missing, whole = self._sums
        done = self._steps[1, first] == self._horizon
        prospect = Prospect(*self._prospects[:, best])
        return Verdict(
            int(best),
            float(whole[best]),
            float(missing[best]),
            bool(done and others[first] <= 0.0),
            prospect,
        )


@kernel
def run_race(
    path: Arrays,
    people: Arrays,
    law: tuple[Any, ...],
    poses: Array,
    row: int,
    front: float,
    view: tuple[float, ...],
    alarm: tuple[Any, ...],
    trials: Arrays,
    memory: Arrays,
    entrants: NDArray[np.int64],
    known: bool,
    lead: bool,
    allowed: Array,
    weights: tuple[Any, ...],
) -> int:
    """The row of the cheapest entrant, which has finished; -1: no cost is a number.

    Args:
        path: vertices, stations and headings of the ego's.
        people: what :func:`pedestrian_model.start` takes.
        law: the numbers of the model.
        poses: (N, m, 7) of all vehicles; the ego's row is changed.
        row: the ego's.
        front: its front bumper's station [m].
        view: the numbers of a ``View``.
        alarm: the numbers of an ``Alarm``.
        trials: of ``Trials``.
        memory: of :class:`Lanes`.
        entrants: rows of the trials; of equal ones the first wins.
        known: the first has finished in the race before.
        lead: the first runs until somebody is in its way, and wins if nobody is.
        allowed: (N,) [m].
        weights: of the cost.
    """
    distance, speed, acceleration, handicap = trials
    sums, steps, alike, bad = memory[3:]
    N, time_step = poses.shape[0], View(*view).time_step
    begun = 1 if known else 0
    ahead, scene, scratch = start(people)
    bad[0] = _FINE
    if not known:
        steps[:] = -1
    for e in range(begun, len(entrants)):
        k = entrants[e]
        enter(k, distance, speed, steps, alike)
        sums[0, k] = own_cost(speed[k], acceleration[k], time_step, weights)
        sums[1, k], sums[2, k] = 0.0, 0.0
    first = entrants[0]
    leads = lead
    while True:
        best, least = -1, np.inf
        if leads:
            best = first
            if time_step * sums[1, first] > 0.0:
                leads = False
                continue
            if steps[1, first] == N:
                sums[3, first] = sums[0, first] + handicap[first]
                break
        else:
            for e in range(len(entrants)):
                k = entrants[e]
                bound = sums[3, k] = sums[0, k] + time_step * sums[1, k] + handicap[k]
                if bound < least:
                    best, least = k, bound
            if best < 0 or steps[1, best] == N:
                break
        bad[0] = advance(
            best,
            path,
            people,
            ahead,
            scene,
            scratch,
            law,
            poses,
            row,
            front,
            view,
            alarm,
            distance,
            speed,
            memory,
            allowed,
            weights,
        )
        if bad[0] != _FINE:
            break
    return best


@kernel
def enter(
    k: int, distance: Array, speed: Array, steps: NDArray[np.int64], alike: NDArray[np.int64]
) -> None:
    """Set a manoeuvre to its start, and find how long it is like those that have started."""
    steps[0, k] = steps[1, k] = 0
    for other in range(steps.shape[1]):
        if other == k or steps[0, other] < 0:
            continue
        same, N = 0, distance.shape[1] - 1
        while (
            same <= N
            and distance[k, same] == distance[other, same]
            and speed[k, same] == speed[other, same]
        ):
            same += 1
        alike[k, other] = alike[other, k] = same


@inlined
def advance(
    k: int,
    path: Arrays,
    people: Arrays,
    ahead: Any,
    scene: Any,
    scratch: Any,
    law: tuple[Any, ...],
    poses: Array,
    row: int,
    front: float,
    view: tuple[float, ...],
    alarm: tuple[Any, ...],
    distance: Array,
    speed: Array,
    memory: Arrays,
    allowed: Array,
    weights: tuple[Any, ...],
) -> int:
    """Roll manoeuvre k out by one step; -1, or a pedestrian whose state is not finite."""
    vertices, stations, headings = path
    state, index, prospects, sums, steps, alike, _ = memory
    x, v, at = ahead
    N, n = poses.shape[0], x.shape[0]
    i = steps[0, k]
    here = (k * N + i) * n
    donor = -1
    for other in range(steps.shape[1]):
        if other != k and steps[0, other] > i and alike[k, other] > i:
            donor = other
    if donor >= 0:
        there = (donor * N + i) * n
        state[4 * here : 4 * (here + n)] = state[4 * there : 4 * (there + n)]
        index[here : here + n] = index[there : there + n]
    else:
        if i == 0:
            start(people)
        else:
            before = here - n
            for j in range(n):
                base = 4 * (before + j)
                x[j, 0], x[j, 1] = state[base], state[base + 1]
                v[j, 0], v[j, 1] = state[base + 2], state[base + 3]
                at[j] = index[before + j]
        station = front + distance[k, i]
        set_pose(
            vertices, stations, headings, station, speed[k, i], View(*view).length, poses[i, row]
        )
        bad = march(ahead, scene, poses[i], scratch, *law)
        if bad != _FINE:
            return bad
        for j in range(n):
            base = 4 * (here + j)
            state[base], state[base + 1] = x[j, 0], x[j, 1]
            state[base + 2], state[base + 3] = v[j, 0], v[j, 1]
            index[here + j] = at[j]
    steps[0, k] = i + 1
    predicted = state[4 * k * N * n : 4 * (k + 1) * N * n].reshape(N, n, 4)
    while steps[1, k] < (i if i + 1 < N else N):
        s = steps[1, k]
        donor = -1
        for other in range(steps.shape[1]):
            if other != k and steps[1, other] > s and alike[k, other] - 1 > s:
                donor = other
        if donor >= 0:
            prospects[:, k, s] = prospects[:, donor, s]
        else:
            assess_step(
                vertices,
                stations,
                headings,
                predicted,
                s,
                front,
                distance[k],
                speed[k],
                view,
                alarm,
                prospects[0, k],
                prospects[1, k],
                prospects[2, k],
            )
        sums[1, k], sums[2, k] = add_cost_of_others(
            sums[1, k],
            sums[2, k],
            speed[k, s + 1],
            prospects[0, k, s],
            prospects[1, k, s],
            prospects[2, k, s],
            distance[k, s + 1] - allowed[s],
            weights,
        )
        steps[1, k] = s + 1
    return _FINE
