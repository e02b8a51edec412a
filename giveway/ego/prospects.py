"""What a predicted crowd means to a manoeuvre: gaps, persons on a collision course, calm speeds."""

from typing import Any, NamedTuple

import numpy as np

from giveway.ego.corridor import closest_in_front
from giveway.ego.threats import Alarm, conflicts_and_calm
from giveway.geometry.kernel import Array, inlined, kernel
from giveway.geometry.passage import window
from giveway.geometry.path import body_pose, segment_at

PASSED = 0.3  # [m] behind the front bumper pedestrians still count as in front, being squeezed by
_EVERY = 2  # steps from one search for conflicts to the next


class View(NamedTuple):
    """The ego's body and how it looks ahead, as the kernel takes it."""

    length: float  # of the body [m]
    width: float  # [m]
    half_width: float  # of the corridor [m]
    growth: float  # of it with the look-ahead, on each side [m/s]
    conflict_time: float  # time to collision of a conflict [s]
    time_step: float  # [s]


@kernel
def assess(
    vertices: Array,
    stations: Array,
    headings: Array,
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

    Conflicts and calm speeds are found at every second step and held in between. ``view`` and
    ``alarm`` are the numbers of a :class:`View` and an :class:`Alarm`.
    """
    for i in range(len(predicted)):
        assess_step(
            vertices,
            stations,
            headings,
            predicted,
            i,
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
def assess_step(
    vertices: Array,
    stations: Array,
    headings: Array,
    predicted: Array,
    i: int,
    front: float,
    distance: Array,
    speeds: Array,
    view: tuple[float, ...],
    alarm: tuple[Any, ...],
    gap: Array,
    conflicts: Array,
    calm: Array,
) -> None:
    """As :func:`assess` for step i + 1 alone, the positions one step later being known, too."""
    v, limits = View(*view), Alarm(*alarm)
    length, time_step = v.length, v.time_step
    first, last = window(stations, front, PASSED + length)
    at = front + distance[i + 1]
    wide = v.half_width + v.growth * (i + 1) * time_step
    closest, _ = closest_in_front(
        vertices, stations, first, last, predicted[i], at - PASSED, wide, 0.0
    )
    gap[i] = closest - at
    if i % _EVERY == 0 and i + 1 < len(predicted):
        x, y, heading = body_pose(vertices, stations, headings, at, length)
        stop = at + speeds[i + 1] * (time_step + speeds[i + 1] / (2.0 * limits.braking))
        braking_heading = heading
        if segment_at(stations, at - length) != segment_at(stations, stop) and stop > at:
            x_s, y_s, _ = body_pose(vertices, stations, headings, stop, 0.0)
            braking_heading = np.arctan2(y_s - y, x_s - x)
        conflicts[i], calm[i] = conflicts_and_calm(
            predicted[i],
            predicted[i + 1],
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
    elif i > 0:
        conflicts[i], calm[i] = conflicts[i - 1], calm[i - 1]
    else:
        conflicts[i], calm[i] = 0.0, np.inf
