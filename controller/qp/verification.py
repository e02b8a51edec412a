"""Exactness after an approximate solve: active-set refinement, and proofs of infeasibility.

A first-order solver finds which constraints bind; linear algebra on those gives the optimum to
rounding, and the optimality conditions verify it, primal and dual (Boyd & Vandenberghe 2004,
section 5.5.3). Likewise a certificate of infeasibility counts only if our own arithmetic
confirms it over the box of possible speeds.
"""

import numpy as np
from numpy.typing import NDArray

from controller._jit import Array, inner, kernel

PRIMAL_TOLERANCE = 1e-10  # Tolerance [m/s] of constraints: rounding of sums of N speeds
_PIVOT = 1e-11  # Relative pivot below which a binding row depends on the others


@inner
def refine(
    rows: Array, lower: Array, upper: Array, target: Array, multipliers: Array, solution: Array
) -> int:
    """The exact minimiser of |V - target|^2 within the bounds, from approximate multipliers.

    Args:
        rows: (m, N).
        lower: (m,); -inf where there is none.
        upper: (m,); inf where there is none.
        target: (N,).
        multipliers: (m,) of an approximate solve: > 0 where the upper bound binds, < 0 the lower;
            receives the exact ones.
        solution: (N,) receives the minimiser.

    Returns:
        The number of corrections made to the active set, or -1 if the result is not verified.
    """
    m, N = rows.shape
    side = np.zeros(m, dtype=np.int64)  # +1: upper bound binds, -1: lower, 0: neither
    least = 1e-6 * max(1.0, largest_size(multipliers))
    for _ in range(N):  # the largest first: more than N bind only where some say the same
        i = largest_outside(multipliers, side)
        if i < 0 or not abs(multipliers[i]) > least:
            break
        side[i] = 1 if multipliers[i] > 0.0 else -1
    for correction in range(4 * N):
        active = np.flatnonzero(side)
        dual = np.zeros(len(active))
        dependent = equality_solve(rows, lower, upper, target, side, active, dual, solution)
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
                multipliers[active[a]] = 2.0 * dual[a]  # of |V - target|^2, not of its half
            return correction if is_finite(solution) else -1
        side[add] = bound
    return -1


@inner
def equality_solve(
    rows: Array,
    lower: Array,
    upper: Array,
    target: Array,
    side: NDArray[np.int64],
    active: NDArray[np.int64],
    dual: Array,
    solution: Array,
) -> int:
    """Minimise |V - target|^2 with the active rows at their bounds: a Cholesky factorisation.

    Returns:
        -1, or the position in ``active`` of a row that depends on those before it.
    """
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
    """The largest absolute value; nan if any of them is."""
    largest = 0.0
    for value in values:
        if np.isnan(value):
            return np.nan
        largest = max(largest, abs(value))
    return largest


@inner
def largest_outside(values: Array, side: NDArray[np.int64]) -> int:
    """Index of the largest absolute value whose ``side`` is 0; -1 if there is none above zero."""
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

    Every feasible V has y'(rows V) <= sum of upper y+ + lower y-; if y'(rows V) is larger than
    that everywhere in the box of possible speeds, there is none.
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
            continue  # a multiplier of a bound that is not there is rounding: leave it out
        support += y * bound
        size += abs(y * bound)
        for j in range(N):
            gradient[j] += y * rows[i, j]
    least = 0.0
    for j in range(N):
        least += min(gradient[j] * box_low, gradient[j] * box_high)
        size += abs(gradient[j]) * box_high
    return least - support > 1e-12 * size
