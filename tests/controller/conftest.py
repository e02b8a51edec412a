"""Independent references: DAQP, HiGHS and NNLS on the paper's own condensed problem.

Forces are solved for as dt/M u [m/s], and all rows of forces stand in that unit too. The problem
that the controller solves has every bound 1e-9 wider (``SLACK``), and floating point decides the
rest, so a problem whose constraints can be met or missed by less than ``EDGE`` may be judged
either way; everything beyond is exact.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import daqp
import numpy as np
import pytest
from scipy.optimize import linprog, nnls

from controller import LongitudinalModel, MpcParameters
from controller.paper_mpc.speed_problem import (
    CANNOT_HOLD_SPEED,
    CANNOT_STOP,
    UNDECIDED,
    SpeedProblem,
)

sys.path[:0] = [str(Path(__file__).parents[2] / "benchmarks" / "speed"), str(Path(__file__).parent)]
from paper_qp import quadratic_program  # noqa: E402 - files beside this one and in benchmarks/

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Array = NDArray[np.float64]

EDGE = 1e-6  # m, m/s


@dataclass(frozen=True)
class Reference:
    """One problem of the paper, for solvers that know nothing of ours."""

    model: LongitudinalModel
    parameters: MpcParameters
    position: float
    speed: float
    previous_force: float
    obstacle_positions: Array

    def scaled(self) -> tuple[Array, Array, Array, Array, Array]:
        """P, q, G, l, u in dt/M U [m/s]."""
        state = np.array([self.position, self.speed])
        qp = quadratic_program(
            self.model, self.parameters, state, self.previous_force, self.obstacle_positions
        )
        per_force = self.model.time_step / self.model.mass
        units = np.ones(len(qp.G))
        units[: 2 * self.parameters.horizon] = per_force
        G = units[:, np.newaxis] * qp.G / per_force
        return qp.P / per_force**2, qp.q / per_force, G, units * qp.lower, units * qp.upper

    def margin(self, only_positions: bool = False) -> float:
        """By how much all constraints (or c6 alone) can be met at once, or must be missed (< 0).

        An LP, solved by HiGHS: max t such that G z + t <= u and G z - t >= l.
        """
        _, _, G, lower, upper = self.scaled()
        spared = np.ones(len(G))
        if only_positions:
            spared[: -self.parameters.horizon] = 0.0
        rows = np.concatenate(
            [np.column_stack([G, spared]), np.column_stack([-G, spared])], dtype=float
        )
        sides = np.concatenate([upper, -lower])
        bound = np.isfinite(sides)
        cost = np.zeros(G.shape[1] + 1)
        cost[-1] = -1.0
        free = [(None, None)] * G.shape[1]
        result = linprog(
            cost, A_ub=rows[bound], b_ub=sides[bound], bounds=[*free, (None, 1e3)], method="highs"
        )
        return float(result.x[-1]) if result.status == 0 else -np.inf

    def forces(self) -> Array | None:
        """(N,) [N] the optimum by DAQP; None if it finds none."""
        P, q, G, lower, upper = self.scaled()
        constant = ~G.any(axis=1)  # x_1(k+1)
        if (upper[constant] < 0.0).any():
            return None
        x, _, flag, _ = daqp.solve(
            P,
            q,
            np.ascontiguousarray(G[~constant]),
            np.minimum(upper[~constant], 1e30),
            np.maximum(lower[~constant], -1e30),
            np.zeros((~constant).sum(), dtype=np.int32),
            primal_tol=1e-9,
            dual_tol=1e-12,
        )
        return x * self.model.mass / self.model.time_step if flag == 1 else None

    def forces_by_least_distance(self) -> Array:
        """(N,) [N] the optimum by scipy's NNLS, of another family than all our solvers.

        With P = L L' and y = L'z + q/L the problem is the least |y| subject to E y >= f, which
        Lawson & Hanson (1974, chapter 23) reduce to non-negative least squares.
        """
        P, q, G, lower, upper = self.scaled()
        rows = np.concatenate([-G[np.isfinite(upper)], G[np.isfinite(lower)]])
        sides = np.concatenate([-upper[np.isfinite(upper)], lower[np.isfinite(lower)]])
        L = np.linalg.cholesky(P)
        shift = np.linalg.solve(L, q)
        E = np.linalg.solve(L, rows.T)
        f = sides + E.T @ shift
        matrix = np.vstack([E, f])
        target = np.eye(len(matrix))[-1]
        w, _ = nnls(matrix, target, maxiter=10_000)
        residual = matrix @ w - target
        z = np.linalg.solve(L.T, -residual[:-1] / residual[-1] - shift)
        return z * self.model.mass / self.model.time_step


@pytest.fixture
def reference() -> type[Reference]:
    return Reference


@pytest.fixture
def edge() -> float:
    return EDGE


@pytest.fixture
def draw() -> Callable[[np.random.Generator, LongitudinalModel, MpcParameters], Reference]:
    """Random problems, each with a purpose: free, cut in, crossed, followed, receding."""

    def problem(
        generator: np.random.Generator, model: LongitudinalModel, parameters: MpcParameters
    ) -> Reference:
        N, d_safe = parameters.horizon, parameters.safe_distance
        u_max, v_max = parameters.force_limit, parameters.speed_max
        t = model.time_step * np.arange(1, N + 1)
        slow, fast = generator.uniform(0.0, 5.0), generator.uniform(0.0, v_max)
        near_max = v_max * (1.0 - 1e-3 * generator.uniform())
        speed = float(generator.choice([0.0, slow, slow, fast, near_max, v_max]))
        cruise = float(np.clip(model.friction * speed, -u_max, u_max))
        previous = float(
            generator.choice([cruise, cruise, generator.uniform(-u_max, u_max), -u_max, u_max])
        )
        position = generator.uniform(-100.0, 1000.0)
        x_p = np.full(N, np.inf)
        first = generator.integers(N)
        last = generator.integers(first, N) + 1
        reach = d_safe + generator.uniform(0.0, 1.2) * max(speed, 0.3) * t[first]
        match generator.integers(5):
            case 1:
                x_p[:] = d_safe + speed * t[-1] * generator.uniform(0.0, 1.2)  # stands there
            case 2:
                x_p[first:last] = reach  # crosses
            case 3:
                x_p[first:] = reach  # steps in and stays
            case 4:
                x_p = d_safe + generator.uniform(0.0, 3.0) + generator.uniform(-3.0, 5.0) * t
        return Reference(model, parameters, position, speed, previous, position + x_p)

    return problem


@pytest.fixture
def problems(draw):
    """Yields (reference, speed problem with its bounds set), those that no single row refutes."""

    model, parameters = LongitudinalModel(), MpcParameters()

    def some(count, seed):
        generator, speeds = np.random.default_rng(seed), SpeedProblem(model, parameters)
        while count > 0:
            reference = draw(generator, model, parameters)
            code = speeds.update(
                reference.position,
                reference.speed,
                reference.previous_force,
                reference.obstacle_positions,
            )
            if code in (UNDECIDED, CANNOT_STOP, CANNOT_HOLD_SPEED):
                count -= 1
                yield reference, speeds

    return some
