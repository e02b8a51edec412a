"""OSQP: set up once, then only bounds, target and start change. The only file that imports osqp.

It gets the paper's problem in the unknowns v(k+1), v(k+2) - v(k+1), ...: from a cold start it needs
a seventh of the iterations that the speeds themselves cost it, and they would often not converge.
"""

import signal

import numpy as np
import osqp
from scipy import sparse

from controller._jit import Array
from controller.errors import SolverSetupError
from controller.least_squares import LeastSquares, Outcome

_INFINITY = 1e30  # OSQP's
_STATUS = {
    osqp.SolverStatus.OSQP_SOLVED: Outcome.SOLVED,
    osqp.SolverStatus.OSQP_PRIMAL_INFEASIBLE: Outcome.INFEASIBLE,
    osqp.SolverStatus.OSQP_SOLVED_INACCURATE: Outcome.INACCURATE,
    osqp.SolverStatus.OSQP_PRIMAL_INFEASIBLE_INACCURATE: Outcome.INACCURATE,
    osqp.SolverStatus.OSQP_MAX_ITER_REACHED: Outcome.ITERATION_LIMIT,
}


class OsqpBackend:
    """Solves a least-squares problem by OSQP (Stellato et al. 2020), warm-started.

    Nothing depends on a clock: no time limit, and the step size adapts every 50 iterations.

    Raises:
        SolverSetupError: OSQP refuses the problem.
    """

    def __init__(self, problem: LeastSquares, iteration_limit: int) -> None:
        self._problem = problem
        count, N = problem.rows.shape
        increments = problem.increments
        self._sums = sums = np.tril(np.ones((N, N))) if increments else np.eye(N)  # x = sums dx
        self._aimed_at = problem.target.copy()
        solver = osqp.OSQP(algebra="builtin")
        try:
            solver.setup(
                sparse.csc_matrix(np.triu(2.0 * sums.T @ sums)),  # P
                self._gradient(problem.target),  # q
                sparse.csc_matrix(problem.rows @ sums),
                np.full(count, -_INFINITY),
                np.full(count, _INFINITY),
                verbose=False,
                warm_starting=True,
                eps_abs=1e-4,
                eps_rel=1e-4,
                check_termination=5,
                adaptive_rho_interval=50,
                max_iter=iteration_limit,
            )
        except (osqp.OSQPException, ValueError) as error:
            raise SolverSetupError(
                f"OSQP refuses the MPC's problem at set-up ({error}); check [mpc] and [vehicle]"
            ) from error
        self._solver = solver._solver  # the wrapper's solve() copies and checks for 20 us
        self._lower = np.empty(count)
        self._upper = np.empty(count)
        self._start = np.empty(N)

    def _gradient(self, target: Array) -> Array:
        """The linear cost of |x - target|^2 in the solver's unknowns."""
        return np.asarray(-2.0 * self._sums.T @ target)

    def solve(self, solution: Array, multipliers: Array) -> tuple[Outcome, int]:
        """Solve within the problem's present bounds, as :class:`controller.backends.Backend`."""
        solver = self._solver
        np.maximum(self._problem.lower, -_INFINITY, out=self._lower)
        np.minimum(self._problem.upper, _INFINITY, out=self._upper)
        q = None
        if not np.array_equal(self._problem.target, self._aimed_at):
            self._aimed_at[:] = self._problem.target
            q = self._gradient(self._problem.target)
        solver.update_data_vec(q=q, l=self._lower, u=self._upper)
        self._start[:] = solution
        if self._problem.increments:
            np.subtract(solution[1:], solution[:-1], out=self._start[1:])
        solver.warm_start(self._start, multipliers)
        solver.solve()
        if solver.info.status_val == osqp.SolverStatus.OSQP_SIGINT:
            signal.raise_signal(signal.SIGINT)  # OSQP swallowed it: hand it to whose it is
            solver.solve()
        outcome = _STATUS.get(solver.info.status_val, Outcome.FAILED)
        if outcome is Outcome.INFEASIBLE:
            multipliers[:] = solver.solution.prim_inf_cert
        else:
            if self._problem.increments:
                np.cumsum(solver.solution.x, out=solution)
            else:
                solution[:] = solver.solution.x
            multipliers[:] = solver.solution.y
        return outcome, int(solver.info.iter)
