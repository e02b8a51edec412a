"""The plan along the chosen manoeuvre, in one compiled call: corridor, QP, judgement."""

from typing import Any

import numpy as np

from controller._jit import Array, inner, kernel
from controller.planning.costs import add_cost_of_others, corridor, stopping_need
from controller.planning.parameters import Weights
from controller.planning.smoothing import fill, set_target, unfold
from controller.qp.exact_solver import solve_verified

UNSOLVED = -1  # the exact methods did not end: OSQP has to
_WORSE = 1e-6  # [m] by which a smoothed plan may come closer than the manoeuvre it follows
_APPROACH = 0.8  # of the gentle braking, with which calm speeds are approached: the rest is spare

Motion = tuple[Array, Array, Array]  # distance, speed, acceleration


@kernel
def follow(
    state: tuple[float, float, float, float],
    best: Motion,
    prospect: tuple[Array, Array, Array],
    missing: float,
    bounds: tuple[Array, Array, Array],
    problem: tuple[Any, ...],
    solver: tuple[Array, Array],
    plan: Motion,
    calmly: tuple[int, float],
    weights: tuple[Any, ...],
) -> tuple[int, bool, bool]:
    """Set the QP of the smooth plan, solve it exactly, and fill the plan.

    Args:
        state: the speed [m/s], the acceleration before [m/s^2], the force before [N], the speed
            wanted [m/s].
        best: the manoeuvre.
        prospect: the arrays of what it would lead to; calm speeds become what is kept to.
        missing: stopping distance that it lacks [m].
        bounds: Distances [m] that may be driven, speeds [m/s] of the lanes (inf: any), and the
            corridor [m], which is filled; (N,) each.
        problem: nodes, intervals, limits, rows, lower, upper, target, speeds_of, gradients.
        solver: multipliers and solution.
        plan: filled, unless the QP is unsolved.
        calmly: steps in which calm speeds are kept to, as far as braking with the second [m/s^2]
            can help it.
        weights: Weights of the cost.

    Returns:
        The corrections of the active set, or ``UNSOLVED``; whether the manoeuvre
        itself is the plan; whether a stop stays possible beyond it if the last speed is kept.
    """
    speed, before, force, fastest = state
    gap, _, calm = prospect
    allowed, lane_speeds, room = bounds
    nodes, intervals, limits, rows, lower, upper, target, _, gradients = problem
    corridor(best[0], best[1], gap, allowed, weights, room)
    soon, gentle = calmly
    if gentle < np.inf:
        approach_calmly(best[0], _APPROACH * gentle, calm)
    for i in range(len(calm)):
        gently = max(calm[i], speed - gentle * limits[0] * (i + 1))
        calm[i] = min(gently if i < soon else np.inf, lane_speeds[i])
    wanted = np.empty(len(nodes))
    for i in range(len(nodes)):
        wanted[i] = best[1][nodes[i]]
    set_target(wanted, speed, before, gradients, target)
    fill(speed, force, fastest, room, calm, nodes, intervals, limits, lower, upper)
    corrections = solve_verified(rows, lower, upper, target, *solver)
    if corrections < 0:
        return UNSOLVED, False, False
    itself, holds = unfold_and_judge(
        speed, best, prospect, missing, allowed, problem, solver[1], plan, weights
    )
    return corrections, itself, holds


@inner
def approach_calmly(distance: Array, gentle: float, calm: Array) -> None:
    """Lower ``calm`` (N,) [m/s] so that braking with ``gentle`` [m/s^2] keeps to all that follows.

    Of somebody beside the way who could step on it, calm speeds tell where the hardest braking
    would have to begin. A plan that is as fast as that everywhere would brake as hard.

    Args:
        distance: (N + 1,) [m] of the manoeuvre that they belong to.
        gentle: [m/s^2].
        calm: (N,) [m/s], changed.
    """
    for i in range(len(calm) - 2, -1, -1):
        between = distance[i + 2] - distance[i + 1]
        calm[i] = min(calm[i], np.sqrt(calm[i + 1] ** 2 + 2.0 * gentle * between))


@kernel
def unfold_and_judge(
    speed: float,
    best: Motion,
    prospect: tuple[Array, Array, Array],
    missing: float,
    allowed: Array,
    problem: tuple[Any, ...],
    solution: Array,
    plan: Motion,
    weights: tuple[Any, ...],
) -> tuple[bool, bool]:
    """Fill the plan from the QP's solution; the manoeuvre itself where that comes less close.

    The arguments are those of :func:`follow`, as are the last two that it returns.
    """
    nodes, limits, speeds_of = problem[0], problem[2], problem[7]
    n = len(solution)
    at_nodes = np.empty(n)
    for i in range(n):
        value = 0.0
        for j in range(n):
            value += speeds_of[i, j] * solution[j]
        at_nodes[i] = value
    unfold(speed, at_nodes, nodes, limits[0], *plan)
    closer = missing_of(plan, best, prospect, allowed, weights) > missing + _WORSE
    if closer:
        return True, take_over(best, plan, prospect, limits[0], weights)
    return False, may_hold(plan, best, prospect, limits[0], weights)


@kernel
def take_over(
    best: Motion,
    plan: Motion,
    prospect: tuple[Array, Array, Array],
    time_step: float,
    weights: tuple[Any, ...],
) -> bool:
    """Fill the plan with the manoeuvre; whether a stop stays possible beyond it."""
    for i in range(len(plan[0])):
        plan[0][i], plan[1][i] = best[0][i], best[1][i]
    for i in range(len(plan[2])):
        plan[2][i] = best[2][i]
    return may_hold(plan, best, prospect, time_step, weights)


@inner
def missing_of(
    plan: Motion,
    best: Motion,
    prospect: tuple[Array, Array, Array],
    allowed: Array,
    weights: tuple[Any, ...],
) -> float:
    """The longest stopping distance [m] that a plan lacks, people doing as under the manoeuvre."""
    gap, conflicts, calm = prospect
    others, missing = 0.0, 0.0
    for i in range(len(gap)):
        others, missing = add_cost_of_others(
            others,
            missing,
            plan[1][i + 1],
            gap[i] + best[0][i + 1] - plan[0][i + 1],
            conflicts[i],
            calm[i],
            plan[0][i + 1] - allowed[i],
            weights,
        )
    return missing


@inner
def may_hold(
    plan: Motion,
    best: Motion,
    prospect: tuple[Array, Array, Array],
    time_step: float,
    weights: tuple[Any, ...],
) -> bool:
    """Return whether a stop stays possible if the plan's last speed is kept on."""
    v = plan[1][-1]
    gap = prospect[0][-1] + best[0][-1] - plan[0][-1]
    holds: bool = gap - time_step * v >= stopping_need(v, Weights(*weights))
    return holds
