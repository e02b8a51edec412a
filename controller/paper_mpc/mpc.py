"""The model predictive controller of Yang & Özgüner 2019, section 3."""

from math import inf, isnan, nan

import numpy as np

from controller._jit import Array, kernel
from controller.errors import ParameterError
from controller.model import LongitudinalModel
from controller.paper_mpc.solution import MpcSolution
from controller.paper_mpc.speed_problem import (
    CANNOT_HOLD_SPEED,
    CANNOT_STOP,
    NOT_A_NUMBER,
    SLACK,
    SPEED_BOUNDS_CROSS,
    TOO_CLOSE,
    UNDECIDED,
    SpeedProblem,
)
from controller.parameters import MpcParameters, require
from controller.qp.exact_solver import ExactSolver
from controller.qp.least_squares import Outcome

_PROOFS = {
    TOO_CLOSE: "infeasible: too close",
    SPEED_BOUNDS_CROSS: "infeasible: speed bounds",
    CANNOT_STOP: "infeasible: cannot stop",
    CANNOT_HOLD_SPEED: "infeasible: cannot hold speed",
}
_SOLVED = Outcome.SOLVED
_STABLE = "at most 1, or forward Euler is unstable; lower friction [N.s/m] or time_step [s]"


class Mpc:
    """Finds the forces that keep the reference speed best, behind all obstacles in front.

    A solve has three steps: proofs of infeasibility that need no solver, the exact solver, and a
    check of the plan against every constraint in physical units. A new instance, or one after
    :meth:`reset`, gives the same bytes for the same sequence of problems.

    Args:
        model: Longitudinal model of the vehicle.
        parameters: Weights and limits, or None for the defaults.

    Raises:
        ParameterError: the limits contradict each other.
        SolverSetupError: the solver cannot be used.
    """

    def __init__(self, model: LongitudinalModel, parameters: MpcParameters | None = None) -> None:
        self.model = model
        self.parameters = parameters = parameters or MpcParameters()
        require(model.decay >= 0.0, "friction * time_step / mass", 1 - model.decay, _STABLE)
        self._problem = SpeedProblem(model, parameters)
        self._solver = ExactSolver(
            self._problem,
            parameters.iteration_limit,
            box=(parameters.speed_min - 1.0, parameters.speed_max + 1.0),
        )
        self._tolerances = np.array(
            [
                parameters.position_tolerance,
                parameters.speed_tolerance,
                max(parameters.force_tolerance, 2.0 * SLACK / model.speed_per_force),
            ]
        )

    def reset(self) -> None:
        """Forget earlier problems."""
        self._solver.reset()

    def solve(
        self,
        position: float,
        speed: float,
        previous_force: float,
        obstacle_positions: Array,
        reference_speed: float | None = None,
    ) -> MpcSolution:
        """Plan from the state at t_k.

        Args:
            position: Station x_1(k) [m] of the point that must keep the safe distance.
            speed: Speed x_2(k) [m/s].
            previous_force: Force u(k-1) [N].
            obstacle_positions: Stations x_p(k+1) ... x_p(k+N), (N,) [m], of the closest obstacle;
                inf without one.
            reference_speed: Reference speed v_r [m/s] over this horizon, or None for that of the
                parameters.

        Raises:
            ParameterError: a value is not a number, or the horizon does not fit.
        """
        if len(obstacle_positions) != self.parameters.horizon:
            raise ParameterError(
                f"obstacle_positions has {len(obstacle_positions)} entries: expected "
                f"{self.parameters.horizon}, one per step of the horizon"
            )
        problem = self._problem
        target = self.parameters.reference_speed if reference_speed is None else reference_speed
        if isnan(target):
            raise ParameterError("reference_speed = nan: expected a number [m/s]")
        problem.target[:] = target
        code = problem.update(position, speed, previous_force, obstacle_positions)
        if code == NOT_A_NUMBER:
            raise ParameterError(
                f"position = {position} m, speed = {speed} m/s, previous_force = {previous_force} "
                "N and obstacle_positions: expected numbers"
            )
        if code != UNDECIDED:
            return _no_plan(_PROOFS[code], 0)
        outcome, iterations = self._solver.solve()
        if outcome is not _SOLVED:
            return _no_plan(str(outcome), iterations)
        return self._checked(position, speed, previous_force, obstacle_positions, iterations)

    def _checked(
        self,
        position: float,
        speed: float,
        previous_force: float,
        obstacle_positions: Array,
        iterations: int,
    ) -> MpcSolution:
        """Return the plan if it keeps every constraint, or a solution without a plan."""
        speeds = self._solver.solution.copy()
        forces = np.empty(len(speeds))
        residual = check_plan(
            (position, speed, previous_force),
            obstacle_positions,
            speeds,
            forces,
            self._problem.limits,
            self._tolerances,
        )
        if not residual <= 1.0:
            return _no_plan(str(Outcome.UNVERIFIED), iterations)
        return MpcSolution(
            True, float(forces[0]), forces, speeds, str(_SOLVED), iterations, residual
        )


def _no_plan(status: str, iterations: int) -> MpcSolution:
    return MpcSolution(False, nan, None, None, status, iterations, nan)


@kernel
def check_plan(
    state: tuple[float, float, float],
    obstacle_positions: Array,
    speeds: Array,
    forces: Array,
    limits: Array,
    tolerances: Array,
) -> float:
    """Fill the forces that lead through ``speeds``, and drive them through the model.

    Returns:
        Largest violation of c1 to c6, divided by its tolerance; inf if the plan is not finite.
    """
    position, speed, previous_force = state
    dt, decay, per_force, safe_distance = limits[0], limits[1], limits[2], limits[3]
    v_min, v_max, u_max, du_max = limits[4], limits[5], limits[6], limits[7]
    of_position, of_speed, of_force = tolerances[0], tolerances[1], tolerances[2]
    worst = 0.0
    before = speed
    for i in range(len(speeds)):
        u = (speeds[i] - decay * before) / per_force
        before = speeds[i]
        forces[i] = u
        if not np.isfinite(u):
            return inf
        worst = max(worst, (abs(u) - u_max) / of_force)
        worst = max(worst, (abs(u - previous_force) - du_max) / of_force)
        position += dt * speed
        speed = decay * speed + per_force * u
        worst = max(worst, (position - (obstacle_positions[i] - safe_distance)) / of_position)
        worst = max(worst, (speed - v_max) / of_speed, (v_min - speed) / of_speed)
        previous_force = u
    return worst
