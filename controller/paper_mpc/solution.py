"""The solution of the paper's controller."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class MpcSolution(NamedTuple):
    """A plan, or why there is none.

    Attributes:
        found: Whether the plan is optimal and keeps all constraints by our own arithmetic.
        force: Force u(k) [N]; nan without a plan.
        forces: (N,) Planned forces u(k) ... u(k+N-1) [N]; None without a plan.
        speeds: (N,) Planned speeds at k+1 ... k+N [m/s]; None without a plan.
        status: Outcome of the solver, with the proof if no plan can exist.
        iterations: Iterations of the solver; 0 if no solve was needed.
        residual: Largest constraint violation over its tolerance; nan without a plan.
    """

    found: bool
    force: float
    forces: NDArray[np.float64] | None
    speeds: NDArray[np.float64] | None
    status: str
    iterations: int
    residual: float
