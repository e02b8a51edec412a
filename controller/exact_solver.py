"""One sequence for both quadratic programs: exact start, solver, verified optimum."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from controller.active_set import INFEASIBLE, solve_exactly
from controller.backends import make_backend
from controller.least_squares import Outcome
from controller.verification import certifies_infeasibility, refine

if TYPE_CHECKING:
    from controller.defaults import SolverName
    from controller.least_squares import LeastSquares


class ExactSolver:
    """Solves one problem again and again, as its target and bounds change.

    A solve starts from the active set of the solve before, made exact, or from an exact solve. The
    solver then only has to confirm that start. Its answer is refined to rounding, and counts only
    if the optimality conditions hold by our own arithmetic. A fresh instance, or one after
    :meth:`reset`, gives the same bytes for the same sequence of problems.

    Args:
        problem: to be solved; its arrays are changed in place between solves.
        solver: which one.
        iteration_limit: of the solver.
        box: the range of every unknown, within which infeasibility is proved; None: the problem
            always has a solution, so that nothing is proved and an optimum is always looked for.

    Attributes:
        solution: (n,) of the latest solve.

    Raises:
        SolverMissingError, SolverSetupError: the solver cannot be used.
    """

    def __init__(
        self,
        problem: LeastSquares,
        solver: SolverName,
        iteration_limit: int,
        box: tuple[float, float] | None,
    ) -> None:
        self._problem, self._solver, self._limit, self._box = problem, solver, iteration_limit, box
        self._bounds = (problem.rows, problem.lower, problem.upper)
        count, n = problem.rows.shape
        self.solution = np.empty(n)
        self._multipliers = np.zeros(count)
        self.reset()

    def reset(self) -> None:
        """Forget earlier problems."""
        self._backend = make_backend(self._solver, self._problem, self._limit)
        self._multipliers[:] = 0.0

    def solve(self) -> tuple[Outcome, int]:
        """The outcome for the problem as it is now, and the solver's iterations."""
        if not self._start():
            return Outcome.CERTIFIED, 0
        outcome, iterations = self._backend.solve(self.solution, self._multipliers)
        if outcome is Outcome.INFEASIBLE and self._certified():
            outcome = Outcome.CERTIFIED
        if outcome is Outcome.SOLVED or self._box is None:
            if self._verified(outcome):
                return Outcome.SOLVED, iterations
            outcome = Outcome.UNVERIFIED
        self._multipliers[:] = 0.0
        return outcome, iterations

    def _start(self) -> bool:
        """Start the solver at the optimum; False if it is proved that there is none."""
        work = (*self._bounds, self._problem.target, self._multipliers, self.solution)
        if refine(*work) >= 0:
            return True
        code = solve_exactly(*work)
        if code >= 0:
            return True
        proved = code == INFEASIBLE and self._certified()
        self._multipliers[:] = 0.0
        self.solution[:] = self._problem.target  # leave it to the solver
        return not proved

    def _verified(self, outcome: Outcome) -> bool:
        """Make the solution exact; whether it is the verified optimum."""
        work = (*self._bounds, self._problem.target, self._multipliers, self.solution)
        if outcome is Outcome.SOLVED and refine(*work) >= 0:
            return True
        return solve_exactly(*work) >= 0

    def _certified(self) -> bool:
        """Whether the multipliers prove that the problem has no solution."""
        if self._box is None:
            return False
        return certifies_infeasibility(*self._bounds, *self._box, self._multipliers)
