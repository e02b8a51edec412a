"""The plan along the chosen manoeuvre, in one compiled call: corridor, QP, comparison."""

from typing import Any

import numpy as np

from controller._jit import Array, inner, kernel
from controller.planning.costs import add_cost_of_others, corridor, stopping_need
from controller.planning.motions import Motion
from controller.planning.parameters import Weights
from controller.planning.smoothing import fill, set_target, unfold
from controller.qp.exact_solver import solve_verified

UNSOLVED = -1  # result if the exact methods found no solution, so that OSQP has to
_WORSE = 1e-6  # distance [m] by which a smoothed plan may come closer than its manoeuvre
_APPROACH = 0.8  # share of the gentle deceleration with which the plan slows to a threat-free speed

Chosen = tuple[Motion, tuple[Array, Array, Array], float]
"""A manoeuvre, arrays of its predicted outcome, and the stopping distance [m] that it lacks."""


@kernel
def follow(
    state: tuple[float, float, float, float],
    chosen: Chosen,
    bounds: tuple[Array, Array, Array],
    problem: tuple[Any, ...],
    solver: tuple[Array, Array],
    plan: Motion,
    rules: tuple[int, float, tuple[Any, ...]],
) -> tuple[int, bool, bool]:
    """Set the QP of the smooth plan, solve it exactly, and fill the plan.

    Args:
        state: Speed [m/s], acceleration before [m/s^2], force before [N] and wanted speed [m/s].
        chosen: Chosen manoeuvre, its predicted outcome and what it lacks. The threat-free speeds
            of the outcome are replaced by the speed limits of the plan.
        bounds: Distances [m] that may be driven, speed limits [m/s] of the lanes (inf without),
            and the corridor [m], which is filled; (N,) each.
        problem: Arrays of `SmoothingProblem`: nodes, intervals, limits, rows, lower, upper,
            target, speeds_of, gradients.
        solver: Multipliers and solution of the solver.
        plan: Plan, filled unless the QP is unsolved.
        rules: Number of steps in which the plan keeps threat-free speeds, the largest
            deceleration [m/s^2] that it spends on this, and the weights of the cost.

    Returns:
        Number of corrections of the active set, or ``UNSOLVED``; whether the manoeuvre itself is
        the plan; whether a stop stays possible if the last speed is kept beyond the plan.
    """
    speed, before, force, fastest = state
    best, (gap, threat_free, _), _ = chosen
    soon, gentle, weights = rules
    allowed, lane_speeds, room = bounds
    nodes, intervals, limits, rows, lower, upper, target, _, gradients = problem
    corridor(best[0], best[1], gap, allowed, weights, room)
    if gentle < np.inf:
        approach_gently(best[0], _APPROACH * gentle, threat_free)
    for i in range(len(threat_free)):
        gently = max(threat_free[i], speed - gentle * limits[0] * (i + 1))
        threat_free[i] = min(gently if i < soon else np.inf, lane_speeds[i])
    wanted = np.empty(len(nodes))
    for i in range(len(nodes)):
        wanted[i] = best[1][nodes[i]]
    set_target(wanted, speed, before, gradients, target)
    fill((speed, force, fastest), room, threat_free, nodes, intervals, limits, (lower, upper))
    corrections = solve_verified(rows, lower, upper, target, *solver)
    if corrections < 0:
        return UNSOLVED, False, False
    itself, holds = unfold_and_judge(speed, chosen, allowed, problem, solver[1], plan, weights)
    return corrections, itself, holds


@inner
def approach_gently(distance: Array, gentle: float, threat_free: Array) -> None:
    """Lower ``threat_free`` so that braking with ``gentle`` is enough to keep its later speeds.

    For a person beside the path who could step on it, threat-free speeds fall as fast as the
    hardest braking allows. A plan that follows them without this would brake that hard.

    Args:
        distance: Distances (N + 1,) [m] of the manoeuvre that the speeds belong to.
        gentle: Deceleration [m/s^2].
        threat_free: Threat-free speeds (N,) [m/s], changed.
    """
    for i in range(len(threat_free) - 2, -1, -1):
        between = distance[i + 2] - distance[i + 1]
        threat_free[i] = min(
            threat_free[i], np.sqrt(threat_free[i + 1] ** 2 + 2.0 * gentle * between)
        )


@kernel
def unfold_and_judge(
    speed: float,
    chosen: Chosen,
    allowed: Array,
    problem: tuple[Any, ...],
    solution: Array,
    plan: Motion,
    weights: tuple[Any, ...],
) -> tuple[bool, bool]:
    """Fill the plan from the QP's solution, or with the manoeuvre if that keeps more distance.

    Arguments are as for :func:`follow`, and the results are its last two.
    """
    best, evaluation, missing = chosen
    nodes, limits, speeds_of = problem[0], problem[2], problem[7]
    n = len(solution)
    at_nodes = np.empty(n)
    for i in range(n):
        value = 0.0
        for j in range(n):
            value += speeds_of[i, j] * solution[j]
        at_nodes[i] = value
    unfold(speed, at_nodes, nodes, limits[0], plan)
    closer = missing_of(plan, best, evaluation, allowed, weights) > missing + _WORSE
    if closer:
        return True, take_over(best, plan, evaluation, limits[0], weights)
    return False, may_hold(plan, best, evaluation, limits[0], weights)


@kernel
def take_over(
    best: Motion,
    plan: Motion,
    evaluation: tuple[Array, Array, Array],
    time_step: float,
    weights: tuple[Any, ...],
) -> bool:
    """Fill the plan with the manoeuvre, and return whether a stop stays possible beyond it."""
    for i in range(len(plan[0])):
        plan[0][i], plan[1][i] = best[0][i], best[1][i]
    for i in range(len(plan[2])):
        plan[2][i] = best[2][i]
    return may_hold(plan, best, evaluation, time_step, weights)


@inner
def missing_of(
    plan: Motion,
    best: Motion,
    evaluation: tuple[Array, Array, Array],
    allowed: Array,
    weights: tuple[Any, ...],
) -> float:
    """The largest stopping distance [m] that a plan lacks if people move as for the manoeuvre."""
    gap, threat_free, passing = evaluation
    so_far = 0.0, 0.0
    for i in range(len(gap)):
        people = gap[i] + best[0][i + 1] - plan[0][i + 1], threat_free[i], passing[i]
        beyond = plan[0][i + 1] - allowed[i]
        so_far = add_cost_of_others(so_far, plan[1][i + 1], people, beyond, weights)
    return so_far[1]


@inner
def may_hold(
    plan: Motion,
    best: Motion,
    evaluation: tuple[Array, Array, Array],
    time_step: float,
    weights: tuple[Any, ...],
) -> bool:
    """Return whether a stop stays possible if the plan's last speed is kept for one more step."""
    v = plan[1][-1]
    gap = evaluation[0][-1] + best[0][-1] - plan[0][-1]
    holds: bool = gap - time_step * v >= stopping_need(v, Weights(*weights))
    return holds
