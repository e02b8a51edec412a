"""What a solve gives back."""

from __future__ import annotations

import enum
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Outcome(enum.StrEnum):
    """What a solver says of a problem; only SOLVED is ever accepted."""

    SOLVED = "solved"
    INFEASIBLE = "infeasible"
    INACCURATE = "inaccurate"
    ITERATION_LIMIT = "iteration limit"
    FAILED = "failed"


@dataclass(frozen=True, slots=True)
class MpcSolution:
    """A plan, or why there is none.

    Attributes:
        found: whether the plan is optimal and keeps all constraints by our own arithmetic.
        force: u(k) [N]; nan without a plan.
        forces: (N,) the plan u(k) ... u(k+N-1) [N]; None without one.
        speeds: (N,) the plan's speeds at k+1 ... k+N [m/s]; None without one.
        status: the solver's outcome, with the proof where no plan can exist.
        iterations: of the solver; 0 where the answer took no solve.
        residual: the plan's largest constraint violation over its tolerance; nan without one.
    """

    found: bool
    force: float
    forces: NDArray[np.float64] | None
    speeds: NDArray[np.float64] | None
    status: str
    iterations: int
    residual: float
