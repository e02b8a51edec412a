"""The cost of a manoeuvre, and the corridor that it leaves to a plan."""

from typing import Any

import numpy as np

from controller._jit import Array, inner, kernel
from controller.driving_constants import COMFORTABLE
from controller.planning.cost_to_go import time_to_go
from controller.planning.parameters import Weights

_BLOCKED = 2.0  # time [s] beyond the horizon for which a manoeuvre still blocks a keep-clear zone
_CLEAR = 0.3  # tolerance [m]: a keep-clear zone counts as left this far before its end


@inner
def stopping_need(speed: float, w: Weights) -> float:
    """The distance [m] to a person in front that is needed at this speed."""
    return w.minimum_distance + w.headway * speed


@kernel
def cost(
    manoeuvre: tuple[Array, Array, Array],
    evaluation: tuple[Array, Array, Array, Array],
    allowed: Array,
    wanted: float,
    time_step: float,
    weights: tuple[Any, ...],
) -> tuple[float, float, float]:
    """Return the cost of a manoeuvre [s].

    Args:
        manoeuvre: Distances [m], speeds [m/s] and accelerations [m/s^2], (N + 1,) each.
        evaluation: Gaps [m] to the closest person in front, threat-free and passing speeds [m/s]
            at steps 1 ... N, (N,) each, and later crossings, (n, 4).
        allowed: Distances (N,) [m] that may be driven until these steps, by vehicles and lights.
        wanted: Speed [m/s] that lost time refers to.
        time_step: Control step [s].
        weights: Fields of :class:`Weights`.

    Returns:
        Whole cost [s]; part of it that people and vehicles cause [s]; largest missing stopping
        distance [m].
    """
    distance, speeds, accelerations = manoeuvre
    gap, threat_free, passing, later_crossings = evaluation
    own = own_cost(speeds, accelerations, wanted, time_step, weights)
    own += later_cost(
        later_crossings, distance[-1], speeds[-1], wanted, allowed, time_step, weights
    )
    so_far = 0.0, 0.0
    for i in range(len(gap)):
        beyond, people = distance[i + 1] - allowed[i], (gap[i], threat_free[i], passing[i])
        so_far = add_cost_of_others(so_far, speeds[i + 1], people, beyond, weights)
    others, missing = so_far
    return own + time_step * others, time_step * others, missing


@inner
def own_cost(
    speeds: Array,
    accelerations: Array,
    wanted: float,
    time_step: float,
    weights: tuple[Any, ...],
) -> float:
    """The part of a manoeuvre's cost [s] that does not depend on others: time and comfort."""
    w, own = Weights(*weights), 0.0
    for i in range(len(speeds) - 1):
        own += w.time * max(0.0, 1.0 - speeds[i + 1] / wanted)
        own += w.acceleration * accelerations[i] ** 2
    return time_step * own


@inner
def later_cost(
    later_crossings: Array,
    driven: float,
    speed: float,
    wanted: float,
    allowed: Array,
    time_step: float,
    weights: tuple[Any, ...],
) -> float:
    """Return the cost [s] beyond the horizon, see :func:`time_to_go`.

    The last speed counts up to the one from which the ego can brake for what is allowed. A plan
    thus gains nothing by being fast shortly before the end of its way.

    Args:
        later_crossings: Later crossings (n, 4), as in :class:`controller.Evaluation`.
        driven: Distance [m] of the manoeuvre at the horizon's end.
        speed: Last speed [m/s] of the manoeuvre.
        wanted: Speed [m/s] that lost time refers to.
        allowed: Distances (N,) [m] that may be driven until steps 1 ... N.
        time_step: Control step [s].
        weights: Fields of :class:`Weights`.
    """
    w, N = Weights(*weights), len(allowed)
    if allowed[N - 1] < np.inf:
        pace = max(0.0, allowed[N - 1] - allowed[N - 2]) / time_step if N > 1 else 0.0
        left = max(0.0, allowed[N - 1] - driven)
        speed = min(speed, np.sqrt(pace**2 + 2.0 * w.deceleration * left))
    later: float = w.final * max(0.0, 1.0 - speed / wanted)
    return later + w.later * time_to_go(later_crossings, speed, wanted)


@kernel
def cost_of_blocking(
    distance: Array,
    speeds: Array,
    wanted: float,
    to_clear: float,
    time_step: float,
    costs: Array,
) -> None:
    """Add to ``costs`` (k,) [s] the cost of blocking a keep-clear zone.

    Time that is lost in a keep-clear zone is added once more. A manoeuvre that ends in the zone is
    charged for ``_BLOCKED`` seconds beyond the horizon as well.

    Args:
        distance: Distances (k, N + 1) [m] of the manoeuvres.
        speeds: Speeds (k, N + 1) [m/s] of the manoeuvres.
        wanted: Speed [m/s] that lost time refers to.
        to_clear: Keep-clear distance [m]: distance to drive until the zone is free.
        time_step: Control step [s].
        costs: Costs (k,) [s], changed.
    """
    N = distance.shape[1] - 1
    for j in range(distance.shape[0]):
        for i in range(1, N + 1):
            if distance[j, i] < to_clear - _CLEAR:
                lasts = time_step if i < N else time_step + _BLOCKED
                costs[j] += lasts * max(0.0, 1.0 - speeds[j, i] / wanted)


@inner
def add_cost_of_others(
    so_far: tuple[float, float],
    speed: float,
    people: tuple[float, float, float],
    beyond: float,
    weights: tuple[Any, ...],
) -> tuple[float, float]:
    """Add the cost of people and vehicles at one step to that of the steps before.

    Args:
        so_far: Sum of the cost rate over the steps before, and their largest missing stopping
            distance [m].
        speed: Speed of the manoeuvre at this step [m/s].
        people: Gap [m] to the closest person in front, threat-free and passing speed [m/s].
        beyond: Distance [m] beyond what may be driven; negative if less is driven.
        weights: Fields of :class:`Weights`.

    Returns:
        Sum and largest missing stopping distance, both with this step.
    """
    (others, missing), (gap, threat_free, passing), w = so_far, people, Weights(*weights)
    others += w.threat * max(0.0, speed - threat_free) / w.reference_speed
    if gap < np.inf:
        passing = min(passing, np.sqrt(2.0 * COMFORTABLE * max(0.0, gap - w.minimum_distance)))
        lacking = stopping_need(speed, w) - gap
        if lacking > 0.0 and speed > 0.0:
            others += w.closeness * lacking * speed / w.reference_speed
            missing = max(missing, lacking)
    others += w.precaution * max(0.0, speed - passing) / w.reference_speed
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
    """Fill ``room`` (N,) [m]: the distance that a plan may have driven at steps 1 ... N.

    The plan keeps the stopping distance of the manoeuvre's speed to people in front of the
    manoeuvre. It may always drive as far as the manoeuvre itself.
    """
    w = Weights(*weights)
    for i in range(len(gap)):
        station = distance[i + 1] + gap[i]
        room[i] = max(station - stopping_need(speeds[i + 1], w), distance[i + 1])
        room[i] = min(room[i], allowed[i])
