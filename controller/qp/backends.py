"""Which solver works on a least-squares problem: the one place where the choice is made.

A solver is imported when it is set up: OSQP and scipy's sparse matrices take a tenth of a second,
and most drives never need them.
"""

from typing import Protocol

from controller._jit import Array
from controller.defaults import SolverName
from controller.qp.least_squares import LeastSquares, Outcome


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
    if name == "osqp":
        from controller.qp.osqp_backend import OsqpBackend

        return OsqpBackend(problem, iteration_limit)
    from controller.qp.daqp_backend import DaqpBackend

    return DaqpBackend(problem, iteration_limit)
