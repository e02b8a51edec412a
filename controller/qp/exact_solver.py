"""The solution of both quadratic programs: exact start, solver, verification of the optimum."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from controller._jit import Array, kernel
from controller.qp.active_set import INFEASIBLE, solve_exactly
from controller.qp.least_squares import LeastSquares, Outcome
from controller.qp.verification import certifies_infeasibility, refine

if TYPE_CHECKING:
    from controller.qp.osqp_backend import OsqpBackend

_SOLVED, _INFEASIBLE = Outcome.SOLVED, Outcome.INFEASIBLE


class ExactSolver:
    """Solves one problem repeatedly, as its target and bounds change.

    A solve starts from the refined active set of the solve before, or from an exact solve. The
    solver then only has to confirm this start. Its answer is refined, and accepted only if the
    optimality conditions hold. For a problem that always has a solution, the solver is used only if
    the exact methods do not find an optimum; OSQP is then set up at its first use. A new instance,
    or one after :meth:`reset`, gives the same bytes for the same sequence of problems.

    Args:
        problem: Problem to solve. Its arrays are changed in place between solves.
        iteration_limit: Iteration limit of the solver.
        box: Range of every unknown, within which infeasibility is proved, or None if the problem
            always has a solution.

    Attributes:
        solution: Solution (n,) of the latest solve.
        memory: Multipliers and solution, for :func:`solve_verified` in a kernel.

    Raises:
        SolverSetupError: the solver cannot be used.
    """

    def __init__(
        self,
        problem: LeastSquares,
        iteration_limit: int,
        box: tuple[float, float] | None,
    ) -> None:
        self._problem, self._limit, self._box = problem, iteration_limit, box
        self._bounds = (problem.rows, problem.lower, problem.upper)
        count, n = problem.rows.shape
        self.solution = np.empty(n)
        self._multipliers = np.zeros(count)
        self.memory = (self._multipliers, self.solution)
        self.reset()

    def reset(self) -> None:
        """Forget earlier problems."""
        self._backend: OsqpBackend | None = None if self._box is None else self._made()
        self._multipliers[:] = 0.0

    def _made(self) -> OsqpBackend:
        # OSQP and scipy's sparse matrices take 0.1 s to import, and most drives never need them.
        from controller.qp.osqp_backend import OsqpBackend

        return OsqpBackend(self._problem, self._limit)

    def solve(self) -> tuple[Outcome, int]:
        """Solve the problem as it is now, and return the outcome and the number of iterations.

        Without a call of the solver, the number is that of corrections to the active set.
        """
        if self._box is None:
            corrections = solve_verified(
                *self._bounds, self._problem.target, self._multipliers, self.solution
            )
            if corrections >= 0:
                return _SOLVED, corrections
        if not self._start():
            return Outcome.CERTIFIED, 0
        self._backend = backend = self._backend or self._made()
        outcome, iterations = backend.solve(self.solution, self._multipliers)
        if outcome is _INFEASIBLE and self._certified():
            outcome = Outcome.CERTIFIED
        if outcome is _SOLVED or self._box is None:
            if self._verified(outcome):
                return _SOLVED, iterations
            outcome = Outcome.UNVERIFIED
        self._multipliers[:] = 0.0
        return outcome, iterations

    def _start(self) -> bool:
        """Set the start of the solver to the optimum; return False if infeasibility is proved."""
        code = solve_from(
            *self._bounds, self._problem.target, self._multipliers, self.solution, True
        )
        if code >= 0:
            return True
        proved = code == INFEASIBLE and self._certified()
        self._multipliers[:] = 0.0
        self.solution[:] = self._problem.target  # leave it to the solver
        return not proved

    def _verified(self, outcome: Outcome) -> bool:
        """Refine the solution, and return whether it is the verified optimum."""
        near = outcome is _SOLVED
        work = (*self._bounds, self._problem.target, self._multipliers, self.solution)
        return solve_from(*work, near) >= 0

    def _certified(self) -> bool:
        """Return whether the multipliers prove that the problem has no solution."""
        if self._box is None:
            return False
        return certifies_infeasibility(*self._bounds, *self._box, self._multipliers)


@kernel
def solve_verified(
    rows: Array,
    lower: Array,
    upper: Array,
    target: Array,
    multipliers: Array,
    solution: Array,
) -> int:
    """Minimise |V - target|^2 exactly, starting from the multipliers of a similar problem.

    Arguments are as for :func:`solve_from`.

    Returns:
        Number of corrections or iterations, or -1 if the optimality conditions do not hold.
    """
    corrections = refine(rows, lower, upper, target, multipliers, solution)
    if corrections >= 0:
        return corrections
    iterations = solve_exactly(rows, lower, upper, target, multipliers, solution)
    if iterations < 0 or refine(rows, lower, upper, target, multipliers, solution) < 0:
        multipliers[:] = 0.0
        return -1
    return iterations


@kernel
def solve_from(
    rows: Array,
    lower: Array,
    upper: Array,
    target: Array,
    multipliers: Array,
    solution: Array,
    near: bool,
) -> int:
    """Minimise |V - target|^2 exactly, by refining multipliers or, if that fails, from scratch.

    Args:
        rows: Matrix (m, N) of the constraints.
        lower: Lower bounds (m,); -inf without a bound.
        upper: Upper bounds (m,); inf without a bound.
        target: Target (N,).
        multipliers: Multipliers (m,) to start from, changed: those of the optimum, or a
            certificate of infeasibility.
        solution: Minimiser (N,), filled.
        near: Whether the multipliers are those of a similar problem or of an approximate solve.

    Returns:
        Number of corrections or iterations, or a number below 0 if no optimum was verified, see
        :func:`solve_exactly`.
    """
    if near:
        corrections = refine(rows, lower, upper, target, multipliers, solution)
        if corrections >= 0:
            return corrections
    return solve_exactly(rows, lower, upper, target, multipliers, solution)
