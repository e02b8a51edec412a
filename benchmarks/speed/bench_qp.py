"""What a solve of the MPC's QP costs, and how exact it is: python benchmarks/speed/bench_qp.py.

The problems come from a closed loop, where each start is the plan of the step before: a car among
pedestrians who cross its way at constant speed, the PID driving where the MPC has no plan. Each
solver then sees the same problems in the same order, wrapper included. The reference is DAQP,
an exact method, on the paper's own condensed problem. A status is wrong if the solver calls a
problem infeasible that has a plan with 1e-6 (m, m/s, m/s of force times dt/M) to spare, or calls
one solved that has none with bounds 1e-6 wider; what lies between is a knife's edge.
"""

from __future__ import annotations

import argparse
from functools import partial
from time import perf_counter
from typing import TYPE_CHECKING, NamedTuple

import daqp
import numpy as np
import osqp
from paper_qp import prediction_matrices, quadratic_program
from scipy import sparse

from controller import (
    LongitudinalModel,
    Mpc,
    MpcParameters,
    Observation,
    Pid,
    SpeedController,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Array = NDArray[np.float64]

WALKING_SPEED = 1.4  # [m/s] across the car's way
CORRIDOR = 1.25  # [m] half-width in which a pedestrian is in front
SPACING = 0.6  # [pedestrians per metre of the car's way]
START = 12.0  # [m] from which side the pedestrians come
EDGE = 1e-6  # on either side of which a status counts


class Problem(NamedTuple):
    """What ``Mpc.solve`` takes."""

    position: float
    speed: float
    previous_force: float
    obstacle_positions: Array


class Answer(NamedTuple):
    """What is compared."""

    found: bool
    force: float  # u(k) [N]


def closed_loop(
    model: LongitudinalModel, parameters: MpcParameters, count: int, seed: int
) -> list[Problem]:
    """The problems that a drive among crossing pedestrians poses."""
    generator = np.random.default_rng(seed)
    N, dt = parameters.horizon, model.time_step
    problems: list[Problem] = []
    while len(problems) < count:
        driver = SpeedController(Mpc(model, parameters), Pid(time_step=dt))
        x = generator.uniform(15.0, 45.0, size=round(30 * SPACING))
        y = -generator.uniform(0.0, START, size=len(x))
        position, speed, previous = 0.0, 4.0, 0.0
        for k in range(300):
            ahead = dt * (k + np.arange(N + 1))[:, np.newaxis]
            inside = np.abs(y + WALKING_SPEED * ahead) < CORRIDOR
            seen = np.where(inside & (x > position), x, np.inf).min(axis=1)
            problems.append(Problem(position, speed, previous if speed > 0 else 0.0, seen[1:]))
            observation = Observation(position, speed, seen[0] - position, seen[1:])
            previous = driver.control(observation).force
            position += dt * speed
            speed = max(0.0, model.decay * speed + model.speed_per_force * previous)
    return problems[:count]


def condensed(
    model: LongitudinalModel, parameters: MpcParameters, problem: Problem
) -> tuple[Array, Array, Array, Array, Array]:
    """P, q, G, l, u of the paper's problem, per step of speed: u dt / M [m/s]."""
    state = np.array([problem.position, problem.speed])
    qp = quadratic_program(
        model, parameters, state, problem.previous_force, problem.obstacle_positions
    )
    N, scale = parameters.horizon, 1.0 / model.speed_per_force
    units = np.ones(4 * N)
    units[: 2 * N] = model.speed_per_force  # rows of forces in m/s, too
    G = units[:, np.newaxis] * qp.G * scale
    return qp.P * scale**2, qp.q * scale, G, units * qp.lower, units * qp.upper


def exact(
    model: LongitudinalModel, parameters: MpcParameters, problem: Problem, slack: float = 0.0
) -> Answer:
    """DAQP on the condensed problem, its bounds ``slack`` wider."""
    P, q, G, lower, upper = condensed(model, parameters, problem)
    lower, upper = lower - slack, upper + slack
    constant = ~G.any(axis=1)  # x_1(k+1): no force changes it
    if (upper[constant] < 0.0).any():
        return Answer(False, np.nan)
    keep = ~constant
    x, _, flag, _ = daqp.solve(
        P,
        q,
        np.ascontiguousarray(G[keep]),
        np.minimum(upper[keep], 1e30),
        np.maximum(lower[keep], -1e30),
        np.zeros(keep.sum(), dtype=np.int32),
        primal_tol=1e-9,
        dual_tol=1e-12,
    )
    return Answer(flag == 1, x[0] / model.speed_per_force if flag == 1 else np.nan)


class FromThePlanBefore(Mpc):
    """Without the exact start: the solver continues from where the step before ended."""

    def __init__(self, model: LongitudinalModel, parameters: MpcParameters) -> None:
        super().__init__(model, parameters)
        self._solver._start = lambda: True


def by_mpc(
    model: LongitudinalModel, parameters: MpcParameters, kind: type[Mpc] = Mpc
) -> Callable[[Problem], Answer]:
    """Ours, as the speed controller calls it."""
    mpc = kind(model, parameters)

    def solve(problem: Problem) -> Answer:
        solution = mpc.solve(*problem)
        return Answer(solution.found, solution.force)

    return solve


def by_plain_osqp(
    model: LongitudinalModel, parameters: MpcParameters
) -> Callable[[Problem], Answer]:
    """OSQP with its defaults on the paper's condensed problem in kN, built once, warm-started."""
    N = parameters.horizon
    qp = quadratic_program(model, parameters, np.array([0.0, 1.0]), 0.0, np.full(N, np.inf))
    G = qp.G * 1e3
    G[: 2 * N] /= 1e3
    solver = osqp.OSQP()
    solver.setup(
        sparse.csc_matrix(qp.P * 1e6),
        qp.q * 1e3,
        sparse.csc_matrix(G),
        np.full(4 * N, -1e30),
        np.full(4 * N, 1e30),
        verbose=False,
    )
    S_x, S_u = prediction_matrices(model, N)
    q_per_speed = 2e3 * (S_u[1::2].T @ S_x[1::2])
    q_constant = -2e3 * parameters.reference_speed * S_u[1::2].sum(axis=0)
    lower, upper = qp.lower.copy(), qp.upper.copy()
    lower[: 2 * N] /= 1e3
    upper[: 2 * N] /= 1e3
    rate = parameters.force_rate_limit / 1e3

    def solve(problem: Problem) -> Answer:
        state = np.array([problem.position, problem.speed])
        free = S_x @ state
        lower[N] = problem.previous_force / 1e3 - rate
        upper[N] = problem.previous_force / 1e3 + rate
        lower[2 * N : 3 * N] = parameters.speed_min - free[1::2]
        upper[2 * N : 3 * N] = parameters.speed_max - free[1::2]
        upper[3 * N :] = problem.obstacle_positions - parameters.safe_distance - free[::2]
        solver.update(
            q=q_per_speed @ state + q_constant,
            l=np.maximum(lower, -1e30),
            u=np.minimum(upper, 1e30),
        )
        result = solver.solve(raise_error=False)
        found = result.info.status_val == osqp.SolverStatus.OSQP_SOLVED
        return Answer(found, 1e3 * result.x[0] if found else np.nan)

    return solve


def measure(
    build: Callable[[], Callable[[Problem], Answer]], problems: list[Problem], repeats: int
) -> tuple[list[Answer], Array]:
    """The answers, and each one's least time [us] in several passes: the machine has other work."""
    times = np.full(len(problems), np.inf)
    for _ in range(repeats):
        solve, answers = build(), []
        for i, problem in enumerate(problems):
            start = perf_counter()
            answers.append(solve(problem))
            times[i] = min(times[i], 1e6 * (perf_counter() - start))
    return answers, times


def main() -> None:
    """Print one row per solver."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--problems", type=int, default=4000)
    parser.add_argument("--horizon", type=int, default=15, help="[steps]")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--repeats", type=int, default=3, help="passes; the least time counts")
    args = parser.parse_args()

    model, ours = LongitudinalModel(), MpcParameters(horizon=args.horizon)
    problems = closed_loop(model, ours, args.problems, args.seed)
    reference = [exact(model, ours, problem) for problem in problems]
    surely = np.array([exact(model, ours, problem, -EDGE).found for problem in problems])
    possibly = np.array([exact(model, ours, problem, EDGE).found for problem in problems])
    feasible = np.array([answer.found for answer in reference])
    binding = feasible & np.array(
        [np.isfinite(problem.obstacle_positions).any() for problem in problems]
    )
    print(
        f"{len(problems)} problems, N = {args.horizon}: {feasible.sum()} feasible "
        f"({binding.sum()} with somebody in front), {(~feasible).sum()} infeasible, "
        f"{(possibly & ~surely).sum()} on the knife's edge\n"
    )
    solvers = {
        "osqp (ours)": partial(by_mpc, model, ours),
        "osqp (ours), no exact start": partial(by_mpc, model, ours, FromThePlanBefore),
        "osqp, condensed, kN, defaults": partial(by_plain_osqp, model, ours),
    }
    print(
        f"{'median/p99 [us]':30} {'feasible':>15} {'in front':>15} {'infeasible':>15} "
        f"{'error u(k) [N]':>15} {'false':>6} {'missed':>6}"
    )
    for name, build in solvers.items():
        answers, times = measure(build, problems, args.repeats)
        found = np.array([answer.found for answer in answers])
        both = found & feasible
        error = max(
            abs(a.force - r.force)
            for a, r, counts in zip(answers, reference, both, strict=True)
            if counts
        )
        cells = [
            "{:.0f}/{:.0f}".format(*np.percentile(times[part], [50, 99])) if part.any() else "-"
            for part in (feasible, binding, ~feasible)
        ]
        print(
            f"{name:30} {cells[0]:>15} {cells[1]:>15} {cells[2]:>15} {error:>15.2g} "
            f"{(surely & ~found).sum():>6} {(found & ~possibly).sum():>6}"
        )


if __name__ == "__main__":
    main()
