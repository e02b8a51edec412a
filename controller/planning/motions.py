"""The motions of manoeuvres: accelerations that are aimed at, or the last plan, shifted."""

import numpy as np

from controller._jit import Array, inner, kernel
from controller.driving_constants import FIRM, SOFT_STOP

_EASING = 0.4  # time constant [s] with which an acceleration ends at standstill or wanted speed
_CREEPING = 0.6  # time constant [s] of the last metres before a stop, against a jolt
_JERK = 8.0  # jerk [m/s^3] of a branch

Motion = tuple[Array, Array, Array]
"""Distances [m], speeds [m/s] and accelerations [m/s^2] of a manoeuvre, or of k of them."""


@inner
def aim(
    speed: float,
    before: float,
    goals: Array,
    fastest: float,
    jerks: tuple[float, float],
    time_step: float,
    motions: Motion,
) -> None:
    """Fill manoeuvres that change to a wanted acceleration and end at rest or at ``fastest``.

    Args:
        speed: Speed now [m/s].
        before: Acceleration before [m/s^2].
        goals: Wanted acceleration [m/s^2] and speed [m/s] at which it ends, (k, 2). Speeding up to
            0 ends at ``fastest``.
        fastest: Speed [m/s] at which speeding up ends.
        jerks: Jerks [m/s^3] with which accelerations fall and rise.
        time_step: Control step [s].
        motions: Motions (k or more, N + 1), filled.
    """
    distance, speeds, accelerations = motions
    falls, rises = jerks[0] * time_step, jerks[1] * time_step
    count, last = goals.shape[0], speeds.shape[1] - 1
    asked_for = np.full(count, before)
    for k in range(count):
        distance[k, 0], speeds[k, 0] = 0.0, speed
    for i in range(last + 1):
        for k in range(count):
            wanted, v, a = goals[k, 0], speeds[k, i], asked_for[k]
            if wanted > 0.0 or v > fastest:
                ends = wanted > 0.0 and goals[k, 1] > 0.0
                end = min(goals[k, 1], fastest) if ends else fastest
                goal = min(wanted, max((end - v) / _EASING, -FIRM))
            else:
                goal = max(wanted, min(0.0, (goals[k, 1] - v) / _EASING))
            a += min(max(goal - a, -falls), rises)
            after = max(v + time_step * a, 0.0)
            if after > fastest:
                after = max(fastest, min(after, v))
            asked_for[k], accelerations[k, i] = a, (after - v) / time_step
            if i < last:
                distance[k, i + 1], speeds[k, i + 1] = distance[k, i] + time_step * v, after


@inner
def approach(
    speed: float,
    before: float,
    end: float,
    limits: tuple[float, float, tuple[float, float]],
    time_step: float,
    motion: Motion,
) -> None:
    """Fill a manoeuvre that drives up to the end of the way and stops there comfortably.

    Args:
        speed: Speed now [m/s].
        before: Acceleration before [m/s^2].
        end: Distance [m] to the place of the stop.
        limits: Largest acceleration [m/s^2], highest speed [m/s], and jerks [m/s^3] with which
            accelerations fall and rise.
        time_step: Control step [s].
        motion: Motion (N + 1,), filled.
    """
    (wanted, fastest, jerks), (distance, speeds, accelerations) = limits, motion
    s, v, a = 0.0, speed, before
    falls, rises = jerks[0] * time_step, jerks[1] * time_step
    for i in range(len(speeds)):
        distance[i], speeds[i] = s, v
        # The car drives on until its acceleration has changed. This distance is not left to brake.
        left = max(end - s - 0.75 * (_EASING + 2.0 * max(a, 0.0) / jerks[0]) * v, 0.0)
        aimed_at = min(fastest, np.sqrt(2.0 * SOFT_STOP * left), left / _CREEPING)
        goal = min(max((aimed_at - v) / _EASING, -FIRM), wanted)
        a += min(max(goal - a, -falls), rises)
        after = max(v + time_step * a, 0.0)
        accelerations[i] = (after - v) / time_step
        s += time_step * v
        v = after


@kernel
def branch_off(
    motion: Motion, first: int, braking: float, fastest: float, time_step: float
) -> None:
    """Let a manoeuvre brake from a step on, in place.

    Args:
        motion: Motion (N + 1,) of the manoeuvre, changed.
        first: Step from which on it brakes, > 0.
        braking: Acceleration [m/s^2] of the braking, < 0, down to rest.
        fastest: Highest speed [m/s].
        time_step: Control step [s].
    """
    distance, speeds, accelerations = motion
    driven, before = distance[first], accelerations[first - 1]
    goals, alone = np.array([[braking, 0.0]]), (1, len(distance) - first)
    x, v, a = distance[first:], speeds[first:], accelerations[first:]
    tail = x.reshape(alone), v.reshape(alone), a.reshape(alone)
    aim(speeds[first], before, goals, fastest, (_JERK, _JERK), time_step, tail)
    for i in range(first, len(distance)):
        distance[i] += driven


@inner
def shift(speed: float, holds: bool, deceleration: float, time_step: float, motion: Motion) -> None:
    """Shift a plan by one step, in place: its step 1 becomes step 0.

    Args:
        speed: Speed now [m/s], which replaces the planned one.
        holds: Whether the last speed is kept in the added step. If not, the ego brakes in it.
        deceleration: Deceleration b [m/s^2] of this braking.
        time_step: Control step [s].
        motion: Motion (N + 1,) of the plan, changed.
    """
    distance, speeds, accelerations = motion
    N = len(speeds) - 1
    for i in range(N):
        speeds[i] = speeds[i + 1]
    if not holds:
        speeds[N] = max(0.0, speeds[N] - deceleration * time_step)
    speeds[0] = speed
    distance[0] = 0.0
    for i in range(N):
        distance[i + 1] = distance[i] + time_step * speeds[i]
        accelerations[i] = (speeds[i + 1] - speeds[i]) / time_step
    accelerations[N] = 0.0
