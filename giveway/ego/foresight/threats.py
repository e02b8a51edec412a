"""The speeds at which no pedestrian could force a hard stop, and at which drivers pass them."""

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from controller.driving_constants import (
    PASSING_FAR,
    PASSING_KERB,
    PASSING_NEAR,
    PASSING_SIDEWALK,
    PASSING_TAIL,
    STANDING,
)
from controller.kernels import towards_kerb
from giveway.ego.perception.kerbs import NO_KERBS
from giveway.geometry.contact import to_frame
from giveway.geometry.kernel import Array, inner

_HALVINGS = 5  # number of bisections in the search for the threat-free speed
_WHOLE = 1e-6  # tolerance [steps] when a stopping time is rounded up to whole steps
_ROUNDING = 1e-6  # tolerance [m] of distances that exclude a person
_AHEAD = 2.0  # time [s] within which a person whom the ego may meet is looked at
_BLUR = 0.05  # growth [m/s] of the error of predicted positions
_TOWARDS = 0.3  # speed [m/s] towards the ego's way, above which a person heads for it
_SPARE = 0.05  # margin [m] beyond the safety layer's need, for errors of the prediction
_NOT_BEHIND_ONE = 0.0, 0.0, 0.0  # kerb of a person who is not on a sidewalk

ALL_SEE: Final = np.zeros(0, dtype=np.bool_)
"""Marks of people who may not see the ego, if everybody sees it."""


class Alarm(NamedTuple):
    """The limits of people and brakes that define a threat, as the kernels take them."""

    radius: float  # radius of a person's body [m]
    clearance: float  # distance [m] that the safety layer keeps to a body
    walking_acceleration: float  # largest acceleration [m/s^2] of a person
    walking_speed: float  # largest speed [m/s] of a person
    braking: float  # largest deceleration [m/s^2] of the ego
    heeded: bool  # whether there is a safety layer that would act
    setting_out: float = np.inf  # largest acceleration [m/s^2] from a sidewalk towards the kerb
    late: float = 0.0  # time [s] by which the brake acts later than in the next step
    kerbs: Array = NO_KERBS  # kerb lines (n, 3), a x + b y = c [m]; 0 for people not on sidewalks
    unaware: NDArray[np.bool_] = ALL_SEE  # marks (n,) of people who may not see the ego


@inner
def threat_free_and_passing(
    people: tuple[Array, Array, Array],
    pose: tuple[float, float, float, float],
    speed: float,
    body: tuple[float, float],
    times: tuple[float, float, float],
    alarm: Alarm,
) -> tuple[float, float]:
    """Return the threat-free speed and the passing speed [m/s] of the ego.

    The threat-free speed is the highest one at which no pedestrian could force an emergency stop
    (:func:`is_threat`). The passing speed is the one at which drivers pass the pedestrians that are
    beside or before the body (:func:`passing_speed`). Each is inf if ``speed`` is no higher.

    Args:
        people: Positions of people now, before and after the interval [m], (n, 2) each.
        pose: x, y of the front [m], heading of the body [rad], and heading [rad] of the line from
            the front to where it would stop.
        speed: Speed of the ego [m/s].
        body: Half of its length and half of its width [m].
        times: Interval between two predictions, step, and time from now on [s].
        alarm: Assumptions about people and braking.
    """
    here, before, after = people
    front_x, front_y, heading, braking_heading = pose
    (half_length, half_width), (interval, time_step, later) = body, times
    if speed <= STANDING:
        return np.inf, np.inf
    c, s = np.cos(heading), np.sin(heading)
    turn = braking_heading - heading
    c_b, s_b = 1.0, 0.0
    if turn != 0.0:
        c_b, s_b = np.cos(turn), np.sin(turn)
    far = 2.0 * half_length + half_width + _AHEAD * (speed + alarm.walking_speed)
    blur, passing = _BLUR * later, speed
    threat_free, braking = speed, outline(speed, time_step, alarm)
    for j in range(here.shape[0]):
        d_x, d_y = here[j, 0] - front_x, here[j, 1] - front_y
        if d_x * d_x + d_y * d_y > far * far:
            continue
        x, y = to_frame(d_x, d_y, c, s)
        w_x = (after[j, 0] - before[j, 0]) / interval
        w_y = (after[j, 1] - before[j, 1]) / interval
        w_x, w_y = to_frame(w_x, w_y, c, s)
        off = max(abs(x + half_length) - half_length, 0.0)
        aside = max(abs(y) - half_width, 0.0)
        clear = max(0.0, np.sqrt(off * off + aside * aside) - alarm.radius - blur)
        kept = j < alarm.kerbs.shape[0] and alarm.kerbs[j, 0] ** 2 + alarm.kerbs[j, 1] ** 2 > 0.0
        heads = not kept and (w_y * y < -_TOWARDS * abs(y) or abs(y) < half_width)
        passed = x < -half_length and w_x * w_x + w_y * w_y > _TOWARDS * _TOWARDS
        passing = min(passing, passing_speed(clear, passed, heads, kept))
        if not alarm.heeded:
            continue
        if turn != 0.0:
            x, y = to_frame(x, y, c_b, s_b)
            w_x, w_y = to_frame(w_x, w_y, c_b, s_b)
        place, walk, kerb = (x, y), (w_x, w_y), (0.0, 0.0, 0.0)
        if j < alarm.kerbs.shape[0]:
            a, b = alarm.kerbs[j, 0], alarm.kerbs[j, 1]
            depth = alarm.kerbs[j, 2] - a * here[j, 0] - b * here[j, 1] - _SPARE
            a, b = to_frame(a, b, c, s)
            a, b = to_frame(a, b, c_b, s_b)
            kerb = a, b, depth
        if is_threat(place, walk, braking, half_width, time_step, alarm, kerb):
            low, high = 0.0, threat_free
            for _ in range(_HALVINGS):
                middle = 0.5 * (low + high)
                slower = outline(middle, time_step, alarm)
                if is_threat(place, walk, slower, half_width, time_step, alarm, kerb):
                    high = middle
                else:
                    low = middle
            threat_free = low
            braking = outline(threat_free, time_step, alarm)
    threat_free = threat_free if threat_free < speed else np.inf
    return threat_free, passing if passing < speed else np.inf


@inner
def passing_speed(clearance: float, at_tail: bool, heads: bool, kept: bool) -> float:
    """Return the speed [m/s] at which drivers pass a person at this clearance [m].

    Args:
        clearance: Distance [m] between the person's body and the ego's outline.
        at_tail: Whether the person is beside the rear half of the ego, or behind.
        heads: Whether the person heads for the ego's way.
        kept: Whether the person is on a sidewalk, and not about to leave it.
    """
    if kept and clearance >= PASSING_SIDEWALK:
        return np.inf
    if at_tail:
        return PASSING_TAIL[1] if clearance < PASSING_TAIL[0] else np.inf
    speed = min(
        PASSING_NEAR[0] + PASSING_NEAR[1] * clearance, PASSING_FAR[0] + PASSING_FAR[1] * clearance
    )
    if clearance >= PASSING_KERB[0] and not heads:
        speed = max(speed, PASSING_KERB[1])
    return speed


class Outline(NamedTuple):
    """The outline of a full braking from a speed, which is the same for all pedestrians."""

    speed: float  # initial speed [m/s]
    step: float  # distance [m] driven until the brake acts
    stop: int  # number of steps until standstill
    clear: float  # distance [m] to be kept between a person's centre and the front
    most: float  # this distance [m] plus the largest deviation of a person until standstill
    farthest: float  # upper bound [m] of the distance that the front travels


@inner
def outline(speed: float, time_step: float, alarm: Alarm) -> Outline:
    """The outline of a full braking from ``speed`` [m/s], which acts after ``time_step`` [s]."""
    step = speed * time_step
    # The instant of standstill is included.
    stop = 1 + int(np.ceil(speed / (alarm.braking * time_step) + alarm.late / time_step - _WHOLE))
    # Half of the relative motion in one step, as positions are compared once per step.
    within = 0.5 * (step + alarm.walking_speed * time_step)
    clear = max(
        alarm.radius + alarm.clearance, np.sqrt(alarm.radius * alarm.radius + within * within)
    )
    clear += _SPARE
    # Upper bounds over the whole braking, for a quick exclusion.
    last = stop * time_step
    most = clear + 0.5 * alarm.walking_acceleration * last * last + _ROUNDING
    farthest = speed * (last + time_step) + 0.5 * alarm.braking * time_step * last
    return Outline(speed, step, stop, clear, most, farthest)


@inner
def is_threat(
    place: tuple[float, float],
    walk: tuple[float, float],
    o: Outline,
    half_width: float,
    time_step: float,
    alarm: Alarm,
    kerb: tuple[float, float, float] = _NOT_BEHIND_ONE,
) -> bool:
    """Return whether a pedestrian could get in front of the ego although it brakes fully.

    The safety layer would act then. This is an approximation of controller/safety/layer.py.

    Args:
        place: Distances [m] of the pedestrian ahead of the middle of the front, and to the left.
        walk: Velocities [m/s] of the pedestrian along the ego's heading, and to the left of it.
        o: Outline of the braking.
        half_width: Half width of the ego [m].
        time_step: Time [s] until the brake acts.
        alarm: Limits of people and brakes.
        kerb: Unit vector to the kerb, and the distance [m] to it, of a person on a sidewalk; 0
            for others.
    """
    (x, y), (w_x, w_y), (to_x, to_y, depth) = place, walk, kerb
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
        if alarm.late > 0.0:
            braked = min(max(0.0, t - time_step - alarm.late), o.speed / alarm.braking)
            high = o.speed * braked - 0.5 * alarm.braking * braked * braked
            high += o.speed * (min(t, alarm.late) + time_step)
            high += 0.5 * time_step * alarm.braking * braked
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
