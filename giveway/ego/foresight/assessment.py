"""The assessment of a manoeuvre in a predicted crowd: gaps, threat-free and passing speeds."""

from typing import Any, NamedTuple

import numpy as np

from controller.driving_constants import CREEPS_PAST
from giveway.ego.foresight.threats import Alarm, threat_free_and_passing
from giveway.ego.perception.corridor import closest_in_front
from giveway.geometry.kernel import Array, inlined, kernel
from giveway.geometry.passage import window
from giveway.geometry.path import body_pose, segment_at

PASSED = 0.3  # distance [m] behind the front bumper, up to which pedestrians count as in front


class View(NamedTuple):
    """The ego's body and the constants of its foresight, as the kernel takes them."""

    length: float  # length of the body [m]
    width: float  # width of the body [m]
    half_width: float  # half width of the corridor [m]
    time_step: float  # time step of a manoeuvre [s]
    every: float  # number of a manoeuvre's steps in one prediction step of the crowd


@kernel
def assess(
    path: tuple[Array, Array, Array],
    crowd: tuple[Array, Array],
    front: float,
    manoeuvre: tuple[Array, Array],
    sight: tuple[tuple[float, ...], tuple[Any, ...], float],
    evaluation: tuple[Array, Array, Array],
) -> None:
    """Fill gaps in front, threat-free and passing speeds at steps 1 ... N.

    Threat-free and passing speeds are computed at the first step of each prediction interval and
    held to its end. Between predictions people move along straight lines.

    Args:
        path: Vertices, stations and headings of the ego's path.
        crowd: Positions now, (n, 2) [m], and at each ``every``-th step, (M, n, 2).
        front: Station of the front bumper [m].
        manoeuvre: Distances [m] and speeds [m/s] of the manoeuvre, (N + 1,) each.
        sight: Fields of a :class:`View` and of an :class:`Alarm`; distance [m] by which people who
            may not see a creeping ego count as nearer, 0 if it does not creep.
        evaluation: Gaps [m], threat-free and passing speeds [m/s], (N,) each, filled.
    """
    now, predicted = crowd
    between = np.empty((now.shape[0], 2))
    for j in range(len(predicted)):
        people = (predicted[j - 1] if j > 0 else now, predicted[j], between)
        assess_step(path, people, (j, len(predicted)), front, manoeuvre, sight, evaluation)


@inlined
def interval_of(j: int, every: int, predicted: int, horizon: int) -> tuple[int, int]:
    """The half-open range of a manoeuvre's step indices, from 0, in the j-th prediction step.

    The last prediction step has all the remaining ones.

    Args:
        j: Index of the prediction step, from 0.
        every: Number of a manoeuvre's steps in one prediction step, as in :class:`View`.
        predicted: Number M of prediction steps.
        horizon: Number N of the manoeuvre's steps.
    """
    return j * every, horizon if j + 1 == predicted else (j + 1) * every


@inlined
def assess_step(
    path: tuple[Array, Array, Array],
    people: tuple[Array, Array, Array],
    which: tuple[int, int],
    front: float,
    manoeuvre: tuple[Array, Array],
    sight: tuple[tuple[float, ...], tuple[Any, ...], float],
    evaluation: tuple[Array, Array, Array],
) -> None:
    """Fill as :func:`assess` does, for one prediction step only.

    Args:
        path: Vertices, stations and headings of the ego's path.
        people: Positions before and after the prediction step, and scratch, (n, 2) [m] each.
        which: Index of the prediction step, and the number of prediction steps.
        front: Station of the front bumper [m].
        manoeuvre: Distances [m] and speeds [m/s] of the manoeuvre, (N + 1,) each.
        sight: Fields of a :class:`View` and of an :class:`Alarm`; distance [m] by which people who
            may not see a creeping ego count as nearer, 0 if it does not creep.
        evaluation: Gaps [m], threat-free and passing speeds [m/s], (N,) each, filled.
    """
    (vertices, stations, headings), (before, after, between) = path, people
    (j, predicted), (distance, speeds) = which, manoeuvre
    gap, threat_free, passing = evaluation
    view, alarm, creeps = sight
    v, limits = View(*view), Alarm(*alarm)
    length, time_step, every = v.length, v.time_step, int(v.every)
    first, last = window(stations, front, PASSED + length)
    half_width = v.half_width
    if creeps > 0.0:
        half_width = min(half_width, v.width / 2.0 + limits.radius + CREEPS_PAST)
    begin, end = interval_of(j, every, predicted, len(gap))
    for i in range(begin, end):
        share = min((i + 1 - begin) / every, 1.0)
        for p in range(between.shape[0]):
            between[p, 0] = before[p, 0] + share * (after[p, 0] - before[p, 0])
            between[p, 1] = before[p, 1] + share * (after[p, 1] - before[p, 1])
        at = front + distance[i + 1]
        closest, _ = closest_in_front(
            vertices, stations, (first, last), between, at - PASSED, half_width, 0.0
        )
        for p in range(limits.unaware.shape[0] if creeps > 0.0 else 0):
            if limits.unaware[p]:
                alone = between[p : p + 1]
                station, _ = closest_in_front(
                    vertices, stations, (first, last), alone, at - PASSED, half_width, 0.0
                )
                closest = min(closest, station - creeps)
        gap[i] = closest - at
        if i > begin:
            threat_free[i], passing[i] = threat_free[begin], passing[begin]
            continue
        x, y, heading = body_pose(vertices, stations, headings, at, length)
        stop = at + speeds[i + 1] * (time_step + speeds[i + 1] / (2.0 * limits.braking))
        braking_heading = heading
        if segment_at(stations, at - length) != segment_at(stations, stop) and stop > at:
            x_s, y_s, _ = body_pose(vertices, stations, headings, stop, 0.0)
            braking_heading = np.arctan2(y_s - y, x_s - x)
        threat_free[i], passing[i] = threat_free_and_passing(
            (between, before, after),
            (x, y, heading, braking_heading),
            speeds[i + 1],
            (length / 2.0, v.width / 2.0),
            (every * time_step, time_step, (i + 1) * time_step),
            limits,
        )
