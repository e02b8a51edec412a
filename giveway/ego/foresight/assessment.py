"""What a predicted crowd means to a manoeuvre: gaps, persons on a collision course, calm speeds."""

from typing import Any, NamedTuple

import numpy as np

from giveway.ego.corridor import closest_in_front
from giveway.ego.foresight.threats import Alarm, conflicts_and_calm
from giveway.geometry.kernel import Array, inlined, kernel
from giveway.geometry.passage import window
from giveway.geometry.path import body_pose, segment_at

PASSED = 0.3  # [m] behind the front bumper pedestrians still count as in front, being squeezed by


class View(NamedTuple):
    """The ego's body and how it looks ahead, as the kernel takes it."""

    length: float  # of the body [m]
    width: float  # [m]
    half_width: float  # of the corridor [m]
    conflict_time: float  # time to collision of a conflict [s]
    time_step: float  # of a manoeuvre [s]
    every: float  # steps of a manoeuvre, a whole number, in which the crowd is predicted at once


@kernel
def assess(
    vertices: Array,
    stations: Array,
    headings: Array,
    now: Array,
    predicted: Array,
    front: float,
    distance: Array,
    speeds: Array,
    view: tuple[float, ...],
    alarm: tuple[Any, ...],
    gap: Array,
    conflicts: Array,
    calm: Array,
) -> None:
    """Fill gaps in front, persons on a collision course, and calm speeds at steps 1 ... N.

    The crowd is known ``now`` (n, 2) [m] and at each ``every``-th step, ``predicted`` (M, n, 2),
    and walks straight on in between. Conflicts and calm speeds are found at the first step after
    each of these and held until the next. ``view`` and ``alarm`` are the numbers of a
    :class:`View` and an :class:`Alarm`.
    """
    between = np.empty((now.shape[0], 2))
    for j in range(len(predicted)):
        assess_step(
            vertices,
            stations,
            headings,
            predicted[j - 1] if j > 0 else now,
            predicted[j],
            j,
            len(predicted),
            between,
            front,
            distance,
            speeds,
            view,
            alarm,
            gap,
            conflicts,
            calm,
        )


@inlined
def interval_of(j: int, every: int, predicted: int, horizon: int) -> tuple[int, int]:
    """The steps (less one) of a manoeuvre in the j-th of the predicted ones; the last has the rest.

    Args:
        j: from 0.
        every: see :class:`View`.
        predicted: M, how many.
        horizon: N [steps] of the manoeuvre.
    """
    return j * every, horizon if j + 1 == predicted else (j + 1) * every


@inlined
def assess_step(
    vertices: Array,
    stations: Array,
    headings: Array,
    before: Array,
    after: Array,
    j: int,
    predicted: int,
    between: Array,
    front: float,
    distance: Array,
    speeds: Array,
    view: tuple[float, ...],
    alarm: tuple[Any, ...],
    gap: Array,
    conflicts: Array,
    calm: Array,
) -> None:
    """As :func:`assess` for the j-th of the predicted steps alone.

    ``before`` and ``after`` it people are there; ``between`` (n, 2) is memory.
    """
    v, limits = View(*view), Alarm(*alarm)
    length, time_step, every = v.length, v.time_step, int(v.every)
    first, last = window(stations, front, PASSED + length)
    begin, end = interval_of(j, every, predicted, len(gap))
    for i in range(begin, end):
        share = min((i + 1 - begin) / every, 1.0)
        for p in range(between.shape[0]):
            between[p, 0] = before[p, 0] + share * (after[p, 0] - before[p, 0])
            between[p, 1] = before[p, 1] + share * (after[p, 1] - before[p, 1])
        at = front + distance[i + 1]
        closest, _ = closest_in_front(
            vertices, stations, first, last, between, at - PASSED, v.half_width, 0.0
        )
        gap[i] = closest - at
        if i > begin:
            conflicts[i], calm[i] = conflicts[begin], calm[begin]
            continue
        x, y, heading = body_pose(vertices, stations, headings, at, length)
        stop = at + speeds[i + 1] * (time_step + speeds[i + 1] / (2.0 * limits.braking))
        braking_heading = heading
        if segment_at(stations, at - length) != segment_at(stations, stop) and stop > at:
            x_s, y_s, _ = body_pose(vertices, stations, headings, stop, 0.0)
            braking_heading = np.arctan2(y_s - y, x_s - x)
        conflicts[i], calm[i] = conflicts_and_calm(
            between,
            before,
            after,
            every * time_step,
            x,
            y,
            heading,
            braking_heading,
            speeds[i + 1],
            length / 2.0,
            v.width / 2.0,
            v.conflict_time,
            time_step,
            limits,
        )
