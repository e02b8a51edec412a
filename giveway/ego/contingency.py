"""Manoeuvres where somebody's intent is open: one common beginning, and a branch for either.

What somebody is about to do shows while they near the way. A manoeuvre that is right if they yield
need not wait for certainty: if they walk on after all the ego can still brake a little later. So
its cost is that under the likelier hypothesis, and that of the better branch under the other,
each weighted by its likelihood (contingency MPC, Alsterda et al. 2019).
"""

from collections.abc import Callable, Sequence

import numpy as np

from controller import Trials, branch_off

_COMMON = 0.5  # [s] of a manoeuvre, after which one knows: a walker slows by 1 m/s in it
_BRAKING = (-2.5, -5.0)  # [m/s^2] of the branches, beside going on

Cost = Callable[[Trials, int, bool], float]


def hedged(
    cost: Cost, trials: Trials, rows: Sequence[int], likely: float, wanted: float, time_step: float
) -> int:
    """The manoeuvre of least weighted cost.

    Args:
        cost: of a row of the trials [s]; whether under the less likely hypothesis.
        trials: the manoeuvres.
        rows: which of them are compared.
        likely: how likely the likelier hypothesis is.
        wanted: the speed [m/s] where nobody is in the way.
        time_step: of a manoeuvre [s].
    """
    first = min(max(round(_COMMON / time_step), 1), trials.speed.shape[1] - 1)
    branches = Trials(*(array.copy() for array in trials))
    costs = {row: cost(trials, row, False) for row in rows}
    best, least = rows[0], np.inf
    for row in sorted(rows, key=costs.__getitem__):
        if likely * costs[row] >= least:
            break
        other = cost(branches, row, True)
        for braking in _BRAKING:
            branch_off(*branches.of(row), first, braking, wanted, time_step)
            other = min(other, cost(branches, row, True))
        whole = likely * costs[row] + (1.0 - likely) * other
        if whole < least:
            best, least = row, whole
    return best
