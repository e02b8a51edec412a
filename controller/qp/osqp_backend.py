"""The adapter to OSQP, and the only file that imports osqp.

OSQP is set up once. After that only bounds, target and start change. The paper's problem is posed
in the unknowns v(k+1), v(k+2) - v(k+1), ...: with the speeds themselves OSQP needs seven times as
many iterations from a cold start, and often does not converge.
"""

import signal

import numpy as np
import osqp
from scipy import sparse

from controller._jit import Array, kernel
from controller.errors import SolverSetupError
from controller.qp.least_squares import LeastSquares, Outcome

_INFINITY = 1e30  # OSQP's value of infinity
_INTERRUPTED = int(osqp.SolverStatus.OSQP_SIGINT)
_STATUS = {
    osqp.SolverStatus.OSQP_SOLVED: Outcome.SOLVED,
    osqp.SolverStatus.OSQP_PRIMAL_INFEASIBLE: Outcome.INFEASIBLE,
    osqp.SolverStatus.OSQP_SOLVED_INACCURATE: Outcome.INACCURATE,
    osqp.SolverStatus.OSQP_PRIMAL_INFEASIBLE_INACCURATE: Outcome.INACCURATE,
    osqp.SolverStatus.OSQP_MAX_ITER_REACHED: Outcome.ITERATION_LIMIT,
}

_INFEASIBLE, _FAILED = Outcome.INFEASIBLE, Outcome.FAILED


class OsqpBackend:
    """Solves a least-squares problem by OSQP (Stellato et al. 2020), warm-started.

    The result does not depend on a clock: there is no time limit, and the step size adapts every 50
    iterations.

    Raises:
        SolverSetupError: OSQP refuses the problem.
    """

    def __init__(self, problem: LeastSquares, iteration_limit: int) -> None:
        self._problem = problem
        count, N = problem.rows.shape
        self._aimed_at = problem.target.copy()
        solver = osqp.OSQP(algebra="builtin")
        try:
            solver.setup(
                sparse.csc_matrix(np.triu(2.0 * self._posed(self._posed(np.eye(N)).T))),  # P
                self._gradient(problem.target),  # q
                sparse.csc_matrix(self._posed(problem.rows)),
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
        self._solver = solver._solver  # the solver without its Python wrapper
        self._lower = np.empty(count)
        self._upper = np.empty(count)
        self._start = np.empty(N)
        self._memory = (self._lower, self._upper, self._aimed_at, self._start)

    def _gradient(self, target: Array) -> Array:
        """The linear cost of |x - target|^2 in the solver's unknowns."""
        return -2.0 * self._posed(target)

    def _posed(self, rows: Array) -> Array:
        """Return rows (..., N) for unknowns x as rows for the solver's unknowns.

        x is the running sum of the increments, so that these are sums from the last column on.
        """
        if not self._problem.increments:
            return rows
        return np.cumsum(rows[..., ::-1], axis=-1)[..., ::-1]

    def solve(self, solution: Array, multipliers: Array) -> tuple[Outcome, int]:
        """Solve within the problem's present bounds.

        Args:
            solution: Start (n,), changed to the solution.
            multipliers: Start (m,), changed to those of the solution or a certificate of
                infeasibility.

        Returns:
            Outcome, and number of iterations.
        """
        solver, problem = self._solver, self._problem
        posed = problem.lower, problem.upper, problem.target
        aims_elsewhere = pose(posed, solution, problem.increments, self._memory)
        q = self._gradient(problem.target) if aims_elsewhere else None
        solver.update_data_vec(q=q, l=self._lower, u=self._upper)
        solver.warm_start(self._start, multipliers)
        solver.solve()
        info = solver.info
        if info.status_val == _INTERRUPTED:
            signal.raise_signal(signal.SIGINT)  # OSQP caught Ctrl-C: raise it again
            solver.solve()
            info = solver.info
        outcome = _STATUS.get(info.status_val, _FAILED)
        found = solver.solution
        if outcome is _INFEASIBLE:
            multipliers[:] = found.prim_inf_cert
        else:
            take(found.x, found.y, problem.increments, solution, multipliers)
        return outcome, int(info.iter)


@kernel
def pose(
    problem: tuple[Array, Array, Array],
    solution: Array,
    increments: bool,
    memory: tuple[Array, Array, Array, Array],
) -> bool:
    """Fill the solver's finite bounds and start, and return whether the target has changed.

    Args:
        problem: Lower and upper bounds (m,) and target (n,) of the problem.
        solution: Solution (n,) of the problem from which to start.
        increments: Whether the solver's unknowns are increments.
        memory: Lower and upper bounds (m,), last target (n,) and start (n,) of the solver, filled.
    """
    (lower, upper, target), (low, high, aimed_at, start) = problem, memory
    for i in range(lower.size):
        low[i], high[i] = max(lower[i], -_INFINITY), min(upper[i], _INFINITY)
    elsewhere = False
    for i in range(target.size):
        elsewhere |= target[i] != aimed_at[i]
        aimed_at[i] = target[i]
        start[i] = solution[i] - solution[i - 1] if increments and i > 0 else solution[i]
    return elsewhere


@kernel
def take(x: Array, y: Array, increments: bool, solution: Array, multipliers: Array) -> None:
    """Fill the problem's solution (n,) and multipliers (m,) from the solver's ``x`` and ``y``."""
    for i in range(x.size):
        solution[i] = solution[i - 1] + x[i] if increments and i > 0 else x[i]
    multipliers[:] = y
