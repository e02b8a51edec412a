"""What the planner's tests share: its QP written out plainly, and people who stand in the way."""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from scipy.optimize import linprog

from controller import Evaluation, LongitudinalModel, PlannerParameters
from controller.planning.smoothing import nodes_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

sys.path.insert(0, str(Path(__file__).parent))  # smoothing_cases


@dataclass(frozen=True)
class PlainProblem:
    """The smoothing problem in its speeds v_1 ... v_n, row by row as the documentation has it."""

    speed: float
    previous_force: float
    acceleration: float  # before now
    wanted: Array  # (n,)
    fastest: float
    room: Array  # (N,)
    model: LongitudinalModel = field(default_factory=LongitudinalModel)
    parameters: PlannerParameters = field(default_factory=PlannerParameters)

    @property
    def nodes(self) -> Array:
        return nodes_of(self.parameters.horizon)

    @property
    def intervals(self) -> Array:
        return np.diff(self.nodes, prepend=0) * self.model.time_step

    def cost(self, v: Array) -> Array:
        """(...) of the plans ``v`` (..., n)."""
        p, h = self.parameters, self.intervals
        apart = np.concatenate([h[:1], (h[1:] + h[:-1]) / 2.0])
        a = np.diff(v, prepend=self.speed) / h
        jerk = np.diff(a, prepend=self.acceleration) / apart
        error = h * (v - self.wanted) ** 2
        return (error + p.effort_weight * h * a**2 + p.jerk_weight * apart * jerk**2).sum(axis=-1)

    def quadratic(self) -> tuple[Array, Array]:
        """P, q of 1/2 v'Pv + q'v: differences of the cost, which are exact for a quadratic."""
        n = len(self.nodes)
        e, f = np.eye(n), self.cost
        each = f(e)
        pairs = f(e[:, None] + e[None, :])
        P = pairs - each[:, None] - each[None, :] + f(np.zeros(n))
        return P, (each - f(-e)) / 2.0

    def rows(self) -> tuple[Array, Array, Array]:
        """G, lower, upper of all limits but the corridor's."""
        p, m, h = self.parameters, self.model, self.intervals
        n = len(h)
        top = min(p.speed_max, max(self.fastest, self.speed))
        low_force = max(-p.force_limit, self.previous_force - p.force_rate_limit)
        high_force = min(p.force_limit, self.previous_force + p.force_rate_limit)
        least = max(0.0, m.decay * self.speed + m.speed_per_force * low_force)
        most = min(top, m.decay * self.speed + m.speed_per_force * high_force)
        G, lower, upper = [*np.eye(n)], [0.0] * n, [top] * n
        lower[0], upper[0] = least, max(most, least)
        for i in range(1, n):
            row = np.zeros(n)
            row[i - 1], row[i] = -1.0 / h[i], 1.0 / h[i]
            G.append(row)
            lower.append(-p.force_limit / m.mass)
            upper.append(p.force_limit / m.mass)
        return np.array(G), np.array(lower), np.array(upper)

    def distances(self) -> tuple[Array, Array]:
        """D, rooms: D v <= rooms is the corridor at the nodes 2 ... n."""
        h, n = self.intervals, len(self.intervals)
        D = np.zeros((n - 1, n))
        for i in range(1, n):
            for k in range(1, i + 1):
                D[i - 1, k - 1] += h[k] / 2.0
                D[i - 1, k] += h[k] / 2.0
        nodes = self.nodes
        rooms = [self.room[nodes[i - 1] : nodes[i]].min() for i in range(1, n)]
        return D, np.array(rooms) - self.model.time_step * self.speed

    def unavoidable(self) -> tuple[Array, float]:
        """Row by row the least violation of the corridor, and the least sum of all; by HiGHS."""
        G, lower, upper = self.rows()
        D, rooms = self.distances()
        known = np.isfinite(rooms)
        n, m = G.shape[1], int(known.sum())
        A = np.block(
            [
                [G, np.zeros((len(G), m))],
                [-G, np.zeros((len(G), m))],
                [D[known], -np.eye(m)],
            ]
        )
        b = np.concatenate([upper, -lower, rooms[known]])
        bounds = [(None, None)] * n + [(0.0, None)] * m

        def least(weights: Array) -> float:
            cost = np.concatenate([np.zeros(n), weights])
            result = linprog(cost, A_ub=A, b_ub=b, bounds=bounds, method="highs")
            assert result.status == 0
            return float(result.fun)

        each = np.zeros(n - 1)
        each[known] = [least(weights) for weights in np.eye(m)]
        return each, least(np.ones(m)) if m else 0.0


class Bystanders:
    """People who stand in the ego's way until they are gone, foreseen exactly.

    Args:
        at: (n,) [m] their stations; the ego starts at 0.
        until: (n,) the step at which each one is gone.
        horizon: N.
    """

    def __init__(self, at: Array, until: Array, horizon: int) -> None:
        self.at, self.until = np.asarray(at, dtype=float), np.asarray(until, dtype=float)
        self.step, self.front = 0, 0.0
        self._steps = 1 + np.arange(horizon)
        self._threat_free = np.full(horizon, np.inf)

    def gap(self) -> float:
        """To the closest one now [m]."""
        there = (self.until > self.step) & (self.at > self.front - 0.3)
        return float(np.min(self.at[there] - self.front, initial=np.inf))

    def evaluate(self, manoeuvre, *, creeps=False):
        gap = self.at - self.front - manoeuvre.distance[1:, None]
        there = (self.until > self.step + self._steps[:, None]) & (gap > -0.3)
        closest = np.where(there, gap, np.inf).min(axis=1, initial=np.inf)
        return Evaluation(closest, self._threat_free, self._threat_free)

    def prefer(self):
        pass


@pytest.fixture(scope="session")
def plain_problem() -> type[PlainProblem]:
    return PlainProblem


@pytest.fixture(scope="session")
def bystanders() -> type[Bystanders]:
    return Bystanders
