"""The kernels of the safety layer: stopping profiles, compared with what people can reach."""

from math import sqrt
from typing import NamedTuple

import numpy as np

from controller._jit import Array, inner
from controller.safety.actuator_bound import Lagging, bound_step

_BETWEEN = 3  # number of poses of the front in a bend, besides the last, that a box encloses


class EgoMotion(NamedTuple):
    """The limits of the ego's motion."""

    slowest_decay: float  # largest share of the speed left after a step: exp(-alpha dt / M)
    fastest_decay: float  # least share of the speed left after a step: 1 - alpha dt / M
    gain: float  # largest change of speed per force in a step: dt / M [(m/s)/N]
    braking_gain: float  # least change of speed per braking force in a step [(m/s)/N]
    force_limit: float  # largest force u_max [N]
    force_rate_limit: float  # largest change of force [N per step]


class Walking(NamedTuple):
    """The limits of people's motion."""

    acceleration: float  # largest acceleration a_max [m/s^2]
    speed: float  # largest speed v_max [m/s]
    setting_out: float  # largest acceleration a_k [m/s^2] from a sidewalk towards the kerb


class Limits(NamedTuple):
    """The limits of the ego's and people's motion."""

    time_step: float  # control step dt [s]
    ego: EgoMotion
    people: Walking
    half_width: float  # half width of the ego [m]
    body_radius: float  # radius R [m] of a person's body
    margin: float  # least distance [m] of the front to a body
    lagging: Lagging = Lagging()  # lags of the ego's actuator


def packed(limits: Limits) -> Array:
    """Return all numbers of ``limits`` in one array, in which kernels receive them."""
    time_step, ego, people, *distances, lagging = limits
    return np.array([time_step, *ego, *people, *distances, *lagging])


@inner
def unpacked(numbers: Array) -> Limits:
    """Return the limits that :func:`packed` has put into ``numbers``."""
    n = numbers
    ego = EgoMotion(n[1], n[2], n[3], n[4], n[5], n[6])
    lagging = Lagging(n[13], n[14], n[15], n[16], n[17])
    return Limits(n[0], ego, Walking(n[7], n[8], n[9]), n[10], n[11], n[12], lagging)


@inner
def _strongest(i: int, force: float, commands: Array, c: Limits) -> float:
    """The largest force [N] that may act in step i.

    It is one of the commands within the reaction time before. These are the past commands, then
    ``force``, then full braking.
    """
    delay = commands.shape[0] - 1
    strongest = -c.ego.force_limit
    for command in range(i - delay, i + 1):
        if command < 0:
            f = commands[commands.shape[0] + command]
        elif command == 0:
            f = force
        else:
            f = force - command * c.ego.force_rate_limit
        strongest = max(strongest, f)
    return strongest


@inner
def _pose(way: Array, spacing: float, travel: float) -> tuple[float, float, float, float]:
    """Return x, y [m] and cos, sin of the heading of the front after ``travel`` [m]."""
    last = way.shape[0] - 1
    i = min(int(travel / spacing), last)
    rest = travel - i * spacing
    x, y, cos, sin = way[i, 0], way[i, 1], way[i, 2], way[i, 3]
    if i == last:
        return x + rest * cos, y + rest * sin, cos, sin
    w = rest / spacing
    x, y = x + w * (way[i + 1, 0] - x), y + w * (way[i + 1, 1] - y)
    cos, sin = cos + w * (way[i + 1, 2] - cos), sin + w * (way[i + 1, 3] - sin)
    size = sqrt(cos * cos + sin * sin)
    return x, y, cos / size, sin / size


@inner
def _sweep(way: Array, spacing: float, low: float, high: float, half: float, box: Array) -> None:
    """Fill ``box`` with the rectangle that holds the front from ``low`` to ``high`` [m] of travel.

    Columns 0 to 3 are x, y, cos, sin of its frame. Columns 4 to 7 are its extents along and across
    [m]. Column 8 is not changed.
    """
    if way.shape[0] == 1:
        box[0], box[1], box[2], box[3] = way[0, 0], way[0, 1], way[0, 2], way[0, 3]
        box[4], box[5], box[6], box[7] = low, high, -half, half
        return
    x_0, y_0, cos, sin = _pose(way, spacing, high)
    box[0], box[1], box[2], box[3] = x_0, y_0, cos, sin
    box[4], box[5], box[6], box[7] = 0.0, 0.0, -half, half
    for i in range(_BETWEEN):
        x, y, c, s = _pose(way, spacing, low + i * (high - low) / _BETWEEN)
        for side in (-half, half):
            d_x, d_y = x - side * s - x_0, y + side * c - y_0
            along, across = d_x * cos + d_y * sin, d_y * cos - d_x * sin
            box[4], box[5] = min(box[4], along), max(box[5], along)
            box[6], box[7] = min(box[6], across), max(box[7], across)


@inner
def _clearance(travel: float, c: Limits) -> float:
    """Return the clearance [m] at both ends of a step that keeps at least R in between.

    A person's centre moves by at most L relative to the front, on a line with an error of
    a_max dt^2/8. A chord of length L between two points outside of a circle of radius r has a
    distance of at least sqrt(r^2 - L^2/4) to the centre.

    Args:
        travel: Largest distance [m] that the front travels in the step.
        c: Limits of the ego's and people's motion.
    """
    L = travel + c.people.speed * c.time_step
    between = sqrt(c.body_radius * c.body_radius + 0.25 * L * L)
    between += 0.125 * c.people.acceleration * c.time_step * c.time_step
    return max(c.body_radius + c.margin, between)


@inner
def _least_travel(speed: float, after: float, dt: float) -> float:
    """Return the least distance [m] of a braking step from ``speed`` to ``after`` [m/s].

    If ``after`` is below 0, the ego stops within the step.
    """
    if after >= 0.0:
        return 0.5 * dt * (speed + after)
    return 0.5 * dt * speed * speed / (speed - after)


@inner
def _stop(
    force: float,
    speed: float,
    way: Array,
    spacing: float,
    c: Limits,
    memory: tuple[Array, Array, Array],
) -> tuple[int, float]:
    """Fill the rectangles that hold the front at each instant of a stop.

    The least travel is that of full braking from now on. The largest one is that of ``force``,
    followed by full braking. The rectangles hold the front between the two, so they grow with the
    force. Row j is for the end of step j - 1 and the start of step j. Its column 8 is the clearance
    that both steps need, or -1 if the ego stands in both.

    The memory is as for :func:`is_safe`.

    Returns:
        Number of steps until the ego stands, -1 if it does not stop; largest travel [m].
    """
    commands, boxes, acting = memory
    dt, delay = c.time_step, commands.shape[0] - 1
    state = acting[0], acting[1], acting[2]
    low = high = 0.0
    slowest, fastest = max(speed - acting[3], 0.0), speed
    _sweep(way, spacing, 0.0, 0.0, c.half_width, boxes[0])
    boxes[0, 8] = -1.0
    for j in range(boxes.shape[0] - 1):
        f = _strongest(j, force, commands, c)
        driven, braked, ends, state = bound_step(f, state, c.lagging)
        stands = fastest <= 0.0 and ends[0] <= 0.0
        if stands and j > delay:
            return j, high
        gained = driven * c.ego.gain - braked * c.ego.braking_gain
        after = max(0.0, c.ego.slowest_decay * fastest + gained)
        travel = 0.5 * dt * (fastest + max(fastest, after))
        if not stands:  # the force falls within the step: its speed is above the straight line
            travel += 0.125 * dt * c.ego.gain * (ends[0] - ends[1])
        clearance = _clearance(travel, c) if travel > 0.0 else -1.0
        _sweep(way, spacing, low, high + travel, c.half_width, boxes[j + 1])
        boxes[j, 8], boxes[j + 1, 8] = max(boxes[j, 8], clearance), clearance
        slower = c.ego.fastest_decay * slowest - c.ego.gain * c.ego.force_limit
        if slowest > 0.0:
            low += _least_travel(slowest, slower, dt)
        slowest = max(0.0, slower)
        high, fastest = high + travel, after
    return -1, high


@inner
def _touches(
    box: Array, x: float, y: float, radius: float, error: float, slack: float, c: Limits
) -> bool:
    """Return whether a body with its centre within ``radius`` of (x, y) may touch the front's box.

    Args:
        box: Rectangle of the front, and clearance.
        x: Coordinate [m].
        y: Coordinate [m].
        radius: Radius [m] of the disc in which the centre is.
        error: Largest error [m] of (x, y).
        slack: Distance [m] added to the clearance.
        c: Limits of the ego's and people's motion.
    """
    d_x, d_y = x - box[0], y - box[1]
    along, across = d_x * box[2] + d_y * box[3], d_y * box[2] - d_x * box[3]
    behind = c.people.speed * c.time_step + error  # distance [m] that a person walks in a step
    if along + radius < box[4] - behind:
        return False  # the person can only walk into the side of the body
    off = max(box[4] - along, 0.0, along - box[5])
    aside = max(box[6] - across, 0.0, across - box[7])
    reach = radius + (box[8] + error) + slack
    touched: bool = off * off + aside * aside <= reach * reach
    return touched


@inner
def _may_meet(
    person: tuple[float, float, float, float, float, float],
    kerb: tuple[float, float, float],
    steps: int,
    slack: float,
    c: Limits,
    boxes: Array,
) -> bool:
    """Return whether a person perceived at (x, y) with velocity (v_x, v_y) can meet the front.

    A person who accelerates by at most a_max is within a_max t^2/2 of x + v t; if v may be off by
    dv, within dv t + a_max t^2/2. A person who walks at most at v_max is within v_max t of x. A
    person on a sidewalk, ``depth`` [m] from the kerb in the direction (to_x, to_y), gets no farther
    in this direction than :func:`towards_kerb` says.

    Args:
        person: Position x, y [m], velocity v_x, v_y [m/s], and largest errors of the position [m]
            and of the velocity [m/s].
        kerb: Unit vector to the kerb (to_x, to_y), and its distance [m]; 0 off the sidewalk.
        steps: Number of steps until the ego stands.
        slack: Distance [m] added to the clearance.
        c: Limits of the ego's and people's motion.
        boxes: Rectangles that hold the front, one for each instant.
    """
    (x, y, v_x, v_y, error, off), (to_x, to_y, depth) = person, kerb
    for j in range(steps + 1):
        box = boxes[j]
        if box[8] < 0.0:
            continue
        t = j * c.time_step
        accelerated = off * t + 0.5 * c.people.acceleration * t * t
        if not _touches(box, x + v_x * t, y + v_y * t, accelerated, error, slack, c):
            continue
        if not _touches(box, x, y, c.people.speed * t, error, slack, c):
            continue
        if depth <= error:
            return True
        pace = v_x * to_x + v_y * to_y + off
        nearer = towards_kerb(t, pace, depth - error, c.people.setting_out, c.people.acceleration)
        between = _nearest(box, to_x, to_y) - (x * to_x + y * to_y)
        if between - nearer <= box[8] + error + slack:
            return True
    return False


@inner
def towards_kerb(t: float, pace: float, depth: float, setting_out: float, most: float) -> float:
    """Return the largest distance [m] that a person on a sidewalk walks towards the kerb.

    Args:
        t: Time [s] from now on.
        pace: Speed [m/s] towards the kerb now.
        depth: Distance [m] to the kerb, > 0.
        setting_out: Largest acceleration [m/s^2] until the person reaches the kerb.
        most: Largest acceleration [m/s^2] beyond the kerb.
    """
    fastest = sqrt(pace * pace + 2.0 * setting_out * depth)
    there = (fastest - pace) / setting_out
    if t <= there:
        return pace * t + 0.5 * setting_out * t * t
    rest = t - there
    return depth + fastest * rest + 0.5 * most * rest * rest


@inner
def _nearest(box: Array, to_x: float, to_y: float) -> float:
    """The least coordinate [m] of a box's points in the direction (to_x, to_y)."""
    along, across = to_x * box[2] + to_y * box[3], to_y * box[2] - to_x * box[3]
    least: float = box[0] * to_x + box[1] * to_y
    least += min(along * box[4], along * box[5]) + min(across * box[6], across * box[7])
    return least


@inner
def is_safe(
    force: float,
    speed: float,
    front: tuple[Array, float],
    people: tuple[Array, Array, Array, Array, Array],
    c: Limits,
    memory: tuple[Array, Array, Array],
    slack: float,
) -> bool:
    """Return whether the ego can stop after ``force`` without its front hitting a person.

    Args:
        force: Force [N] of the present step.
        speed: Speed of the ego [m/s].
        front: Poses (k, 4) of the front ahead, and the distance [m] between them.
        people: Positions (n, 2), velocities (n, 2), errors (n,) or more, kerbs (n, 3) or none, and
            errors of the velocities (n,) or none.
        c: Limits of the ego's and people's motion.
        memory: Forces of the past, the rectangles, which are overwritten, and bounds of the
            forces that act, with the speed [m/s] by which the ego may be slower.
        slack: Distance [m] added to the clearance.
    """
    position, velocity, errors, kerbs, off = people
    (way, spacing), boxes = front, memory[1]
    steps, travel = _stop(force, speed, way, spacing, c, memory)
    if steps < 0:
        return False
    widest = 0.0
    for j in range(steps + 1):
        widest = max(widest, boxes[j, 8])
    farthest = travel + c.half_width + widest + slack + c.people.speed * steps * c.time_step
    for i in range(position.shape[0]):
        x, y, reach = position[i, 0], position[i, 1], farthest + errors[i]
        d_x, d_y = x - way[0, 0], y - way[0, 1]
        if d_x * d_x + d_y * d_y > reach * reach:
            continue
        to_x, to_y, depth = 0.0, 0.0, 0.0
        if i < kerbs.shape[0]:
            to_x, to_y, depth = kerbs[i, 0], kerbs[i, 1], kerbs[i, 2]
        turns = off[i] if i < off.shape[0] else 0.0
        person = x, y, velocity[i, 0], velocity[i, 1], errors[i], turns
        if _may_meet(person, (to_x, to_y, depth), steps, slack, c, boxes):
            return False
    return True
