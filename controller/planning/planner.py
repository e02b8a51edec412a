"""The planning MPC: choose a manoeuvre, smooth it by a QP, and keep what was planned."""

from __future__ import annotations

from math import inf, isfinite
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from controller.active_set import solve_exactly
from controller.daqp_backend import DaqpBackend
from controller.errors import ParameterError
from controller.osqp_backend import OsqpBackend
from controller.planning.manoeuvre import (
    Manoeuvre,
    Weights,
    aim,
    corridor,
    cost,
    shift,
    stopping_need,
)
from controller.planning.parameters import PlannerParameters
from controller.planning.smoothing import SmoothingProblem, unfold
from controller.regulator import STANDSTILL
from controller.solution import Outcome
from controller.verification import refine

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from controller.model import LongitudinalModel
    from controller.planning.manoeuvre import Prospect

    Array = NDArray[np.float64]

_WORSE = 1e-6  # [m] by which a smoothed plan may come closer than the manoeuvre it follows


class Foresight(Protocol):
    """Who knows what the crowd would do."""

    def prospect(self, manoeuvre: Manoeuvre) -> Prospect:
        """What a manoeuvre would lead to; valid until the next call."""

    def prefer(self) -> None:
        """The latest manoeuvre is the best so far: remember what it would lead to."""


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
        self._weights = Weights.of(parameters, parameters.manoeuvres)
        m, v_r = parameters.manoeuvres, parameters.reference_speed
        self._kinds = [
            (a, share * v_r) for a, share in zip(m.accelerations, m.slowest, strict=True)
        ]
        self._problem = SmoothingProblem(model, parameters)
        count, n = self._problem.rows.shape
        self._z = np.empty(n)
        self._multipliers = np.zeros(count)
        self._last, self._trial, self._best = (Manoeuvre.empty(N) for _ in range(3))
        self._plan = Manoeuvre.empty(N)
        self._gap, self._conflicts, self._calm = np.full(N, inf), np.zeros(N), np.full(N, inf)
        self._corridor = np.empty(N)
        self._free, self._nobody = np.full(N, inf), np.zeros(N)
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
        self._planned = False
        self._holds = True
        self._turn = 0
        self._drives_on = True
        self._tried = 0

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
        if self.parameters.gap_choice:
            chosen = self._choose(speed, before, fastest, allowed, foresight)
        else:
            chosen = self._follow(speed, before, fastest, allowed, foresight)
        return self._smooth(speed, previous_force, before, fastest, allowed, chosen)

    def _acceleration(self, speed: float, force: float) -> float:
        """The one that ``force`` [N] gave at this speed; at standstill none."""
        if speed <= STANDSTILL:
            return 0.0
        return (force - self.model.friction * speed) / self.model.mass

    # --- the manoeuvre ------------------------------------------------------------------------

    def _choose(
        self,
        speed: float,
        before: float,
        fastest: float,
        allowed: Array,
        foresight: Foresight | None,
    ) -> str:
        """Search: driving on, what was planned, and the others in turn or all at once.

        All are tried where the best so far comes too close to somebody. Else, what is best
        changes slowly: besides the plan, driving on and one of the others are tried by turns, so
        that the search stays as quick as the loop.
        """
        persistence = self.parameters.manoeuvres.persistence
        kinds = self._kinds
        others = [(a, least) for a, least in kinds[1:] if a >= 0.0 or speed > least]
        self._lowest, self._missing, self._tried = inf, inf, 0
        name = ""
        self._turn += 1
        drive_on = not self._planned or self._drives_on or self._turn % 2 == 1
        if drive_on:
            self._aim(speed, before, *kinds[0], fastest)
            name = "drive on"
            if self._try(allowed, foresight, persistence) <= 0.0:
                self._drives_on = True
                return "clear"
        if self._planned:
            self._shift(speed)
            self._try(allowed, foresight, 0.0)
            if self._is_best:
                name = "as planned"
        if self._planned and self._missing <= 0.0:
            others = [] if self._turn % 2 else [others[self._turn // 2 % len(others)]]
        elif not drive_on:
            others = [kinds[0], *others]
        for wanted, least in others:
            self._aim(speed, before, wanted, least, fastest)
            self._try(allowed, foresight, persistence)
            if self._is_best:
                name = "drive on" if wanted > 0.0 else f"{wanted:+g} m/s^2 to {least:g} m/s"
        self._drives_on = name == "drive on"
        return name

    def _follow(
        self,
        speed: float,
        before: float,
        fastest: float,
        allowed: Array,
        foresight: Foresight | None,
    ) -> str:
        """Without a search: the crowd answers to the last plan, the plan keeps d_safe."""
        self._lowest, self._missing, self._tried = inf, inf, 0
        if self._planned:
            self._shift(speed)
        else:
            self._aim(speed, before, 0.0, 0.0, fastest)
        disturbed = self._try(allowed, foresight, 0.0)
        return "clear" if disturbed <= 0.0 else "as planned"

    def _aim(
        self, speed: float, before: float, wanted: float, slowest: float, fastest: float
    ) -> None:
        trial, jerk = self._trial, self.parameters.manoeuvres.jerk
        dt = self.model.time_step
        to = (trial.distance, trial.speed, trial.acceleration)
        aim(speed, before, wanted, slowest, fastest, jerk, dt, *to)

    def _shift(self, speed: float) -> None:
        trial, b = self._trial, self.parameters.manoeuvres.deceleration
        trial.copy_from(self._last)
        to = (trial.distance, trial.speed, trial.acceleration)
        shift(speed, self._holds, b, self.model.time_step, *to)

    def _try(self, allowed: Array, foresight: Foresight | None, handicap: float) -> float:
        """Judge the trial, and keep it if it is the best; what others cost it [s]."""
        trial = self._trial
        gap, conflicts, calm = self._free, self._nobody, self._free
        if foresight is not None:
            gap, conflicts, calm = foresight.prospect(trial)
            self._tried += 1
        whole, disturbed, missing = cost(
            trial.distance,
            trial.speed,
            trial.acceleration,
            gap,
            conflicts,
            calm,
            allowed,
            self.model.time_step,
            self._weights,
        )
        self._is_best = whole + handicap < self._lowest
        if self._is_best:
            self._lowest, self._missing = whole + handicap, missing
            self._best.copy_from(trial)
            self._gap[:], self._conflicts[:], self._calm[:] = gap, conflicts, calm
            if foresight is not None:
                foresight.prefer()
        return disturbed

    # --- the plan -----------------------------------------------------------------------------

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
        p, problem, best = self.parameters, self._problem, self._best
        corridor(
            best.distance,
            best.speed,
            self._gap,
            allowed,
            p.gap_choice,
            self._weights,
            self._corridor,
        )
        wanted = best.speed[problem.nodes]
        if not p.gap_choice:
            wanted = np.full(len(problem.nodes), fastest)
        soon = round(p.manoeuvres.calm_time / self.model.time_step)
        self._calm[soon:] = inf
        problem.aim_at(wanted, speed, before)
        if not problem.bound(
            speed, previous_force, fastest, self._corridor, self._calm, soft=p.soft
        ):
            self._planned = False
            return Plan(0.0, False, "infeasible: cannot keep the distance", 0, chosen, self._tried)
        status, iterations = self._solve()
        if status:
            plan = self._plan
            to = (plan.distance, plan.speed, plan.acceleration)
            unfold(speed, problem.speeds(self._z), problem.nodes, self.model.time_step, *to)
            if p.gap_choice and self._comes_closer(plan, allowed):
                plan.copy_from(best)
                status = "manoeuvre"
        else:
            status = "manoeuvre: no QP solution"
            self._plan.copy_from(best)
        self._last.copy_from(self._plan)
        self._planned = True
        self._holds = self._may_hold()
        force = (self._plan.speed[1] - self.model.decay * speed) / self.model.speed_per_force
        low, high = previous_force - p.force_rate_limit, previous_force + p.force_rate_limit
        if speed > STANDSTILL:
            force = min(max(force, low), high)
        force = min(max(force, -p.force_limit), p.force_limit)
        return Plan(float(force), True, status, iterations, chosen, self._tried)

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

    def _comes_closer(self, plan: Manoeuvre, allowed: Array) -> bool:
        """Whether a plan lacks more stopping distance to anybody than the manoeuvre does."""
        _, _, missing = cost(
            plan.distance,
            plan.speed,
            plan.acceleration,
            self._gap + self._best.distance[1:] - plan.distance[1:],
            self._conflicts,
            self._calm,
            allowed,
            self.model.time_step,
            self._weights,
        )
        return missing > self._missing + _WORSE

    def _may_hold(self) -> bool:
        """Whether a stop stays possible if the plan's last speed is kept on."""
        plan, dt = self._plan, self.model.time_step
        v = plan.speed[-1]
        gap = self._gap[-1] + self._best.distance[-1] - plan.distance[-1]
        return bool(gap - dt * v >= stopping_need(v, self._weights))
