"""The problem that both model predictive controllers pose, and the outcomes of a solve."""

import enum
from typing import Protocol

from controller._jit import Array


class LeastSquares(Protocol):
    """min |x - target|^2 subject to lower <= rows x <= upper.

    The arrays are filled in place from step to step and never replaced.

    Attributes:
        rows: Matrix (m, n) of the constraints, constant.
        target: Target (n,), which changes from step to step.
        lower, upper: Bounds (m,), which change from step to step; infinite without a bound.
        increments: Whether the solver's unknowns are x_1, x_2 - x_1, ... instead of x.
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
    CERTIFIED = "infeasible: certified"  # giveway's own check confirms it
    INACCURATE = "inaccurate"
    ITERATION_LIMIT = "iteration limit"
    FAILED = "failed"
    UNVERIFIED = "not verified"  # solved, but giveway's own check does not confirm it
