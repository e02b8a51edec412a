"""One sequence for both quadratic programs: exact start, solver, verified optimum."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from controller._jit import Array, kernel
from controller.qp.active_set import INFEASIBLE, solve_exactly
from controller.qp.least_squares import LeastSquares, Outcome
from controller.qp.verification import certifies_infeasibility, refine

if TYPE_CHECKING:
    from controller.qp.osqp_backend import OsqpBackend

_SOLVED, _INFEASIBLE = Outcome.SOLVED, Outcome.INFEASIBLE  # whose class is slow to tell them


class ExactSolver:
    """Solves one problem again and again, as its target and bounds change.

    A solve starts from the active set of the solve before, made exact, or from an exact solve. The
    solver then only has to confirm that start. Its answer is refined to rounding, and counts only
    if the optimality conditions hold by our own arithmetic. A problem that always has a solution
    is left to the solver only where the exact methods do not end at such an optimum, and OSQP is
    not even set up before that. A fresh instance, or one after :meth:`reset`, gives the same bytes
    for the same sequence of problems.

    Args:
        problem: Problem to solve; its arrays are changed in place between solves.
        iteration_limit: Iteration limit of the solver.
        box: Range of every unknown, within which infeasibility is proved; None: the problem
            always has a solution, so that nothing is proved and an optimum is always looked for.

    Attributes:
        solution: (n,) of the latest solve.
        memory: the multipliers and the solution, for :func:`solve_verified` in a kernel.

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
        """The outcome for the problem as it is now, and the iterations.

        The solver's, or the corrections of the active set where the solver was not needed.
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
        """Start the solver at the optimum; False if it is proved that there is none."""
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
        """Make the solution exact; whether it is the verified optimum."""
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
    """Minimise |V - target|^2 exactly from the multipliers of a similar problem.

    Returns:
        The corrections or iterations, or -1 unless the optimality conditions hold.
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
    """Minimise |V - target|^2 exactly: by refining multipliers, and if that fails from scratch.

    Args:
        rows: (m, N).
        lower: (m,); -inf where there is none.
        upper: (m,); inf where there is none.
        target: (N,).
        multipliers: (m,) to start from; receives the optimum's, or a certificate of infeasibility.
        solution: (N,) receives the minimiser.
        near: the multipliers are those of a similar problem, or of an approximate solve.

    Returns:
        Corrections or iterations; below 0: no optimum was verified, see :func:`solve_exactly`.
    """
    if near:
        corrections = refine(rows, lower, upper, target, multipliers, solution)
        if corrections >= 0:
            return corrections
    return solve_exactly(rows, lower, upper, target, multipliers, solution)
