"""What a solve of the paper's controller gives back."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class MpcSolution(NamedTuple):
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
