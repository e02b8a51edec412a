"""The paper's QP in the unknowns v(k+1) ... v(k+N): small, sparse and well conditioned.

Forces follow from speeds, u(i) = M/dt (v(i+1) - a v(i)) with a = 1 - alpha dt / M. The cost is then
a sum of squares of speeds, P = 2 I, for any mass and time step. With the paper's unknowns, forces
in newtons, its H is scaled by (dt/M)^2, for which a first-order solver does not converge.

The rows for the speeds V = [v(k+1), ..., v(k+N)] are:

* N rows of the speeds themselves: c4, c5. The first one also contains c1 to c3 of u(k) and c6 of
  x_1(k+2), which all bound v(k+1) alone;
* N - 1 rows of v(i+1) - a v(i) = dt/M u(i): c1;
* N - 1 rows of the differences of these: c2, c3;
* N - 2 rows of sums of speeds, which are the distances driven to x_1(k+3) ... x_1(k+N), divided by
  dt: c6.

With forward Euler x_1(k+1) does not depend on the unknowns. Its constraint is tested before the
solve.
"""

import numpy as np

from controller._jit import Array, inner, kernel
from controller.model import LongitudinalModel
from controller.parameters import MpcParameters

# Widening [m/s] or [m] of all bounds. A plan that touches its bounds, as when the car stops just in
# time, leaves one feasible point to the next problem, which rounding would make infeasible.
SLACK = 1e-9

NOT_A_NUMBER = -1  # result if an input is not finite; only obstacles may be infinitely far
UNDECIDED = 0  # result if only a solve can decide
TOO_CLOSE = 1  # result if x_1(k+1), which no force changes, violates c6
SPEED_BOUNDS_CROSS = 2  # result if the force limits leave no v(k+1) within its bounds
CANNOT_STOP = 3  # result if the hardest braking at every step violates c6
CANNOT_HOLD_SPEED = 4  # result if the largest force at every step violates c5


class SpeedProblem:
    """min |V - V_r|^2 subject to lower <= rows V <= upper, with bounds that change every step.

    Attributes:
        rows: Matrix (4N - 4, N) of the constraints, constant.
        target: Target V_r (N,) [m/s], which the caller may change between two solves.
        lower, upper: Bounds (4N - 4,), filled by :meth:`update`.
        limits: Constants (9,): dt, decay, dt/M, d_safe, v_min, v_max, u_max, du_max, and the
            violation [m/s] of speed bounds with which a plan is accepted.
        increments: True: OSQP's unknowns are v(k+1), v(k+2) - v(k+1), ...
    """

    increments = True

    def __init__(self, model: LongitudinalModel, parameters: MpcParameters) -> None:
        N = parameters.horizon
        self.model = model
        self.parameters = parameters
        speeds = np.eye(N)
        accelerations = np.eye(N)[1:] - model.decay * np.eye(N)[:-1]  # dt/M u(k+1) ...
        rates = accelerations.copy()
        rates[0, 0] -= 1.0  # dt/M u(k) = v(k+1) - a v(k): the constant part goes into the bounds
        rates[1:] -= accelerations[:-1]
        distances = np.tril(np.ones((N, N)))[1:-1]
        self.rows = np.ascontiguousarray(np.concatenate([speeds, accelerations, rates, distances]))
        self.target = np.full(N, parameters.reference_speed)
        self.lower = np.empty(len(self.rows))
        self.upper = np.empty(len(self.rows))
        self.limits = np.array(
            [
                model.time_step,
                model.decay,
                model.speed_per_force,
                parameters.safe_distance,
                parameters.speed_min,
                parameters.speed_max,
                parameters.force_limit,
                parameters.force_rate_limit,
                parameters.speed_tolerance,
            ]
        )

    def update(
        self, position: float, speed: float, previous_force: float, obstacle_positions: Array
    ) -> int:
        """Set the bounds for a state, and prove infeasibility if that needs no solver.

        Returns:
            ``UNDECIDED``, ``NOT_A_NUMBER``, or the reason why no plan can keep all constraints.
        """
        code: int = fill_bounds(
            position,
            speed,
            previous_force,
            obstacle_positions,
            self.limits,
            self.lower,
            self.upper,
        )
        return code


@kernel
def fill_bounds(
    position: float,
    speed: float,
    previous_force: float,
    obstacle_positions: Array,
    limits: Array,
    lower: Array,
    upper: Array,
) -> int:
    """Fill the bounds of all rows, and return a proof of infeasibility or UNDECIDED."""
    dt, decay, per_force, safe_distance = limits[0], limits[1], limits[2], limits[3]
    v_min, v_max, u_max, du_max = limits[4], limits[5], limits[6], limits[7]
    N = len(obstacle_positions)
    if not np.isfinite(position + speed + previous_force):
        return NOT_A_NUMBER
    for i in range(N):
        if np.isnan(obstacle_positions[i]):
            return NOT_A_NUMBER
    after_one = position + dt * speed  # x_1(k+1)
    if after_one > obstacle_positions[0] - safe_distance + SLACK:
        return TOO_CLOSE

    lower[:N] = v_min
    upper[:N] = v_max
    weakest = max(-u_max, previous_force - du_max)
    strongest = min(u_max, previous_force + du_max)
    lower[0] = max(v_min, decay * speed + per_force * weakest)
    upper[0] = min(v_max, decay * speed + per_force * strongest)
    upper[0] = min(upper[0], (obstacle_positions[1] - safe_distance - after_one) / dt)
    for i in range(N, 2 * N - 1):
        lower[i] = -per_force * u_max
        upper[i] = per_force * u_max
    for i in range(2 * N - 1, 3 * N - 2):
        lower[i] = -per_force * du_max
        upper[i] = per_force * du_max
    lower[2 * N - 1] -= decay * speed  # u(k) = (v(k+1) - a v(k)) M/dt has a constant part
    upper[2 * N - 1] -= decay * speed
    for i in range(2, N):
        lower[3 * N - 4 + i] = -np.inf
        upper[3 * N - 4 + i] = (obstacle_positions[i] - safe_distance - after_one) / dt
    lower -= SLACK
    upper += SLACK
    if lower[0] > upper[0] + limits[8]:
        return SPEED_BOUNDS_CROSS
    upper[0] = max(lower[0], upper[0])
    return prove_infeasible(speed, previous_force, limits, upper)


@inner
def prove_infeasible(speed: float, previous_force: float, limits: Array, upper: Array) -> int:
    """Compare the lowest and highest speeds that the force limits allow with c6 and c5.

    Speeds grow with forces, and positions with speeds (decay >= 0). The hardest allowed braking at
    every step, but not below v_min, is therefore a lower bound of every feasible plan. The converse
    does not hold: a plan at this bound may have to release the brake faster than allowed. All
    bounds are widened as those of the solver are. Otherwise the proof would refuse plans that stop
    just in time. v_min leaves room for the violation with which the last plan was accepted.
    Otherwise the proof would refuse the state to which that plan has led.
    """
    decay, per_force = limits[1], limits[2]
    v_min, accepted = limits[4] - SLACK, limits[8]
    change_max = per_force * limits[6] + SLACK  # change of speed [m/s] by u_max in one step
    rate_max = per_force * limits[7] + SLACK
    N = (len(upper) + 4) // 4
    slowest, fastest = speed, speed
    weakest, strongest = per_force * previous_force, per_force * previous_force  # [m/s] per step
    driven = 0.0
    for i in range(N):
        weakest = max(-change_max, weakest - rate_max)
        strongest = min(change_max, strongest + rate_max)
        slowest = max(v_min, decay * slowest + weakest)
        fastest = decay * fastest + strongest
        if fastest < v_min - accepted:
            return CANNOT_HOLD_SPEED
        driven += slowest
        if 1 <= i < N - 1 and driven > upper[3 * N - 3 + i]:
            return CANNOT_STOP
    return UNDECIDED
