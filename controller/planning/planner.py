"""The planning MPC: choose a manoeuvre, smooth it by a QP, and keep what was planned."""

from __future__ import annotations

from math import inf, isfinite
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from controller.active_set import solve_exactly
from controller.daqp_backend import DaqpBackend
from controller.errors import ParameterError
from controller.osqp_backend import OsqpBackend
from controller.planning.manoeuvre import Manoeuvre, corridor
from controller.planning.parameters import PlannerParameters
from controller.planning.search import Search
from controller.planning.smoothing import SmoothingProblem, unfold
from controller.regulator import STANDSTILL
from controller.solution import Outcome
from controller.verification import refine

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from controller.model import LongitudinalModel
    from controller.planning.search import Foresight

    Array = NDArray[np.float64]


class Plan(NamedTuple):
    """The force for the next step, and how it came about."""

    force: float  # u(k) [N]
    found: bool  # False: the corridor is hard, and cannot be kept
    status: str  # of the QP
    iterations: int  # of the solver
    manoeuvre: str  # which one: "clear", "drive on", "as planned", or the acceleration aimed at
    tried: int  # manoeuvres


class Planner:
    """Plans speeds over some seconds, and knows what it planned before.

    Args:
        model: the vehicle.
        parameters: horizon, limits, weights, switches.

    Raises:
        ParameterError: the time step leaves no horizon.
        SolverMissingError, SolverSetupError: the solver cannot be used.
    """

    def __init__(
        self, model: LongitudinalModel, parameters: PlannerParameters | None = None
    ) -> None:
        self.model = model
        self.parameters = parameters = parameters or PlannerParameters()
        N = parameters.horizon
        self._search = Search(model, parameters)
        self._problem = SmoothingProblem(model, parameters)
        count, n = self._problem.rows.shape
        self._z = np.empty(n)
        self._multipliers = np.zeros(count)
        self._plan = Manoeuvre.empty(N)
        self._corridor, self._free = np.empty(N), np.full(N, inf)
        self.reset()

    def reset(self) -> None:
        """Forget what was planned."""
        limit = self.parameters.iteration_limit
        self._backend: OsqpBackend | DaqpBackend
        if self.parameters.solver == "osqp":
            self._backend = OsqpBackend(self._problem, limit)
        else:
            self._backend = DaqpBackend(self._problem, limit)
        self._multipliers[:] = 0.0
        self._search.reset()

    @property
    def horizon(self) -> int:
        """N [steps]."""
        return self.parameters.horizon

    def plan(
        self,
        speed: float,
        previous_force: float,
        fastest: float,
        allowed: Array | None,
        foresight: Foresight | None,
    ) -> Plan:
        """The force at t_k.

        Args:
            speed: x_2(k) [m/s].
            previous_force: u(k-1) [N]; 0 at standstill, where the brake holds without work.
            fastest: [m/s] wanted where nobody is in the way.
            allowed: (N,) [m] that may be driven until steps 1 ... N: vehicles, lights; None: all.
            foresight: of the crowd; None: nobody can get in the way.

        Raises:
            ParameterError: a value is not a number.
        """
        if not isfinite(speed + previous_force + fastest):
            msg = (
                f"speed = {speed} m/s, previous_force = {previous_force} N, fastest = {fastest} "
                "m/s: expected numbers"
            )
            raise ParameterError(msg)
        allowed = self._free if allowed is None else allowed
        before = self._acceleration(speed, previous_force)
        search = self._search
        seek = search.choose if self.parameters.gap_choice else search.follow
        chosen = seek(speed, before, fastest, allowed, foresight)
        return self._smooth(speed, previous_force, before, fastest, allowed, chosen)

    def _acceleration(self, speed: float, force: float) -> float:
        """The one that ``force`` [N] gave at this speed; at standstill none."""
        if speed <= STANDSTILL:
            return 0.0
        return (force - self.model.friction * speed) / self.model.mass

    def _smooth(
        self,
        speed: float,
        previous_force: float,
        before: float,
        fastest: float,
        allowed: Array,
        chosen: str,
    ) -> Plan:
        """The QP within the manoeuvre's corridor; the manoeuvre itself where that is better."""
        p, problem, search = self.parameters, self._problem, self._search
        best, calm = search.best, search.calm
        corridor(
            best.distance,
            best.speed,
            search.gap,
            allowed,
            p.gap_choice,
            search.weights,
            self._corridor,
        )
        wanted = best.speed[problem.nodes]
        if not p.gap_choice:
            wanted = np.full(len(problem.nodes), fastest)
        soon = round(p.manoeuvres.calm_time / self.model.time_step)
        calm[soon:] = inf
        problem.aim_at(wanted, speed, before)
        if not problem.bound(speed, previous_force, fastest, self._corridor, calm, soft=p.soft):
            search.forget()
            return Plan(0.0, False, "infeasible: cannot keep the distance", 0, chosen, search.tried)
        status, iterations = self._solve()
        if status:
            plan = self._plan
            to = (plan.distance, plan.speed, plan.acceleration)
            unfold(speed, problem.speeds(self._z), problem.nodes, self.model.time_step, *to)
            if p.gap_choice and search.comes_closer(plan, allowed):
                plan.copy_from(best)
                status = "manoeuvre"
        else:
            status = "manoeuvre: no QP solution"
            self._plan.copy_from(best)
        search.keep(self._plan)
        force = self._force(speed, previous_force)
        return Plan(force, True, status, iterations, chosen, search.tried)

    def _force(self, speed: float, previous_force: float) -> float:
        """What drives the plan's next speed, within the actuator's limits [N]."""
        p = self.parameters
        force = (self._plan.speed[1] - self.model.decay * speed) / self.model.speed_per_force
        if speed > STANDSTILL:
            low, high = previous_force - p.force_rate_limit, previous_force + p.force_rate_limit
            force = min(max(force, low), high)
        return float(min(max(force, -p.force_limit), p.force_limit))

    def _solve(self) -> tuple[str, int]:
        """Solve the QP exactly; an empty status if there is no verified optimum."""
        problem = self._problem
        bounds = (problem.rows, problem.lower, problem.upper, problem.target)
        started = refine(*bounds, self._multipliers, self._z) >= 0
        if not started and solve_exactly(*bounds, self._multipliers, self._z) < 0:
            self._multipliers[:] = 0.0
            self._z[:] = problem.target
        outcome, iterations = self._backend.solve(self._z, self._multipliers)
        if outcome is Outcome.SOLVED and refine(*bounds, self._multipliers, self._z) >= 0:
            return str(Outcome.SOLVED), iterations
        if solve_exactly(*bounds, self._multipliers, self._z) >= 0:
            return str(Outcome.SOLVED), iterations
        self._multipliers[:] = 0.0
        return "", iterations
