"""The planning MPC: choose a manoeuvre, smooth it by a QP, and keep what was planned."""

from __future__ import annotations

from math import inf, isfinite
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from controller.defaults import STANDSTILL
from controller.errors import ParameterError
from controller.exact_solver import ExactSolver
from controller.foresight import Manoeuvre
from controller.least_squares import Outcome
from controller.planning.manoeuvre import corridor
from controller.planning.parameters import PlannerParameters
from controller.planning.search import Search
from controller.planning.smoothing import SmoothingProblem, unfold

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from controller.foresight import Foresight
    from controller.model import LongitudinalModel

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
        self._decay, self._speed_per_force = model.decay, model.speed_per_force
        self.parameters = parameters = parameters or PlannerParameters()
        N = parameters.horizon
        self._search = Search(model, parameters)
        self._problem = SmoothingProblem(model, parameters)
        self._solver = ExactSolver(
            self._problem, parameters.solver, parameters.iteration_limit, box=None
        )
        self._plan = Manoeuvre.empty(N)
        self._corridor = np.empty(N)

    def reset(self) -> None:
        """Forget what was planned."""
        self._solver.reset()
        self._search.reset()

    def plan(
        self,
        speed: float,
        previous_force: float,
        fastest: float,
        allowed: Array,
        foresight: Foresight | None,
    ) -> Plan:
        """The force at t_k.

        Args:
            speed: x_2(k) [m/s].
            previous_force: u(k-1) [N]; 0 at standstill, where the brake holds without work.
            fastest: [m/s] wanted where nobody is in the way.
            allowed: (N,) [m] that may be driven until steps 1 ... N: vehicles, lights; inf: any.
            foresight: of the crowd; None: nobody can get in the way.

        Raises:
            ParameterError: a value is not a number.
        """
        if not isfinite(speed + previous_force + fastest):
            raise ParameterError(
                f"speed = {speed} m/s, previous_force = {previous_force} N, fastest = {fastest} "
                "m/s: expected numbers"
            )
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
        outcome, iterations = self._solver.solve()
        status = str(outcome)
        if outcome is Outcome.SOLVED:
            plan = self._plan
            to = (plan.distance, plan.speed, plan.acceleration)
            at_nodes = problem.speeds(self._solver.solution)
            unfold(speed, at_nodes, problem.nodes, self.model.time_step, *to)
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
        force = (self._plan.speed[1] - self._decay * speed) / self._speed_per_force
        if speed > STANDSTILL:
            low, high = previous_force - p.force_rate_limit, previous_force + p.force_rate_limit
            force = min(max(force, low), high)
        return float(min(max(force, -p.force_limit), p.force_limit))
