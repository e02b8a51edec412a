"""Pedestrians about to collide with the ego, and speeds at which none could make it stop hard."""

from typing import NamedTuple

import numpy as np

from giveway.geometry.contact import contact_interval, to_frame
from giveway.geometry.kernel import Array, kernel

_SLOW = 0.2  # [m/s] the ego is no danger (Yang & Özgüner 2019: a standing vehicle is an obstacle)
_HALVINGS = 5  # of the interval in which the calm speed is looked for


class Alarm(NamedTuple):
    """The limits of bodies and brakes, as the kernels take them."""

    radius: float  # of a body [m]
    clearance: float  # kept to it by the safety layer [m]
    walking_acceleration: float  # [m/s^2] that no pedestrian exceeds
    walking_speed: float  # [m/s] that no pedestrian exceeds
    braking: float  # of the ego at most [m/s^2]
    heeded: bool  # there is a safety layer that would act


@kernel
def conflicts_and_calm(
    here: Array,
    there: Array,
    front_x: float,
    front_y: float,
    heading: float,
    speed: float,
    half_length: float,
    half_width: float,
    conflict_time: float,
    time_step: float,
    alarm: Alarm,
) -> tuple[float, float]:
    """Persons who would touch the ego within the conflict time if both kept their velocity.

    Also the speed [m/s] from which on no pedestrian could force an emergency stop, see
    :func:`is_threat`; inf: ``speed`` is slow enough.
    """
    if speed <= _SLOW:
        return 0.0, np.inf
    c, s = np.cos(heading), np.sin(heading)
    far = 2.0 * half_length + half_width + conflict_time * (speed + alarm.walking_speed)
    conflicts, calm = 0.0, speed
    for j in range(here.shape[0]):
        d_x, d_y = here[j, 0] - front_x, here[j, 1] - front_y
        if d_x * d_x + d_y * d_y > far * far:
            continue
        x, y = to_frame(d_x, d_y, c, s)
        w_x = (there[j, 0] - here[j, 0]) / time_step
        w_y = (there[j, 1] - here[j, 1]) / time_step
        w_x, w_y = to_frame(w_x, w_y, c, s)
        begin, end = contact_interval(
            x + half_length, y, w_x - speed, w_y, half_length, half_width, alarm.radius
        )
        if end >= 0.0 and begin < conflict_time:
            conflicts += 1.0
        if alarm.heeded and is_threat(x, y, w_x, w_y, calm, half_width, time_step, alarm):
            low, high = 0.0, calm
            for _ in range(_HALVINGS):
                middle = 0.5 * (low + high)
                if is_threat(x, y, w_x, w_y, middle, half_width, time_step, alarm):
                    high = middle
                else:
                    low = middle
            calm = low
    return conflicts, calm if calm < speed else np.inf


@kernel
def is_threat(
    x: float,
    y: float,
    w_x: float,
    w_y: float,
    speed: float,
    half_width: float,
    time_step: float,
    alarm: Alarm,
) -> bool:
    """Whether a pedestrian could get before the front while the ego brakes fully from here on.

    The safety layer would act then (controller/safety.py knows exactly; this is its outline).

    Args:
        x: ahead of the front's middle [m].
        y: to the left of it [m].
        w_x: the velocity along the ego's heading [m/s].
        w_y: across it [m/s].
        speed: of the ego [m/s].
        half_width: of the ego [m].
        time_step: [s] until the brake acts.
        alarm: the limits.
    """
    step = speed * time_step
    stop = time_step + speed / alarm.braking
    # half of a step's motion relative to the front
    within = 0.5 * (step + alarm.walking_speed * time_step)
    clear = max(
        alarm.radius + alarm.clearance, np.sqrt(alarm.radius * alarm.radius + within * within)
    )
    t = 0.0
    while t < stop:
        braked = max(0.0, t - time_step)
        front = speed * t - 0.5 * alarm.braking * braked * braked
        reach = clear + 0.5 * alarm.walking_acceleration * t * t
        if (
            abs(x + w_x * t - front) <= reach + 0.5 * step
            and abs(y + w_y * t) <= half_width + reach
        ):
            return True
        t += time_step
    return False
