"""Refines and verifies the result of an approximate solver, and verifies infeasibility.

A first-order solver finds the active constraints. Linear algebra on these gives the optimum to
rounding, and the primal and dual optimality conditions verify it (Boyd & Vandenberghe 2004,
section 5.5.3). A certificate of infeasibility is accepted only if it holds over the whole box of
possible speeds.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from controller._jit import Array, inner, kernel

PRIMAL_TOLERANCE = 1e-10  # tolerance [m/s] of constraints, for the rounding of sums of N speeds
_PIVOT = 1e-11  # relative pivot below which an active row depends on the others


class Projection(NamedTuple):
    """The problem to minimise |V - target|^2 subject to lower <= rows V <= upper."""

    rows: Array  # (m, N)
    lower: Array  # (m,); -inf where there is none
    upper: Array  # (m,); inf where there is none
    target: Array  # (N,)


@inner
def refine(
    rows: Array, lower: Array, upper: Array, target: Array, multipliers: Array, solution: Array
) -> int:
    """Find the exact minimiser of |V - target|^2 within the bounds from approximate multipliers.

    Args:
        rows: Matrix (m, N) of the constraints.
        lower: Lower bounds (m,); -inf without a bound.
        upper: Upper bounds (m,); inf without a bound.
        target: Target (N,).
        multipliers: Multipliers (m,) of an approximate solve, > 0 where the upper bound is active
            and < 0 where the lower one is; changed to the exact ones.
        solution: Minimiser (N,), filled.

    Returns:
        Number of corrections to the active set, or -1 if the result is not verified.
    """
    m, N = rows.shape
    problem = Projection(rows, lower, upper, target)
    side = np.zeros(m, dtype=np.int64)  # +1 if the upper bound is active, -1 the lower, 0 none
    least = 1e-6 * max(1.0, largest_size(multipliers))
    for _ in range(N):  # the largest first; more than N active rows are linearly dependent
        i = largest_outside(multipliers, side)
        if i < 0 or not abs(multipliers[i]) > least:
            break
        side[i] = 1 if multipliers[i] > 0.0 else -1
    for correction in range(4 * N):
        active = np.flatnonzero(side)
        dual = np.zeros(len(active))
        dependent = equality_solve(problem, side, active, dual, solution)
        if dependent >= 0:
            side[active[dependent]] = 0
            continue
        worst, drop = -1e-11, -1
        for a in range(len(active)):
            signed = dual[a] * side[active[a]]
            if signed < worst:
                worst, drop = signed, active[a]
        if drop >= 0:
            side[drop] = 0
            continue
        worst, add = PRIMAL_TOLERANCE, -1
        for i in range(m):
            value = 0.0
            for j in range(N):
                value += rows[i, j] * solution[j]
            if value - upper[i] > worst and side[i] == 0:
                worst, add, bound = value - upper[i], i, 1
            if lower[i] - value > worst and side[i] == 0:
                worst, add, bound = lower[i] - value, i, -1
        if add < 0:
            multipliers[:] = 0.0
            for a in range(len(active)):
                multipliers[active[a]] = 2.0 * dual[a]  # for |V - target|^2 and not half of it
            return correction if is_finite(solution) else -1
        side[add] = bound
    return -1


@inner
def equality_solve(
    problem: Projection,
    side: NDArray[np.int64],
    active: NDArray[np.int64],
    dual: Array,
    solution: Array,
) -> int:
    """Minimise |V - target|^2 with the active rows at their bounds, by a Cholesky factorisation.

    Returns:
        -1, or the index in ``active`` of a row that depends linearly on those before it.
    """
    rows, lower, upper, target = problem
    size, N = len(active), rows.shape[1]
    factor = np.empty((size, size))
    right = np.empty(size)
    for a in range(size):
        row = rows[active[a]]
        bound = upper[active[a]] if side[active[a]] > 0 else lower[active[a]]
        value = 0.0
        for j in range(N):
            value += row[j] * target[j]
        right[a] = value - bound
        scale = 0.0
        for j in range(N):
            scale += row[j] * row[j]
        for b in range(a + 1):
            other = rows[active[b]]
            product = 0.0
            for j in range(N):
                product += row[j] * other[j]
            for c in range(b):
                product -= factor[a, c] * factor[b, c]
            if b < a:
                factor[a, b] = product / factor[b, b]
            elif product <= _PIVOT * scale:
                return a
            else:
                factor[a, a] = np.sqrt(product)
    for a in range(size):
        value = right[a]
        for c in range(a):
            value -= factor[a, c] * dual[c]
        dual[a] = value / factor[a, a]
    for a in range(size - 1, -1, -1):
        value = dual[a]
        for c in range(a + 1, size):
            value -= factor[c, a] * dual[c]
        dual[a] = value / factor[a, a]
    for j in range(N):
        value = target[j]
        for a in range(size):
            value -= rows[active[a], j] * dual[a]
        solution[j] = value
    return -1


@inner
def largest_size(values: Array) -> float:
    """The largest absolute value, or nan if one of them is nan."""
    largest = 0.0
    for value in values:
        if np.isnan(value):
            return np.nan
        largest = max(largest, abs(value))
    return largest


@inner
def largest_outside(values: Array, side: NDArray[np.int64]) -> int:
    """The index of the largest absolute value whose ``side`` is 0, or -1 if none is above 0."""
    largest, index = 0.0, -1
    for i in range(len(values)):
        if side[i] == 0 and abs(values[i]) > largest:
            largest, index = abs(values[i]), i
    return index


@inner
def is_finite(values: Array) -> bool:
    """Return whether all of ``values`` are finite."""
    for value in values:  # noqa: SIM110 - numba compiles no generator
        if not np.isfinite(value):
            return False
    return True


@kernel
def certifies_infeasibility(
    rows: Array, lower: Array, upper: Array, box_low: float, box_high: float, certificate: Array
) -> bool:
    """Return whether ``certificate`` (m,) proves that no V in the box keeps all rows (Farkas).

    Every feasible V has y'(rows V) <= sum of upper y+ + lower y-. If y'(rows V) is larger than
    this everywhere in the box, no V is feasible.
    """
    m, N = rows.shape
    largest = largest_size(certificate)
    if not (np.isfinite(largest) and largest > 0.0):
        return False
    support = 0.0
    size = 0.0
    gradient = np.zeros(N)
    for i in range(m):
        y = certificate[i] / largest
        bound = upper[i] if y > 0.0 else lower[i]
        if y == 0.0 or not np.isfinite(bound):
            continue  # a multiplier of an infinite bound is a rounding error
        support += y * bound
        size += abs(y * bound)
        for j in range(N):
            gradient[j] += y * rows[i, j]
    least = 0.0
    for j in range(N):
        least += min(gradient[j] * box_low, gradient[j] * box_high)
        size += abs(gradient[j]) * box_high
    return least - support > 1e-12 * size
