"""Which solver works on a least-squares problem: the one place where the choice is made."""

from typing import Protocol

from controller._jit import Array
from controller.daqp_backend import DaqpBackend
from controller.defaults import SolverName
from controller.least_squares import LeastSquares, Outcome
from controller.osqp_backend import OsqpBackend


class Backend(Protocol):
    """A solver, set up for one problem whose target and bounds change from step to step."""

    def solve(self, solution: Array, multipliers: Array) -> tuple[Outcome, int]:
        """Solve within the problem's present bounds.

        Args:
            solution: (n,) start; receives the solution.
            multipliers: (m,) start; receives the solution's, or the certificate of infeasibility.

        Returns:
            The outcome and the number of iterations.
        """


def make_backend(name: SolverName, problem: LeastSquares, iteration_limit: int) -> Backend:
    """A fresh solver for a problem.

    Raises:
        SolverMissingError, SolverSetupError: the solver cannot be used.
    """
    backend = OsqpBackend if name == "osqp" else DaqpBackend
    return backend(problem, iteration_limit)
