"""Pedestrians about to collide with the ego, and speeds at which none could make it stop hard."""

from typing import NamedTuple

import numpy as np

from controller.kernels import towards_kerb
from giveway.ego.perception.kerbs import NO_KERBS
from giveway.geometry.contact import contact_interval, to_frame
from giveway.geometry.kernel import Array, inner

_SLOW = 0.2  # [m/s] the ego is no danger (Yang & Özgüner 2019: a standing vehicle is an obstacle)
_HALVINGS = 5  # of the interval in which the calm speed is looked for
_WHOLE = 1e-6  # of a step: so much longer a stop takes no step more
_ROUNDING = 1e-6  # [m] farther off than could matter: nothing that is left out is a near miss
_FADING = 0.5  # [s] beyond the conflict time in which somebody counts less and less
_SPARE = 0.05  # [m] kept beyond what the safety layer needs: predictions are a little off
_NOT_BEHIND_ONE = 0.0, 0.0, 0.0  # no kerb


class Alarm(NamedTuple):
    """The limits of bodies and brakes, as the kernels take them."""

    radius: float  # of a body [m]
    clearance: float  # kept to it by the safety layer [m]
    walking_acceleration: float  # [m/s^2] that no pedestrian exceeds
    walking_speed: float  # [m/s] that no pedestrian exceeds
    braking: float  # of the ego at most [m/s^2]
    heeded: bool  # there is a safety layer that would act
    setting_out: float = np.inf  # [m/s^2] towards the kerb, that nobody on a sidewalk exceeds
    kerbs: Array = NO_KERBS  # (n, 3) a x + b y = c [m] of those on sidewalks, 0 of the others


@inner
def conflicts_and_calm(
    people: tuple[Array, Array, Array],
    pose: tuple[float, float, float, float],
    speed: float,
    body: tuple[float, float],
    times: tuple[float, float, float],
    alarm: Alarm,
) -> tuple[float, float]:
    """Return the persons in conflict with the ego, and its threat-free speed.

    A person is in conflict who would touch the ego within the conflict time if both kept their
    velocity; one who would do so up to half a second later counts in proportion. The threat-free
    speed [m/s] is that up to which no pedestrian could force an emergency stop, see
    :func:`is_threat`; it is inf if ``speed`` is slow enough.

    Args:
        people: Positions of people now, before and after the interval [m], (n, 2) each.
        pose: x, y of the front [m], heading of the body [rad], and heading of the way on which
            the front would stop [rad].
        speed: Speed of the ego [m/s].
        body: Half of its length and half of its width [m].
        times: Interval between two predictions, time to collision of a conflict, step [s].
        alarm: Assumptions about people and braking.
    """
    here, before, after = people
    front_x, front_y, heading, braking_heading = pose
    (half_length, half_width), (interval, conflict_time, time_step) = body, times
    if speed <= _SLOW:
        return 0.0, np.inf
    c, s = np.cos(heading), np.sin(heading)
    turn = braking_heading - heading
    c_b, s_b = 1.0, 0.0
    if turn != 0.0:
        c_b, s_b = np.cos(turn), np.sin(turn)
    soon = conflict_time + _FADING
    far = 2.0 * half_length + half_width + soon * (speed + alarm.walking_speed)
    conflicts, calm, braking = 0.0, speed, outline(speed, time_step, alarm)
    for j in range(here.shape[0]):
        d_x, d_y = here[j, 0] - front_x, here[j, 1] - front_y
        if d_x * d_x + d_y * d_y > far * far:
            continue
        x, y = to_frame(d_x, d_y, c, s)
        w_x = (after[j, 0] - before[j, 0]) / interval
        w_y = (after[j, 1] - before[j, 1]) / interval
        w_x, w_y = to_frame(w_x, w_y, c, s)
        # Who cannot come beside, before or behind the body in that time needs no more thought.
        apart = max(
            abs(y) - half_width - abs(w_y) * soon,
            abs(x + half_length) - half_length - abs(w_x - speed) * soon,
        )
        if apart <= alarm.radius + _ROUNDING:
            begin, end = contact_interval(
                x + half_length, y, w_x - speed, w_y, half_length, half_width, alarm.radius
            )
            if end >= 0.0 and begin < soon:
                conflicts += min(1.0, (soon - begin) / _FADING)
        if not alarm.heeded:
            continue
        if turn != 0.0:
            x, y = to_frame(x, y, c_b, s_b)
            w_x, w_y = to_frame(w_x, w_y, c_b, s_b)
        kerb = 0.0, 0.0, 0.0
        if j < alarm.kerbs.shape[0]:
            a, b = alarm.kerbs[j, 0], alarm.kerbs[j, 1]
            depth = alarm.kerbs[j, 2] - a * here[j, 0] - b * here[j, 1] - _SPARE
            a, b = to_frame(a, b, c, s)
            a, b = to_frame(a, b, c_b, s_b)
            kerb = a, b, depth
        if is_threat(x, y, w_x, w_y, braking, half_width, time_step, alarm, kerb):
            low, high = 0.0, calm
            for _ in range(_HALVINGS):
                middle = 0.5 * (low + high)
                slower = outline(middle, time_step, alarm)
                if is_threat(x, y, w_x, w_y, slower, half_width, time_step, alarm, kerb):
                    high = middle
                else:
                    low = middle
            calm = low
            braking = outline(calm, time_step, alarm)
    return conflicts, calm if calm < speed else np.inf


class Outline(NamedTuple):
    """The outline of a full braking from a speed, the same for everybody."""

    speed: float  # [m/s] from which it is braked
    step: float  # [m] driven until the brake acts
    stop: int  # steps until standstill
    clear: float  # [m] to be kept between a body's centre and the front
    most: float  # [m] with the farthest that somebody can deviate until then
    farthest: float  # [m] that the front gets at most


@inner
def outline(speed: float, time_step: float, alarm: Alarm) -> Outline:
    """The outline of a full braking from ``speed`` [m/s], which acts after ``time_step`` [s]."""
    step = speed * time_step
    # The instant of the stop counts too: in most of the cases it is the one that matters.
    stop = 1 + int(np.ceil(speed / (alarm.braking * time_step) - _WHOLE))
    # half of a step's motion relative to the front
    within = 0.5 * (step + alarm.walking_speed * time_step)
    clear = max(
        alarm.radius + alarm.clearance, np.sqrt(alarm.radius * alarm.radius + within * within)
    )
    clear += _SPARE
    # The longest reach, the last instant and the whole way of the front at once: too generous.
    last = stop * time_step
    most = clear + 0.5 * alarm.walking_acceleration * last * last + _ROUNDING
    farthest = speed * (last + time_step) + 0.5 * alarm.braking * time_step * last
    return Outline(speed, step, stop, clear, most, farthest)


@inner
def is_threat(
    x: float,
    y: float,
    w_x: float,
    w_y: float,
    o: Outline,
    half_width: float,
    time_step: float,
    alarm: Alarm,
    kerb: tuple[float, float, float] = _NOT_BEHIND_ONE,
) -> bool:
    """Return whether a pedestrian could get before the front of the fully braking ego.

    The safety layer would act then (controller/safety/layer.py knows exactly; this is its outline).

    Args:
        x: ahead of the front's middle [m].
        y: Distance to the left of it [m].
        w_x: the velocity along the ego's heading [m/s].
        w_y: across it [m/s].
        o: Outline of the braking.
        half_width: Half width of the ego [m].
        time_step: [s] until the brake acts.
        alarm: the limits.
        kerb: Kerb of somebody on a sidewalk: the unit vector to it, and how far it is [m].
    """
    to_x, to_y, depth = kerb
    last = o.stop * time_step
    if max(x - o.farthest, -x) - abs(w_x) * last > o.most:
        return False
    if abs(y) - half_width - abs(w_y) * last > o.most:
        return False
    for i in range(o.stop + 1):
        t = i * time_step
        braked = min(max(0.0, t - time_step), o.speed / alarm.braking)
        low = o.speed * braked - 0.5 * alarm.braking * braked * braked
        high = low + o.step + 0.5 * time_step * alarm.braking * braked  # by forward Euler
        reach = o.clear + 0.5 * alarm.walking_acceleration * t * t
        ahead = x + w_x * t
        off = max(0.0, low - ahead, ahead - high)
        aside = max(0.0, abs(y + w_y * t) - half_width)
        if off * off + aside * aside > reach * reach:
            continue
        if depth <= 0.0:
            return True
        pace = w_x * to_x + w_y * to_y
        nearer = towards_kerb(t, pace, depth, alarm.setting_out, alarm.walking_acceleration)
        between = min(to_x * low, to_x * high) - abs(to_y) * half_width - (x * to_x + y * to_y)
        if between - nearer <= o.clear:
            return True
    return False
