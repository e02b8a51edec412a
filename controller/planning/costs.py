"""The cost of a manoeuvre, and the corridor that it leaves to a plan."""

from typing import Any

import numpy as np

from controller._jit import Array, inner, kernel
from controller.planning.cost_to_go import time_to_go
from controller.planning.parameters import Weights

_BLOCKED = 2.0  # [s] beyond the horizon that a manoeuvre goes on blocking what it stands on then
_SHARED = 4.0  # [m/s] v_r of Yang & Özgüner 2019; faster, a conflict weighs more with its cube
_CLEAR = 0.3  # [m] before the end of what is to be kept free it is as good as left


@inner
def stopping_need(speed: float, w: Weights) -> float:
    """The distance [m] to somebody in front from which a comfortable stop is possible."""
    return w.minimum_distance + w.headway * speed


@kernel
def cost(
    manoeuvre: tuple[Array, Array, Array],
    prospect: tuple[Array, Array, Array, Array],
    allowed: Array,
    wanted: float,
    time_step: float,
    weights: tuple[Any, ...],
) -> tuple[float, float, float]:
    """Return the cost of a manoeuvre [s].

    Args:
        manoeuvre: Distances [m], speeds [m/s] and accelerations [m/s^2], (N + 1,) each.
        prospect: Gaps [m] to the closest person in front, persons in conflict, and calm speeds
            [m/s] at steps 1 ... N, (N,) each, and who comes onto the way later, (n, 4).
        allowed: (N,) distances [m] that may be driven until then: vehicles, lights.
        wanted: Speed [m/s] that time is lost against.
        time_step: Control step [s].
        weights: Numbers of :class:`Weights`.

    Returns:
        The whole cost; the part of it that other people and vehicles cause; the longest missing
        stopping distance [m].
    """
    (distance, speeds, accelerations), (gap, conflicts, calm, crossers) = manoeuvre, prospect
    own = own_cost(speeds, accelerations, wanted, time_step, weights)
    own += later_cost(crossers, distance[-1], speeds[-1], wanted, allowed, time_step, weights)
    others, missing = 0.0, 0.0
    for i in range(len(gap)):
        beyond = distance[i + 1] - allowed[i]
        others, missing = add_cost_of_others(
            others, missing, speeds[i + 1], gap[i], conflicts[i], calm[i], beyond, weights
        )
    return own + time_step * others, time_step * others, missing


@inner
def own_cost(
    speeds: Array,
    accelerations: Array,
    wanted: float,
    time_step: float,
    weights: tuple[Any, ...],
) -> float:
    """The part of a manoeuvre's cost [s] that is its own, whoever is about: time and comfort."""
    w, own = Weights(*weights), 0.0
    for i in range(len(speeds) - 1):
        own += w.time * max(0.0, 1.0 - speeds[i + 1] / wanted)
        own += w.acceleration * accelerations[i] ** 2
    return time_step * own


@inner
def later_cost(
    crossers: Array,
    driven: float,
    speed: float,
    wanted: float,
    allowed: Array,
    time_step: float,
    weights: tuple[Any, ...],
) -> float:
    """Return the cost beyond the horizon [s], see :func:`time_to_go`.

    ``driven`` [m] is the manoeuvre's distance at the horizon's end, ``speed`` [m/s] its last one.
    Of that counts as much as can be braked to what is ``allowed`` (N,) [m]: no plan gains by being
    fast before the end of its way, but by being near it. When it goes on is not known.
    """
    w, N = Weights(*weights), len(allowed)
    if allowed[N - 1] < np.inf:
        pace = max(0.0, allowed[N - 1] - allowed[N - 2]) / time_step if N > 1 else 0.0
        left = max(0.0, allowed[N - 1] - driven)
        speed = min(speed, np.sqrt(pace**2 + 2.0 * w.deceleration * left))
    later: float = w.final * max(0.0, 1.0 - speed / wanted)
    return later + w.later * time_to_go(crossers, speed, wanted)


@kernel
def cost_of_blocking(
    distance: Array,
    speeds: Array,
    wanted: float,
    to_clear: float,
    time_step: float,
    costs: Array,
) -> None:
    """Add to ``costs`` (k,) [s] what standing where the way is to be kept free costs manoeuvres.

    Time that is lost there counts twice, and as much again as ``_BLOCKED`` seconds that are lost
    beyond the horizon.

    Args:
        distance: (k, N + 1) [m] of the manoeuvres.
        speeds: (k, N + 1) [m/s].
        wanted: the speed [m/s] that time is lost against.
        to_clear: [m] until nothing is blocked.
        time_step: [s].
        costs: (k,) [s].
    """
    N = distance.shape[1] - 1
    for j in range(distance.shape[0]):
        for i in range(1, N + 1):
            if distance[j, i] < to_clear - _CLEAR:
                lasts = time_step if i < N else time_step + _BLOCKED
                costs[j] += lasts * max(0.0, 1.0 - speeds[j, i] / wanted)


@inner
def add_cost_of_others(
    others: float,
    missing: float,
    speed: float,
    gap: float,
    conflicts: float,
    calm: float,
    beyond: float,
    weights: tuple[Any, ...],
) -> tuple[float, float]:
    """Add the cost of people and vehicles at one step to that of the steps before.

    Args:
        others: the sum so far.
        missing: the longest missing stopping distance so far [m].
        speed: Speed of the manoeuvre there [m/s].
        gap: Gap to the closest person in front [m].
        conflicts: persons.
        calm: [m/s].
        beyond: [m] farther than may be driven.
        weights: the numbers of :class:`Weights`.

    Returns:
        The sum and the longest missing stopping distance with this step.
    """
    w = Weights(*weights)
    share = speed / w.reference_speed
    counted = min(conflicts, 1.0) + w.growth * max(conflicts - 1.0, 0.0)
    others += w.conflict * counted * np.sqrt(share) * max(1.0, speed / _SHARED) ** 3
    others += w.threat * max(0.0, speed - calm) / w.reference_speed
    if gap < w.safe_distance:
        others += w.nearness * (1.0 - max(gap, 0.0) / w.safe_distance) * share
        lacking = stopping_need(speed, w) - gap
        if lacking > 0.0 and speed > 0.0:
            others += w.closeness * lacking * share
            missing = max(missing, lacking)
    if beyond > 0.0:
        others += w.closeness * beyond
        missing = max(missing, beyond)
    return others, missing


@inner
def corridor(
    distance: Array,
    speeds: Array,
    gap: Array,
    allowed: Array,
    weights: tuple[Any, ...],
    room: Array,
) -> None:
    """Fill ``room`` (N,) [m]: how far a plan may have driven at steps 1 ... N.

    The plan stays behind everybody who is in front of the manoeuvre then, by the stopping distance
    of the manoeuvre's speed; it may always drive as far as the manoeuvre itself.
    """
    w = Weights(*weights)
    for i in range(len(gap)):
        station = distance[i + 1] + gap[i]
        room[i] = max(station - stopping_need(speeds[i + 1], w), distance[i + 1])
        room[i] = min(room[i], allowed[i])
