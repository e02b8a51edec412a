"""The motions of manoeuvres: an acceleration that is approached, or the last plan moved on."""

import numpy as np

from controller._jit import Array, inner, kernel

_EASING = 0.4  # [s] in which an acceleration is taken back before standstill or the wanted speed
_COMFORT = 1.5  # [m/s^2] of a stop that nobody forces
_CREEPING = 0.6  # [s] the last of the way, so that the stop has no jolt
_JERK = 8.0  # [m/s^3] of a branch
_SLOWING = 3.0  # [m/s^2] with which a speed above the wanted one is given up: as adaptive cruise
# control does at most (ISO 15622: 3.5 m/s^2 at speed); obstacles have harder manoeuvres


@inner
def aim(
    speed: float,
    before: float,
    goals: Array,
    fastest: float,
    jerk: float,
    time_step: float,
    distance: Array,
    speeds: Array,
    accelerations: Array,
) -> None:
    """Fill manoeuvres that go over to the accelerations wanted, up to rest or ``fastest``.

    All of them step by step: no step of one waits for another's, and the processor overlaps them.

    Args:
        speed: now [m/s].
        before: the acceleration before [m/s^2].
        goals: (k, 2) the acceleration wanted [m/s^2], and the speed at which braking ends [m/s].
        fastest: [m/s] not exceeded by driving on.
        jerk: [m/s^3] of changes.
        time_step: [s].
        distance: (k or more, N + 1) [m] receives the manoeuvres.
        speeds: [m/s] likewise.
        accelerations: [m/s^2] likewise.
    """
    most, count, last = jerk * time_step, goals.shape[0], speeds.shape[1] - 1
    asked_for = np.full(count, before)
    for k in range(count):
        distance[k, 0], speeds[k, 0] = 0.0, speed
    for i in range(last + 1):
        for k in range(count):
            wanted, v, a = goals[k, 0], speeds[k, i], asked_for[k]
            if wanted > 0.0 or v > fastest:
                goal = min(wanted, max((fastest - v) / _EASING, -_SLOWING))
            else:
                goal = max(wanted, min(0.0, (goals[k, 1] - v) / _EASING))
            a += min(max(goal - a, -most), most)
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
    wanted: float,
    end: float,
    fastest: float,
    jerk: float,
    time_step: float,
    distance: Array,
    speeds: Array,
    accelerations: Array,
) -> None:
    """Fill a manoeuvre that drives up to where the way ends, and stops there in comfort.

    Args:
        speed: now [m/s].
        before: the acceleration before [m/s^2].
        wanted: [m/s^2] of speeding up, at most.
        end: the distance [m] to where it is to stand.
        fastest: [m/s] not exceeded.
        jerk: [m/s^3] of changes.
        time_step: [s].
        distance: (N + 1,) [m] receives the manoeuvre.
        speeds: (N + 1,) [m/s] likewise.
        accelerations: (N + 1,) [m/s^2] likewise.
    """
    s, v, a = 0.0, speed, before
    most = jerk * time_step
    for i in range(len(speeds)):
        distance[i], speeds[i] = s, v
        # Until an acceleration has been eased off the car drives on: so much less is left to brake.
        left = max(end - s - 0.75 * (_EASING + 2.0 * max(a, 0.0) / jerk) * v, 0.0)
        aimed_at = min(fastest, np.sqrt(2.0 * _COMFORT * left), left / _CREEPING)
        goal = min(max((aimed_at - v) / _EASING, -_SLOWING), wanted)
        a += min(max(goal - a, -most), most)
        after = max(v + time_step * a, 0.0)
        accelerations[i] = (after - v) / time_step
        s += time_step * v
        v = after


@kernel
def branch_off(
    distance: Array,
    speeds: Array,
    accelerations: Array,
    first: int,
    braking: float,
    fastest: float,
    time_step: float,
) -> None:
    """Let a manoeuvre brake from a step on, in place.

    Args:
        distance: (N + 1,) [m] of it.
        speeds: (N + 1,) [m/s].
        accelerations: (N + 1,) [m/s^2].
        first: the step, > 0.
        braking: [m/s^2] < 0, down to rest.
        fastest: [m/s] not exceeded.
        time_step: [s].
    """
    driven, before = distance[first], accelerations[first - 1]
    goals, alone = np.array([[braking, 0.0]]), (1, len(distance) - first)
    x, v, a = distance[first:], speeds[first:], accelerations[first:]
    tail = x.reshape(alone), v.reshape(alone), a.reshape(alone)
    aim(speeds[first], before, goals, fastest, _JERK, time_step, *tail)
    for i in range(first, len(distance)):
        distance[i] += driven


@inner
def shift(
    speed: float,
    holds: bool,
    deceleration: float,
    time_step: float,
    distance: Array,
    speeds: Array,
    accelerations: Array,
) -> None:
    """Move a plan on by one step, in place: what it had planned for then is now.

    Args:
        speed: now [m/s]; where it differs from what was planned, it counts.
        holds: the last speed is kept beyond the former horizon; else it is braked.
        deceleration: b [m/s^2] of that.
        time_step: [s].
        distance: (N + 1,) [m] of the plan.
        speeds: (N + 1,) [m/s].
        accelerations: (N + 1,) [m/s^2].
    """
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
