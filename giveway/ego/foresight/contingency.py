"""Manoeuvres where somebody's intent is open: one common beginning, and a branch for either.

What somebody is about to do shows while they near the way. A manoeuvre that is right if they yield
need not wait for certainty: if they walk on after all the ego can still brake a little later. So
its cost is that under the likelier hypothesis, and that of the better branch under the other,
each weighted by its likelihood (contingency MPC, Alsterda et al. 2019).
"""

import functools
from collections.abc import Callable, Sequence

import numpy as np

from controller.kernels import Trials, branch_off

_COMMON = 0.5  # [s] of a manoeuvre, after which one knows: a walker slows by 1 m/s in it
_BRAKING = (-2.5, -5.0)  # [m/s^2] of the branches, beside going on
BRANCHES = 1 + len(_BRAKING)

Cost = Callable[[Trials, list[int], bool], float]


@functools.cache
def load() -> None:
    """Load the kernel that branches need: it would hold up the step that first needs them."""
    distance, speed, acceleration = np.zeros((3, 4))
    branch_off(distance, speed, acceleration, 1, -1.0, 4.0, 0.05)


def hedged(
    cost: Cost, trials: Trials, rows: Sequence[int], likely: float, wanted: float, time_step: float
) -> int:
    """Return the manoeuvre of least weighted cost, or -1 if that cost is no number.

    Args:
        cost: Cost [s] of the best of some rows, under the likelier hypothesis or the other.
        trials: the manoeuvres.
        rows: which of them are compared.
        likely: how likely the likelier hypothesis is.
        wanted: the speed [m/s] where nobody is in the way.
        time_step: Time step of a manoeuvre [s].
    """
    first = min(max(round(_COMMON / time_step), 1), trials.speed.shape[1] - 1)
    every = list(range(BRANCHES))
    branches = Trials(*(np.empty((len(every), *array.shape[1:])) for array in trials))
    costs = {row: cost(trials, [row], False) for row in rows}
    best, least = rows[0], np.inf
    for row in sorted(rows, key=costs.__getitem__):
        if likely * costs[row] >= least:
            break
        for array, given in zip(branches, trials, strict=True):
            array[:] = given[row]
        for k, braking in enumerate(_BRAKING, start=1):
            branch_off(*branches.of(k), first, braking, wanted, time_step)
        other = cost(branches, every, True)
        whole = likely * costs[row] + (1.0 - likely) * other
        if whole < least:
            best, least = row, whole
    return best if costs[best] < np.inf else -1
