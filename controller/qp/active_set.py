"""An exact start for the QP solver: the dual active-set method of Goldfarb & Idnani (1983).

A first-order method that starts at the optimum only has to confirm it. From elsewhere it can need
thousands of iterations for problems in which the car stops just in time. The active-set method also
ends with a certificate of infeasibility if no plan exists.
"""

import numpy as np
from numpy.typing import NDArray

from controller._jit import Array, inner
from controller.qp.verification import PRIMAL_TOLERANCE, Projection, equality_solve

INFEASIBLE = -1
UNFINISHED = -2
_DEPENDENT = 1e-18  # squared length, relative to the row's, below which a projected row is zero


@inner
def solve_exactly(
    rows: Array, lower: Array, upper: Array, target: Array, multipliers: Array, solution: Array
) -> int:
    """Minimise |V - target|^2 within the bounds, starting at the unconstrained optimum.

    Args:
        rows: Matrix (m, N) of the constraints.
        lower: Lower bounds (m,); -inf without a bound.
        upper: Upper bounds (m,); inf without a bound.
        target: Target (N,).
        multipliers: Multipliers (m,), filled: those of the optimum, or a certificate of
            infeasibility.
        solution: Minimiser (N,), filled.

    Returns:
        Number of iterations, or INFEASIBLE or UNFINISHED.
    """
    m, N = rows.shape
    problem = Projection(rows, lower, upper, target)
    side = np.zeros(m, dtype=np.int64)
    dual = np.zeros(m)  # multipliers of the active rows, >= 0; `side` has their signs
    for j in range(len(target)):
        solution[j] = target[j]
    violated = -1
    for iteration in range(10 * N):
        if violated < 0:
            violated, direction = most_violated(rows, lower, upper, side, solution)
            if violated < 0:
                return finish(problem, side, multipliers, solution, iteration)
            side_of_violated = direction
            price = 0.0
        active = np.flatnonzero(side)
        share = np.zeros(len(active))
        step = projected(rows, side, active, violated, side_of_violated, share)
        length = 0.0
        for j in range(N):
            length += step[j] * step[j]

        partial, blocking = np.inf, -1
        for a in range(len(active)):
            if share[a] > 0.0 and dual[active[a]] < partial * share[a]:
                partial, blocking = dual[active[a]] / share[a], active[a]
        size = 0.0
        for j in range(N):
            size += rows[violated, j] * rows[violated, j]
        independent = length > _DEPENDENT * size
        full = np.inf
        if independent:
            excess = violation(
                rows[violated], lower[violated], upper[violated], side_of_violated, solution
            )
            full = excess / length
        taken = min(partial, full)
        if not taken < np.inf:
            certificate(side, active, share, violated, side_of_violated, multipliers)
            return INFEASIBLE
        for a in range(len(active)):
            dual[active[a]] -= taken * share[a]
        price += taken
        if independent:
            for j in range(N):
                solution[j] -= taken * step[j]
        if full <= partial:
            side[violated] = side_of_violated
            dual[violated] = price
            violated = -1
        else:
            side[blocking] = 0
            dual[blocking] = 0.0
    return UNFINISHED


@inner
def violation(row: Array, low: float, high: float, direction: int, solution: Array) -> float:
    """Return by how much ``solution`` violates one bound of ``row``; negative if it keeps it."""
    value = 0.0
    for j in range(len(solution)):
        value += row[j] * solution[j]
    return value - high if direction > 0 else low - value


@inner
def most_violated(
    rows: Array, lower: Array, upper: Array, side: NDArray[np.int64], solution: Array
) -> tuple[int, int]:
    """Return the row that violates a bound most, or -1, and the bound: +1 upper, -1 lower."""
    m, N = rows.shape
    worst, found, direction = PRIMAL_TOLERANCE, -1, 0
    for i in range(m):
        if side[i] != 0:
            continue
        value = 0.0
        for j in range(N):
            value += rows[i, j] * solution[j]
        if value - upper[i] > worst:
            worst, found, direction = value - upper[i], i, 1
        if lower[i] - value > worst:
            worst, found, direction = lower[i] - value, i, -1
    return found, direction


@inner
def projected(
    rows: Array,
    side: NDArray[np.int64],
    active: NDArray[np.int64],
    violated: int,
    direction: int,
    share: Array,
) -> Array:
    """The normal of the violated row without its part in the span of the active rows.

    ``share`` receives the coefficients of this part. They are a least-squares fit by modified
    Gram-Schmidt, which is more accurate than the normal equations.
    """
    size, N = len(active), rows.shape[1]
    basis = np.empty((size, N))
    triangle = np.zeros((size, size))
    for a in range(size):
        for j in range(N):
            basis[a, j] = side[active[a]] * rows[active[a], j]
        for b in range(a):
            product = 0.0
            for j in range(N):
                product += basis[b, j] * basis[a, j]
            triangle[b, a] = product
            for j in range(N):
                basis[a, j] -= product * basis[b, j]
        length = 0.0
        for j in range(N):
            length += basis[a, j] * basis[a, j]
        triangle[a, a] = np.sqrt(length)
        for j in range(N):
            basis[a, j] /= triangle[a, a]
    rest = np.empty(N)
    for j in range(N):
        rest[j] = direction * rows[violated, j]
    for a in range(size):
        product = 0.0
        for j in range(N):
            product += basis[a, j] * rest[j]
        share[a] = product
        for j in range(N):
            rest[j] -= product * basis[a, j]
    for a in range(size - 1, -1, -1):
        for b in range(a + 1, size):
            share[a] -= triangle[a, b] * share[b]
        share[a] /= triangle[a, a]
    return rest


@inner
def finish(
    problem: Projection,
    side: NDArray[np.int64],
    multipliers: Array,
    solution: Array,
    iterations: int,
) -> int:
    """Compute the optimum on the final active set anew, without accumulated rounding errors."""
    active = np.flatnonzero(side)
    dual = np.zeros(len(active))
    if equality_solve(problem, side, active, dual, solution) >= 0:
        return UNFINISHED
    multipliers[:] = 0.0
    for a in range(len(active)):
        multipliers[active[a]] = 2.0 * dual[a]
    return iterations


@inner
def certificate(
    side: NDArray[np.int64],
    active: NDArray[np.int64],
    share: Array,
    violated: int,
    direction: int,
    multipliers: Array,
) -> None:
    """Fill ``multipliers`` (m,) with Farkas' multipliers, which prove infeasibility."""
    multipliers[:] = 0.0
    multipliers[violated] = direction
    for a in range(len(active)):
        multipliers[active[a]] = -share[a] * side[active[a]]
