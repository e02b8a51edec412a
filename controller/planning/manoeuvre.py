"""Manoeuvres: speeds over the horizon that the search tries, and what each would cost.

A manoeuvre is a path in the plane of time and station, in which everybody who crosses the ego's
corridor occupies a region. To pass before somebody or behind is to pass that region on one side or
the other, so a handful of manoeuvres stands for the choices there are (a small enumeration, as in
Werling et al., ICRA 2010). Since people answer to the ego, each manoeuvre is judged by how the
crowd would move under it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from controller._jit import kernel

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from controller.planning.parameters import ManoeuvreParameters, PlannerParameters

    Array = NDArray[np.float64]

_EASING = 0.4  # [s] in which an acceleration is taken back before standstill or the wanted speed


class Weights(NamedTuple):
    """The numbers of the cost.

    What is called from outside gets them as a plain tuple: numba looks the class of a named one up
    in each call, which takes 2 us.
    """

    reference_speed: float
    safe_distance: float
    minimum_distance: float
    headway: float
    deceleration: float
    time: float
    acceleration: float
    nearness: float
    closeness: float
    conflict: float
    threat: float
    final: float
    terminal: bool

    @classmethod
    def of(cls, p: PlannerParameters, m: ManoeuvreParameters) -> Weights:
        """The weights of a planner."""
        return cls(
            p.reference_speed,
            p.safe_distance,
            m.minimum_distance,
            m.headway,
            m.deceleration,
            m.time_weight,
            m.acceleration_weight,
            m.nearness_weight,
            m.closeness_weight,
            m.conflict_weight,
            m.threat_weight,
            m.final_weight,
            p.terminal,
        )


@kernel
def aim(
    speed: float,
    before: float,
    wanted: float,
    slowest: float,
    fastest: float,
    jerk: float,
    time_step: float,
    distance: Array,
    speeds: Array,
    accelerations: Array,
) -> None:
    """Fill a manoeuvre that goes over to the acceleration ``wanted``, up to rest or ``fastest``.

    Args:
        speed: now [m/s].
        before: the acceleration before [m/s^2].
        wanted: [m/s^2].
        slowest: [m/s] where braking ends.
        fastest: [m/s] not exceeded by driving on.
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
        if wanted > 0.0 or v > fastest:
            goal = min(wanted, (fastest - v) / _EASING)
        else:
            goal = max(wanted, min(0.0, (slowest - v) / _EASING))
        a += min(max(goal - a, -most), most)
        after = max(v + time_step * a, 0.0)
        if after > fastest:
            after = max(fastest, min(after, v))
        accelerations[i] = (after - v) / time_step
        s += time_step * v
        v = after


@kernel
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


@kernel
def stopping_need(speed: float, w: Weights) -> float:
    """The distance [m] to somebody in front from which a comfortable stop is possible."""
    need = w.minimum_distance + w.headway * speed
    if w.terminal:
        need += speed * speed / (2.0 * w.deceleration)
    return need


@kernel
def cost(
    distance: Array,
    speeds: Array,
    accelerations: Array,
    gap: Array,
    conflicts: Array,
    calm: Array,
    allowed: Array,
    time_step: float,
    weights: tuple[Any, ...],
) -> tuple[float, float, float]:
    """What a manoeuvre costs [s].

    Args:
        distance: (N + 1,) [m] of the manoeuvre.
        speeds: (N + 1,) [m/s].
        accelerations: (N + 1,) [m/s^2].
        gap: (N,) [m] to the closest person in front at steps 1 ... N.
        conflicts: (N,) persons.
        calm: (N,) [m/s].
        allowed: (N,) [m] that may be driven until then: vehicles, lights.
        time_step: [s].
        weights: the numbers of :class:`Weights`.

    Returns:
        The whole cost; the part of it that other people and vehicles cause; the longest missing
        stopping distance [m].
    """
    w, N = Weights(*weights), len(gap)
    own, others, missing = 0.0, 0.0, 0.0
    for i in range(N):
        v = speeds[i + 1]
        share = v / w.reference_speed
        own += w.time * max(0.0, 1.0 - share) + w.acceleration * accelerations[i] ** 2
        others += w.conflict * conflicts[i]
        others += w.threat * max(0.0, v - calm[i]) / w.reference_speed
        if gap[i] < w.safe_distance:
            others += w.nearness * (1.0 - max(gap[i], 0.0) / w.safe_distance) * share
            lacking = stopping_need(v, w) - gap[i]
            if lacking > 0.0 and v > 0.0:
                others += w.closeness * lacking * share
                missing = max(missing, lacking)
        beyond = distance[i + 1] - allowed[i]
        if beyond > 0.0:
            others += w.closeness * beyond
            missing = max(missing, beyond)
    own = time_step * own + w.final * max(0.0, 1.0 - speeds[N] / w.reference_speed)
    return own + time_step * others, time_step * others, missing


@kernel
def corridor(
    distance: Array,
    speeds: Array,
    gap: Array,
    allowed: Array,
    chosen: bool,
    weights: tuple[Any, ...],
    room: Array,
) -> None:
    """Fill ``room`` (N,) [m]: how far a plan may have driven at steps 1 ... N.

    Behind everybody who is in front of the manoeuvre then: with the stopping distance of its own
    speed where it was chosen by what it leads to, and never less than itself; else with d_safe.
    """
    w = Weights(*weights)
    for i in range(len(gap)):
        station = distance[i + 1] + gap[i]
        if chosen:
            room[i] = max(station - stopping_need(speeds[i + 1], w), distance[i + 1])
        else:
            room[i] = station - w.safe_distance
        room[i] = min(room[i], allowed[i])
