"""Contingency plans for people of uncertain intent: a common first part, and two branches.

A person's intent becomes clear while they approach the ego's path. A manoeuvre that suits people
who yield need not wait for certainty: if they walk on, the ego can still brake a little later. Its
cost is therefore the cost under the likelier hypothesis, plus the cost of the best branch under
the other hypothesis, each weighted by its probability (contingency MPC, Alsterda et al. 2019).
"""

import functools
from collections.abc import Callable, Sequence

import numpy as np

from controller import driving_constants
from controller.kernels import Trials, branch_off

# Duration [s] of the common first part. A person who yields slows by about 1 m/s in this time,
# which reveals the intent.
_COMMON = 0.5
BRANCHES = 1 + len(driving_constants.BRANCHES)  # number of branches; the first one goes on

Cost = Callable[[Trials, list[int], bool], float]


@functools.cache
def load() -> None:
    """Load the kernel of the branches before the drive, so that no control step waits for it."""
    distance, speed, acceleration = np.zeros((3, 4))
    branch_off((distance, speed, acceleration), 1, -1.0, 4.0, 0.05)


def hedged(
    cost: Cost, trials: Trials, rows: Sequence[int], likely: float, wanted: float, time_step: float
) -> int:
    """Return the row of the manoeuvre with the least weighted cost, or -1 if none is finite.

    Args:
        cost: Function that returns the cost [s] of the best of some rows. Its last argument is
            False for the likelier hypothesis and True for the other one.
        trials: Manoeuvres.
        rows: Rows of the manoeuvres that are compared.
        likely: Probability of the likelier hypothesis.
        wanted: Speed [m/s] of the ego with nobody in its way.
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
        for k, braking in enumerate(driving_constants.BRANCHES, start=1):
            branch_off(branches.of(k), first, braking, wanted, time_step)
        other = cost(branches, every, True)
        whole = likely * costs[row] + (1.0 - likely) * other
        if whole < least:
            best, least = row, whole
    return best if costs[best] < np.inf else -1
