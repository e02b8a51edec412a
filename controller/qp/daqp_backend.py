"""DAQP, an exact dual active-set solver: the second backend. The only file that imports daqp."""

import numpy as np

from controller._jit import Array
from controller.errors import SolverMissingError
from controller.qp.least_squares import LeastSquares, Outcome

_INFINITY = 1e30  # DAQP's
_SOLVED, _INFEASIBLE, _ITERATION_LIMIT = 1, -1, -4


class DaqpBackend:
    """Solves a least-squares problem by DAQP (Arnström, Bemporad & Axehill 2022).

    Raises:
        SolverMissingError: daqp is not installed.
    """

    def __init__(self, problem: LeastSquares, iteration_limit: int) -> None:
        try:
            import daqp
        except ImportError as error:
            raise SolverMissingError(
                "solver 'daqp' is not installed; install it with: pip install 'giveway[daqp]'"
            ) from error
        self._problem = problem
        self._daqp = daqp
        self._iteration_limit = iteration_limit
        N = problem.rows.shape[1]
        self._P = 2.0 * np.eye(N)
        self._sense = np.zeros(len(problem.rows), dtype=np.int32)

    def solve(self, solution: Array, multipliers: Array) -> tuple[Outcome, int]:
        """Solve within the problem's present bounds, as :class:`controller.qp.backends.Backend`."""
        problem = self._problem
        x, _, flag, info = self._daqp.solve(
            self._P,
            -2.0 * problem.target,
            problem.rows,
            np.minimum(problem.upper, _INFINITY),
            np.maximum(problem.lower, -_INFINITY),
            self._sense,
            iter_limit=self._iteration_limit,
        )
        iterations = int(info["iterations"])
        if flag == _SOLVED:
            solution[:] = x
            multipliers[:] = info["lam"]
            return Outcome.SOLVED, iterations
        if flag == _INFEASIBLE:
            multipliers[:] = 0.0  # DAQP gives no certificate
            return Outcome.INFEASIBLE, iterations
        return (Outcome.ITERATION_LIMIT if flag == _ITERATION_LIMIT else Outcome.FAILED), iterations
