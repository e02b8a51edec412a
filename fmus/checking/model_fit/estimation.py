"""The least-squares estimate of both sides' masses, responses and the resistance they share.

    v' = F_drive / M_drive - F_brake / M_brake - (r_0 + r_1 v + r_2 v |v|)

For given responses it is linear, and solved so (variable projection, Golub & Pereyra 1973); the
responses' parameters are found by Levenberg-Marquardt steps. Residuals are normal, or now and then
anything (a gear that shifts), with the mixture's weights found by expectation maximisation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy  # scipy.special is loaded where it is first used

from fmus.checking.model_fit.measurements import Measurements
from fmus.checking.model_fit.side_response import Array, SideResponse

FLOOR = 0.01  # [m/s2] standard deviation below which residuals need no explanation
STRAY = 0.05  # share of residuals that may be anything
RANGE = 20.0  # [m/s2] range of these
FEW = 2e-3  # share of stray residuals that needs no explanation
ANNEALED = (0.3, 0.1, 0.03, FLOOR)  # [m/s2] floors of a search, one after the other
LEAST_INTERVAL = 4e-3  # smallest half width of an interval, as a share: FMUs have steps, too
_SCALES = {"lag": 0.1, "release": 0.1, "delay": 0.1, "second": 0.01, "exponent": 0.2}
_BOUNDS = {
    "lag": (0.0, 3.0), "release": (0.0, 3.0), "delay": (0.0, 2.0), "second": (0.0, 2.0),
    "exponent": (0.3, 4.0),
}  # fmt: skip
STEPS = 15  # largest number of steps of a search
ENOUGH = 0.05  # gain of the cost below which a search ends
_DIFFERENCE = 0.02  # step of the derivatives, as a share of a parameter's scale


@dataclass(frozen=True)
class Linear:
    """The solution for given responses.

    Attributes:
        rows: Regressors (m, 5).
        coefficients: Coefficients (5,) of the regressors.
        residual: Accelerations (m,) [m/s2] that are not explained.
        deviation: Standard deviation [m/s2] of the residuals that are normal.
        weights: Probabilities (m,) that a residual is normal.
    """

    rows: Array
    coefficients: Array
    residual: Array
    deviation: float
    weights: Array

    @property
    def cost(self) -> float:
        """Minus twice the logarithm of the likelihood."""
        normal, stray = _densities(self.residual, self.deviation)
        return -2.0 * float(np.log(normal + stray).sum())


def _densities(residual: Array, deviation: float) -> tuple[Array, float]:
    normal = (1.0 - STRAY) / (np.sqrt(2.0 * np.pi) * deviation)
    return normal * np.exp(-0.5 * (residual / deviation) ** 2), STRAY / RANGE


def solve(
    measured: Measurements,
    columns: Sequence[Array],
    *,
    weights: Array | None = None,
    floor: float = FLOOR,
    rounds: int = 30,
) -> Linear:
    """Solve the linear part.

    Args:
        measured: Measurements.
        columns: Acting forces (m,) of both sides.
        weights: Weights (m,) to begin with.
        floor: Smallest standard deviation [m/s2] of the residuals.
        rounds: Largest number of rounds for the weights.
    """
    X, y = np.column_stack([*columns, *measured.resistances()]), measured.acceleration
    size = np.maximum(np.abs(X).max(axis=0), 1e-12)
    Z = X / size
    weights = np.ones_like(y) if weights is None else weights
    deviation = np.inf
    for _ in range(rounds):
        weighted = Z * weights[:, None]
        normal = weighted.T @ Z
        found = np.linalg.solve(normal + 1e-12 * np.trace(normal) * np.eye(len(normal)),
                                weighted.T @ y)  # fmt: skip
        residual = y - Z @ found
        before = deviation
        deviation = max(float(np.sqrt(weights @ residual**2 / weights.sum())), floor)
        likely, stray = _densities(residual, deviation)
        weights = likely / (likely + stray)
        if abs(before - deviation) < 1e-3 * deviation:
            break
    return Linear(X, found / size, residual, deviation, weights)


@dataclass(frozen=True)
class Estimate:
    """Both sides' responses, which of their parameters are fitted, and the linear part."""

    measured: Measurements
    responses: tuple[SideResponse, SideResponse]
    names: tuple[tuple[str, ...], tuple[str, ...]]
    linear: Linear

    @classmethod
    def of(
        cls,
        measured: Measurements,
        responses: tuple[SideResponse, SideResponse] = (SideResponse(), SideResponse()),
    ) -> Estimate:
        """Return the estimate for given responses."""
        columns = [measured.acting(side, response) for side, response in enumerate(responses)]
        return cls(measured, responses, ((), ()), solve(measured, columns))

    @property
    def size(self) -> int:
        """The number of parameters of the responses."""
        return len(self.names[0]) + len(self.names[1])

    def mass(self, side: int) -> float:
        """Return M [kg] of a side; it is infinite if its forces do not move the vehicle."""
        gain = float(self.linear.coefficients[side])
        return self.measured.largest / gain if gain > 0.0 else np.inf

    def with_side(
        self, side: int, response: SideResponse, names: tuple[str, ...], linear: Linear
    ) -> Estimate:
        """Return the estimate with another response of one side."""
        responses, free = list(self.responses), list(self.names)
        responses[side], free[side] = response, names
        return replace(
            self, responses=(responses[0], responses[1]), names=(free[0], free[1]), linear=linear
        )

    def columns(self, side: int, response: SideResponse) -> list[Array]:
        """Return the acting forces of both sides, with another response of one side."""
        columns = [self.linear.rows[:, 0], self.linear.rows[:, 1]]
        columns[side] = self.measured.acting(side, response)
        return columns

    def try_out(self, side: int, response: SideResponse) -> float:
        """Return the cost with another response of one side, roughly."""
        return solve(self.measured, self.columns(side, response), rounds=8).cost

    def predicted(self, measured: Measurements) -> Array:
        """Return the accelerations (m,) [m/s2] that the estimate predicts in other drives."""
        scale = self.measured.largest / measured.largest
        columns = [measured.acting(side, response) / scale
                   for side, response in enumerate(self.responses)]  # fmt: skip
        rows = np.column_stack([*columns, *measured.resistances()])
        return np.asarray(rows @ self.linear.coefficients)

    def explained(self, measured: Measurements) -> float:
        """Return the share of the variation of the accelerations that is explained."""
        left = measured.acceleration - self.predicted(measured)
        spread = float(measured.acceleration.var()) if left.size else 0.0
        return 1.0 - float(np.mean(left**2)) / spread if spread > 0.0 else 0.0

    def covers(self) -> bool:
        """Return whether no residual needs an explanation."""
        return self.linear.deviation <= FLOOR and bool((1.0 - self.linear.weights).mean() < FEW)


@dataclass(frozen=True)
class _Search:
    """The named parameters of one side's response as a point, in units of their scales."""

    estimate: Estimate
    side: int
    response: SideResponse
    names: tuple[str, ...]

    @property
    def scales(self) -> Array:
        """The scales (p,) of the parameters."""
        rough = [max(0.1 * float(getattr(self.response, name)), 1e-9) for name in self.names]
        return np.array(
            [_SCALES.get(name, size) for name, size in zip(self.names, rough, strict=True)]
        )

    def point(self, response: SideResponse) -> Array:
        """Return the point (p,) of a response."""
        return np.array([getattr(response, name) for name in self.names]) / self.scales

    def made(self, point: Array) -> SideResponse:
        """Return the response at a point, within the parameters' bounds."""
        values: dict[str, Any] = {
            name: float(np.clip(value, *_BOUNDS.get(name, (1e-3, np.inf))))
            for name, value in zip(self.names, point * self.scales, strict=True)
        }
        return replace(self.response, **values)

    def solve(self, response: SideResponse, floor: float, weights: Array | None) -> Linear:
        """Solve the linear part with another response."""
        columns = self.estimate.columns(self.side, response)
        return solve(self.estimate.measured, columns, floor=floor, weights=weights)

    def slopes(self, point: Array, linear: Linear) -> Array:
        """Return the derivatives (m, p) of the predicted accelerations."""
        J = np.empty((linear.residual.size, point.size))
        gain = linear.coefficients[self.side] / _DIFFERENCE
        for i in range(point.size):
            moved = point.copy()
            moved[i] += _DIFFERENCE
            column = self.estimate.columns(self.side, self.made(moved))[self.side]
            J[:, i] = (column - linear.rows[:, self.side]) * gain
        return J


def refine(
    estimate: Estimate, side: int, response: SideResponse, names: tuple[str, ...]
) -> Estimate:
    """Fit the named parameters of one side's response, from the given one on.

    Args:
        estimate: Estimate of the rest.
        side: Side: 0 is driving, 1 is braking.
        response: Response to begin with.
        names: Names of its parameters that are fitted.
    """
    search = _Search(estimate, side, response, names)
    if not names:
        return estimate.with_side(side, response, names, search.solve(response, FLOOR, None))
    weights: Array | None = None
    # Far from the solution residuals are large without being stray: the floor sinks.
    for floor in ANNEALED:
        linear, damping = search.solve(response, floor, weights), 1e-2
        for _ in range(STEPS):
            J, found = search.slopes(search.point(response), linear), linear
            while damping < 1e4:
                step = _step(linear, J, damping)
                tried = search.made(search.point(response) + step)
                found = search.solve(tried, floor, linear.weights)
                if found.cost < linear.cost:
                    break
                damping *= 10.0
            gained = linear.cost - found.cost
            if gained <= 0.0:
                break
            response, linear, damping = tried, found, max(0.1 * damping, 1e-6)
            if gained < ENOUGH:
                break
        weights = linear.weights
    return estimate.with_side(side, response, names, linear)


def _step(linear: Linear, J: Array, damping: float) -> Array:
    """Return the Levenberg-Marquardt step, with the linear coefficients moving along."""
    size = np.maximum(np.abs(linear.rows).max(axis=0), 1e-12)
    A = np.column_stack([linear.rows / size, J])
    weighted = A * linear.weights[:, None]
    normal = weighted.T @ A
    added = np.diag(normal).copy()
    added[:5] *= 1e-9
    added = damping * added + 1e-12 * np.trace(normal)
    step = np.linalg.solve(normal + np.diag(added), weighted.T @ linear.residual)[5:]
    return np.asarray(np.clip(step, -5.0, 5.0))


def half_widths(estimate: Estimate) -> tuple[float, float]:
    """Return the half widths [kg] of the 95 % intervals of both masses.

    Residuals may be correlated within a drive. The covariance is that of a jackknife over drives
    (CR3, Bell & McCaffrey 2002), with all parameters of the responses free.
    """
    linear, measured = estimate.linear, estimate.measured
    blocks = [linear.rows]
    for side, response in enumerate(estimate.responses):
        search = _Search(estimate, side, response, estimate.names[side])
        blocks.append(search.slopes(search.point(response), linear))
    A = np.column_stack(blocks)
    A = A / np.maximum(np.abs(A).max(axis=0), 1e-12)
    weighted = A * linear.weights[:, None]
    normal = weighted.T @ A + 1e-10 * np.eye(A.shape[1]) * linear.weights.sum()
    drives = np.unique(measured.drive)
    moved = []
    for drive in drives:
        own = measured.drive == drive
        rest = normal - weighted[own].T @ A[own]
        moved.append(np.linalg.solve(rest, weighted[own].T @ linear.residual[own]))
    n = len(drives)
    spread = np.sqrt((n - 1) / n * (np.array(moved) ** 2).sum(axis=0))[:2]
    scale = np.maximum(np.abs(linear.rows).max(axis=0), 1e-12)[:2]
    relative = spread / scale / np.maximum(np.abs(linear.coefficients[:2]), 1e-300)
    quantile = float(scipy.special.stdtrit(max(n - A.shape[1], 1), 0.975))
    one, two = (
        estimate.mass(side) * max(quantile * float(relative[side]), LEAST_INTERVAL)
        for side in (0, 1)
    )
    return one, two
