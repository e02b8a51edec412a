"""The solution of the paper's controller."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class MpcSolution(NamedTuple):
    """The plan of the MPC, or the reason why there is none.

    Attributes:
        found: Whether the plan is optimal and was checked to keep all constraints.
        force: Force u(k) [N]; nan without a plan.
        forces: Planned forces u(k) ... u(k+N-1), (N,) [N]; None without a plan.
        speeds: Planned speeds at k+1 ... k+N, (N,) [m/s]; None without a plan.
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
