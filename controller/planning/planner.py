"""The planning MPC: it chooses a manoeuvre, smooths it by a QP, and remembers the plan."""

from math import inf, isfinite
from typing import Any, NamedTuple

import numpy as np

from controller._jit import Array
from controller.actuator import Actuator, Ahead, Anticipation
from controller.defaults import STANDSTILL
from controller.driving_constants import CREEPING, PATIENCE
from controller.errors import ParameterError
from controller.foresight import Foresight, Manoeuvre
from controller.model import LongitudinalModel
from controller.observation import Observation
from controller.planning.capability import jerks_of, within
from controller.planning.following import (
    UNSOLVED,
    follow,
    take_over,
    unfold_and_judge,
)
from controller.planning.parameters import PlannerParameters
from controller.planning.search import Search, postponed
from controller.planning.smoothing import Limits, SmoothingProblem
from controller.protocol import Decision
from controller.qp.exact_solver import ExactSolver
from controller.qp.least_squares import Outcome

_SOLVED = Outcome.SOLVED


class Plan(NamedTuple):
    """The force for the next step, and how it was found."""

    force: float  # force u(k) [N]
    status: str  # outcome of the QP
    iterations: int  # iterations of the solver
    manoeuvre: str  # name of the manoeuvre: "clear", "drive on", "as planned", ...
    tried: int  # number of manoeuvres that were compared


class Road(NamedTuple):
    """The distances and speeds that the road allows over the horizon.

    Attributes:
        allowed: Distances (N,) [m] that may be driven until steps 1 ... N, by vehicles and
            lights; inf without a bound.
        lane_speeds: Speed limits (N,) [m/s] at steps 1 ... N, kept as far as braking allows, or
            None.
        gap: Distance [m] to the closest person in front now. At standstill this person bounds the
            way: a trial manoeuvre may drive up to d_safe before them, a creeping one nearer.
        to_clear: Keep-clear distance [m]: distance to drive until the zone is free.
    """

    allowed: Array
    lane_speeds: Array | None = None
    gap: float = inf
    to_clear: float = 0.0


class Planner:
    """Plans speeds over some seconds, and remembers its last plan.

    Args:
        model: Longitudinal model of the vehicle.
        parameters: Horizon, limits and weights, or None for the defaults.
        actuator: Actuator of the vehicle, or None if each force acts at once.

    Attributes:
        anticipation: Forces on their way through the actuator, or None if each acts at once.

    Raises:
        ParameterError: the time step leaves no horizon.
        SolverSetupError: the solver cannot be used.
    """

    def __init__(
        self,
        model: LongitudinalModel,
        parameters: PlannerParameters | None = None,
        actuator: Actuator | None = None,
    ) -> None:
        self.model = model
        self._decay, self._speed_per_force = model.decay, model.speed_per_force
        parameters = parameters or PlannerParameters()
        self.anticipation = None
        if actuator is not None and not actuator.ideal:
            self.anticipation = Anticipation(model, actuator)
            parameters = within(parameters, actuator, model.mass)
        self.parameters = parameters
        N, dead_steps = parameters.horizon, self.anticipation.steps if self.anticipation else 0
        self._search = Search(model, parameters, dead_steps)
        if actuator is not None:
            self._search.jerks = jerks_of(actuator, parameters.manoeuvres.jerk, model.mass)
        self._wanted = self._search.goals[:, 0].copy()
        self._problem = SmoothingProblem(model, parameters)
        self._solver = ExactSolver(self._problem, parameters.iteration_limit, box=None)
        problem = self._problem
        self._arrays = (
            problem.nodes,
            problem.intervals,
            problem.limits,
            problem.rows,
            problem.lower,
            problem.upper,
            problem.target,
            problem.speeds_of,
            problem.gradients,
        )
        self._soon = round(parameters.calm_time / model.time_step)
        self._waited = 0.0  # time [s] for which the ego has waited for people
        self._plan = plan = Manoeuvre.empty(N)
        self._to = (plan.distance, plan.speed, plan.acceleration)
        self._corridor, self._any_speed = np.empty(N), np.full(N, inf)

    def reset(self) -> None:
        """Forget the last plan, and for how long the ego has waited."""
        self._solver.reset()
        self._search.reset()
        if self.anticipation is not None:
            self.anticipation.reset()
        self._waited = 0.0

    def plan(
        self,
        speed: float,
        previous_force: float,
        fastest: float,
        road: Road,
        foresight: Foresight | None,
        ahead: Ahead | None = None,
    ) -> Plan:
        """Plan from the state in which a force begins to act, and return this force.

        Args:
            speed: Speed [m/s] there: x_2(k), without a dead time.
            previous_force: Force [N] that acts there: u(k-1), without a lag; 0 at standstill, where
                the brake holds without work.
            fastest: Speed [m/s] with nobody in the way.
            road: Distances and speeds that the road allows.
            foresight: Foresight of the crowd, or None if nobody can get in the way.
            ahead: Motion until a force begins to act, or None if it acts at once.

        Raises:
            ParameterError: a value is not a number.
        """
        if not isfinite(speed + previous_force + fastest):
            raise ParameterError(
                f"speed = {speed} m/s, previous_force = {previous_force} N, fastest = {fastest} "
                "m/s: expected numbers"
            )
        before = self._acceleration(speed, previous_force)
        search, allowed = self._search, road.allowed
        end = float(allowed[-1])
        if search.creeps:
            fastest = min(fastest, CREEPING)
            end = min(end, road.gap - search.least)
        elif speed <= STANDSTILL:
            end = min(end, road.gap - self.parameters.safe_distance)
        if ahead is not None:
            self._bound(speed, previous_force, ahead)
            end -= ahead.travel
        name = search.choose(speed, before, fastest, allowed, foresight, end, road.to_clear, ahead)
        there = road
        if ahead is not None and ahead.steps:
            search.from_there(ahead)
            there = from_there(road, ahead)
        plan = self._smooth((speed, before, previous_force, fastest), there, name)
        self._wait(speed, road, name)
        return plan

    def _wait(self, speed: float, road: Road, name: str) -> None:
        """Creep from the next step on if people have let nobody through for ``PATIENCE``.

        A creeping ego comes nearer to people in front, and they make way: between driving through
        them and waiting without end. It ends as soon as nobody is in front any more.
        """
        search = self._search
        waits = name != "clear" and float(road.allowed[-1]) > CREEPING
        if search.creeps:
            search.creep(waits or road.gap < self.parameters.safe_distance)
        elif speed > CREEPING:
            self._waited = 0.0
        elif waits:
            self._waited += self.model.time_step
            search.creep(self._waited >= PATIENCE)

    def _bound(self, speed: float, force: float, ahead: Ahead) -> None:
        """Bound plans and manoeuvres by what the actuator can do in its present state."""
        p, problem, anticipation = self.parameters, self._problem, self.anticipation
        assert anticipation is not None
        drive = min(p.force_limit, anticipation.actuator.drive.largest(speed))
        falls, rises = force - ahead.least, ahead.most - force
        self._reach = (
            max(ahead.least, force - p.force_rate_limit),
            min(ahead.most, force + p.force_rate_limit),
        )
        limits = Limits(*problem.limits)._replace(
            force_rate=min(p.force_rate_limit, falls),
            drive=drive,
            rise=min(p.force_rate_limit, rises),
        )
        problem.limits = tuple(limits)
        self._arrays = (*self._arrays[:2], problem.limits, *self._arrays[3:])
        left = max((drive - self.model.friction * speed) / self.model.mass, 0.0)
        np.minimum(self._wanted, left, out=self._search.goals[:, 0])

    def _rules(self) -> tuple[int, float, tuple[Any, ...]]:
        """The number of calm steps, the calm braking [m/s^2], and the weights of the cost."""
        return self._soon, self.parameters.calm_braking, self._search.weights

    def _acceleration(self, speed: float, force: float) -> float:
        """The acceleration [m/s^2] that ``force`` [N] causes at this speed; 0 at standstill."""
        if speed <= STANDSTILL:
            return 0.0
        return (force - self.model.friction * speed) / self.model.mass

    def _smooth(self, state: tuple[float, float, float, float], road: Road, name: str) -> Plan:
        """Smooth the chosen manoeuvre by the QP, or keep the manoeuvre if that is better.

        Args:
            state: Speed [m/s], acceleration before [m/s^2], force before [N], wanted speed [m/s].
            road: Distances and speeds that the road allows.
            name: Name of the chosen manoeuvre.
        """
        search, plan, to = self._search, self._plan, self._to
        evaluation = (search.gap, search.threat_free, search.passing)
        chosen = search.best, evaluation, search.missing
        lane_speeds = self._any_speed if road.lane_speeds is None else road.lane_speeds
        bounds = road.allowed, lane_speeds, self._corridor
        corrections, itself, holds = follow(
            state, chosen, bounds, self._arrays, self._solver.memory, to, self._rules()
        )
        outcome = _SOLVED
        if corrections == UNSOLVED:
            outcome, corrections = self._solver.solve()
            if outcome is _SOLVED:
                solution = self._solver.solution
                itself, holds = unfold_and_judge(
                    state[0], chosen, road.allowed, self._arrays, solution, to, search.weights
                )
            else:
                holds = take_over(search.best, to, evaluation, self.model.time_step, search.weights)
        status = "manoeuvre" if itself else str(outcome)
        if outcome is not _SOLVED:
            status = "manoeuvre: no QP solution"
        search.keep(plan, holds)
        force = self._force(state[0], state[2])
        return Plan(force, status, corrections, name, search.tried)

    def forces(self, first: float) -> list[float]:
        """Return the forces [N] of the plan's steps, of which the first one is given."""
        if self.anticipation is None:
            return [first]
        v = self._plan.speed[: self.anticipation.lead + 1]
        later = (v[2:] - self._decay * v[1:-1]) / self._speed_per_force
        return [first, *later.tolist()]

    def _force(self, speed: float, previous_force: float) -> float:
        """Return the force [N] for the plan's next speed, within the actuator's limits."""
        p = self.parameters
        force = (float(self._plan.speed[1]) - self._decay * speed) / self._speed_per_force
        if self.anticipation is not None:
            return min(max(force, self._reach[0]), self._reach[1])
        if speed > STANDSTILL:
            low, high = previous_force - p.force_rate_limit, previous_force + p.force_rate_limit
            force = min(max(force, low), high)
        return min(max(force, -p.force_limit), p.force_limit)


def from_there(road: Road, ahead: Ahead) -> Road:
    """Return the road from where a force begins to act; beyond the horizon it stays as it is."""
    lane_speeds = road.lane_speeds
    return road._replace(
        allowed=postponed(road.allowed, ahead.steps) - ahead.travel,
        lane_speeds=None if lane_speeds is None else postponed(lane_speeds, ahead.steps),
        gap=road.gap - ahead.travel,
        to_clear=max(road.to_clear - ahead.travel, 0.0),
    )


class PlanningController:
    """The planner as a controller. Distances are soft constraints, so that a plan always exists.

    Args:
        planner: Planner of the speeds.
    """

    foresees = True

    def __init__(self, planner: Planner) -> None:
        self.planner = planner
        self._previous_force = 0.0

    @property
    def horizon(self) -> int:
        """The prediction horizon [steps]."""
        return self.planner.parameters.horizon

    def reset(self) -> None:
        """Forget the past."""
        self._previous_force = 0.0
        self.planner.reset()

    def control(self, observation: Observation) -> Decision:
        """Decide on the force [N] at t_k."""
        ego, ahead, limits = observation.ego, observation.ahead, observation.limits
        speed, planner = ego.speed, self.planner
        previous = 0.0 if speed <= STANDSTILL else self._previous_force
        anticipation, there = planner.anticipation, None
        if anticipation is not None:
            there = anticipation.look(speed)
            speed, previous = there.speed, there.force
            previous = max(previous, 0.0) if speed <= STANDSTILL else previous
        reference = min(self.planner.parameters.reference_speed, limits.speed_limit)
        allowed = ahead.obstacle_positions - (ego.position + limits.safe_distance)
        road = Road(allowed, limits.lane_speeds, ahead.gap, ahead.to_clear)
        plan = planner.plan(
            speed, previous, reference, road, observation.pedestrians.foresight, there
        )
        force = plan.force
        if speed <= STANDSTILL and force < 0.0:
            force = 0.0  # the brake holds without work
        if anticipation is not None:
            force = anticipation.command(planner.forces(force))
        self._previous_force = force
        return Decision(force, "mpc", plan.manoeuvre, plan.status, plan.iterations, reference, None)

    def applied(self, force: float) -> None:
        """Continue from the force [N] that the safety layer applied instead of the last one."""
        self._previous_force = force
        if self.planner.anticipation is not None:
            self.planner.anticipation.applied(force)
