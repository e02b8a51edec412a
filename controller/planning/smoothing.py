"""The QP of the planning MPC: a smooth plan within the corridor of the chosen manoeuvre.

The unknowns are the speeds v_1 ... v_n at nodes whose intervals grow (move blocking): the
acceleration is constant between nodes. The cost, with intervals h_i, is

    sum h_i (v_i - v_i^m)^2 + q_a sum h_i a_i^2 + q_j sum h'_i j_i^2

of speed errors to the manoeuvre, accelerations a_i and jerks j_i. Yang & Özgüner 2019, section 5,
name the control-effort and comfort terms as future work. With H = L L' and z = L' v the cost is
|z - z_m|^2, the form that every solver of this package takes.

The rows are n speeds (limits; the first one also the force and its rate), n - 1 accelerations
(force) and n - 1 distances (corridor).

The corridor is a soft constraint by an exact penalty. Its least violation is known in closed form:
the hardest braking is the slowest plan at every node, so its violation is unavoidable, and no
larger one is needed. A linear penalty above the largest multiplier allows exactly the plans with
this least violation (Nocedal & Wright 2006, section 17.2). The bounds are therefore widened by the
unavoidable amount. This needs no slack variables, and a solution always exists.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from controller._jit import Array, inner, kernel
from controller.model import LongitudinalModel
from controller.planning.motions import Motion
from controller.planning.parameters import PlannerParameters

Indices = NDArray[np.int64]

WIDER = 1e-7  # widening [m/s] or [m] of the bounds, so that rounding makes none infeasible


_GROWTH = 0.25  # length of an interval of the plan as a share of its beginning; docs/planner.md


def nodes_of(horizon: int, growth: float = _GROWTH) -> Indices:
    """The steps of the nodes, from 1 to N, with intervals that grow by ``growth``."""
    nodes, at = [], 0
    while at < horizon:
        at = min(horizon, at + max(1, round(growth * at)))
        nodes.append(at)
    return np.array(nodes, dtype=np.int64)


def inverse_factor(H: Array) -> Array:
    """Return L^-1 of the Cholesky factor L of ``H`` (n, n), so that H = L L'.

    Every sum has a fixed order. BLAS and LAPACK choose theirs by the processor, and the last digits
    of a whole drive with it.
    """
    left, inverse = H.copy(), np.eye(len(H))
    for k in range(len(H)):
        column = left[k:, k] / np.sqrt(left[k, k])
        left[k:, k:] -= np.multiply.outer(column, column)
        inverse[k] /= column[0]
        inverse[k + 1 :] -= np.multiply.outer(column[1:], inverse[k])
    return inverse


class Limits(NamedTuple):
    """The limits of the vehicle and its actuator."""

    time_step: float  # control step dt [s]
    decay: float  # share of a speed that is left after a step without force
    gain: float  # change of speed per force in a step, dt / M [s/kg]
    force: float  # largest braking force [N]
    force_rate: float  # largest fall of the force [N per step]
    speed: float  # highest speed [m/s]
    drive: float  # largest driving force [N]
    rise: float  # largest rise of the force [N per step]


class SmoothingProblem:
    """min |z - target|^2 subject to lower <= rows z <= upper.

    Attributes:
        nodes: Steps (n,) of the nodes.
        rows: Matrix (3 n - 2, n) of the constraints, constant.
        target: Target z_m (n,).
        speeds_of: Matrix (n, n) of v = L'^-1 z.
        gradients: Parts of the gradient, as :func:`set_target` takes them.
        intervals: Intervals h_i (n,) [s] between the nodes.
        limits: Fields of :class:`Limits`.
        lower, upper: Bounds (3 n - 2,) of the constraints.
        increments: False: solvers work on z itself.
    """

    increments = False

    def __init__(self, model: LongitudinalModel, parameters: PlannerParameters) -> None:
        p = parameters
        self.nodes = nodes = nodes_of(p.horizon)
        n, dt = len(nodes), model.time_step
        self.limits = tuple(
            Limits(
                dt,
                model.decay,
                model.speed_per_force,
                p.force_limit,
                p.force_rate_limit,
                p.speed_max,
                p.force_limit,
                p.force_rate_limit,
            )
        )
        h = np.diff(nodes, prepend=0) * dt
        self.intervals = h
        accelerations = (np.eye(n) - np.eye(n, k=-1)) / h[:, None]  # without the term of v_0
        between = np.concatenate([[dt], (h[1:] + h[:-1]) / 2.0])
        jerks = np.diff(accelerations, axis=0, prepend=0.0) / between[:, None]
        H = np.diag(h)
        H += np.einsum("ki,k,kj", accelerations, p.effort_weight * h, accelerations)
        H += np.einsum("ki,k,kj", jerks, p.jerk_weight * between, jerks)
        to_z = inverse_factor(H)
        self.speeds_of = np.ascontiguousarray(to_z.T)  # v = L'^-1 z
        distances = np.zeros((n, n))  # distances driven from node 1 on, by the trapezoidal rule
        for i in range(1, n):
            distances[i, :i] += h[1 : i + 1] / 2.0
            distances[i, 1 : i + 1] += h[1 : i + 1] / 2.0
        rows = np.concatenate([np.eye(n), accelerations[1:], distances[1:]])
        self.rows = np.einsum("ik,kj", rows, self.speeds_of)
        self.target = np.zeros(n)
        self.lower = np.empty(len(rows))
        self.upper = np.empty(len(rows))
        # The gradient at v = 0 in three parts: speeds aimed at, v_0 and the acceleration before.
        of_speed = p.effort_weight * accelerations[0]
        of_speed = of_speed + p.jerk_weight * (jerks[0] - jerks[1]) / dt
        self.gradients = (
            to_z * h,
            np.einsum("ij,j", to_z, of_speed),
            np.einsum("ij,j", to_z, p.jerk_weight * jerks[0]),
        )

    def aim_at(self, speeds: Array, speed: float, acceleration: float) -> None:
        """Set the target.

        Args:
            speeds: Speeds (n,) [m/s] of the manoeuvre at the nodes.
            speed: Speed now [m/s].
            acceleration: Acceleration before now [m/s^2].
        """
        set_target(speeds, speed, acceleration, self.gradients, self.target)

    def bound(
        self,
        speed: float,
        previous_force: float,
        fastest: float,
        corridor: Array,
        speed_limits: Array,
    ) -> None:
        """Set the bounds.

        Args:
            speed: Speed now [m/s].
            previous_force: Force u(k-1) [N].
            fastest: Highest speed [m/s], unless the ego is faster already.
            corridor: Distances (N,) [m] that the plan may have driven at steps 1 ... N.
            speed_limits: Speed limits (N,) [m/s], kept as far as braking allows.
        """
        fill(
            (speed, previous_force, fastest),
            corridor,
            speed_limits,
            self.nodes,
            self.intervals,
            self.limits,
            (self.lower, self.upper),
        )


@kernel
def fill(
    state: tuple[float, float, float],
    corridor: Array,
    speed_limits: Array,
    nodes: Indices,
    intervals: Array,
    limits: tuple[float, ...],
    bounds: tuple[Array, Array],
) -> None:
    """Fill the bounds of all rows as :meth:`SmoothingProblem.bound` does.

    The corridor is widened where braking cannot keep it.

    Args:
        state: Speed now [m/s], force u(k-1) [N], and highest speed [m/s].
        corridor: Distances (N,) [m] that the plan may have driven at steps 1 ... N.
        speed_limits: Speed limits (N,) [m/s].
        nodes: Steps (n,) of the nodes.
        intervals: Intervals (n,) [s] between the nodes.
        limits: Fields of :class:`Limits`.
        bounds: Lower and upper bounds (3 n - 2,), filled.
    """
    (speed, previous_force, fastest), (lower, upper) = state, bounds
    c, n = Limits(*limits), len(nodes)
    dt = c.time_step
    weakest = max(-c.force, previous_force - c.force_rate)
    strongest = min(c.drive, previous_force + c.rise)
    least = max(0.0, c.decay * speed + c.gain * weakest)
    most = min(c.speed, max(fastest, speed), c.decay * speed + c.gain * strongest)
    most = max(most, least)  # after hard braking even the largest force may give a negative speed
    hardest = c.gain * c.force / dt
    lower[:n] = 0.0
    upper[:n] = min(c.speed, max(fastest, speed))
    most = min(most, max(least, speed_limits[0]))
    lower[0], upper[0] = least, most
    lower[n : 2 * n - 1] = -hardest
    upper[n : 2 * n - 1] = c.gain * c.drive / dt
    v, driven = least, dt * speed  # x_1(k+1) is independent of all forces
    for i in range(1, n):
        slower = max(0.0, v - hardest * intervals[i])
        driven += intervals[i] * (v + slower) / 2.0
        v = slower
        room, slow = corridor[nodes[i] - 1], speed_limits[nodes[i] - 1]
        for k in range(nodes[i - 1], nodes[i] - 1):
            room = min(room, corridor[k])  # distances never fall: a bound at the end holds before
            slow = min(slow, speed_limits[k])
        upper[i] = min(upper[i], max(v, slow))
        room = max(room, driven)
        lower[2 * n - 2 + i] = -np.inf
        upper[2 * n - 2 + i] = room - dt * speed
    for i in range(len(lower)):
        lower[i] -= WIDER
        upper[i] += WIDER


@kernel
def set_target(
    speeds: Array,
    speed: float,
    acceleration: float,
    gradients: tuple[Array, Array, Array],
    target: Array,
) -> None:
    """Set the target as :meth:`SmoothingProblem.aim_at` does, by the gradient's three parts."""
    of_speeds, of_speed, of_acceleration = gradients
    n = len(target)
    for i in range(n):
        value = 0.0
        for j in range(n):
            value += of_speeds[i, j] * speeds[j]
        target[i] = value + of_speed[i] * speed + of_acceleration[i] * acceleration


@inner
def unfold(
    speed: float,
    at_nodes: Array,
    nodes: Indices,
    time_step: float,
    plan: Motion,
) -> None:
    """Fill the plan of every step from the speeds at the nodes."""
    distance, speeds, accelerations = plan
    before, at = speed, 0
    speeds[0] = speed
    for i in range(len(nodes)):
        for k in range(at + 1, nodes[i] + 1):
            share = (k - at) / (nodes[i] - at)
            speeds[k] = max(0.0, before + share * (at_nodes[i] - before))
        before, at = at_nodes[i], nodes[i]
    distance[0] = 0.0
    N = len(speeds) - 1
    for k in range(N):
        distance[k + 1] = distance[k] + time_step * speeds[k]
        accelerations[k] = (speeds[k + 1] - speeds[k]) / time_step
    accelerations[N] = 0.0
