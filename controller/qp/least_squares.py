"""The problem that both model predictive controllers pose, and what a solver says of it."""

import enum
from typing import Protocol

from controller._jit import Array


class LeastSquares(Protocol):
    """min |x - target|^2 subject to lower <= rows x <= upper.

    The arrays are filled in place from step to step and never replaced.

    Attributes:
        rows: (m, n), constant.
        target: (n,); changes from step to step, as the bounds do.
        lower, upper: (m,); infinite where there is none.
        increments: whether the solver is to get x_1, x_2 - x_1, ... instead of x.
    """

    rows: Array
    target: Array
    lower: Array
    upper: Array
    increments: bool


class Outcome(enum.StrEnum):
    """The outcome of a solve; only SOLVED is ever accepted."""

    SOLVED = "solved"
    INFEASIBLE = "infeasible: by the solver"
    CERTIFIED = "infeasible: certified"  # by our own arithmetic
    INACCURATE = "inaccurate"
    ITERATION_LIMIT = "iteration limit"
    FAILED = "failed"
    UNVERIFIED = "not verified"  # solved, but our own arithmetic does not confirm it
