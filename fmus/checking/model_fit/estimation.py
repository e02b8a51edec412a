"""The least-squares estimate of both sides' masses, responses and the resistance they share.

    v' = F_drive / M_drive - F_brake / M_brake - (r_0 + r_1 v + r_2 v |v|)

For given responses it is linear, and solved so (variable projection, Golub & Pereyra 1973); the
responses' parameters are found by Levenberg-Marquardt steps. Residuals are normal, or now and then
anything (a gear that shifts), with the mixture's weights found by expectation maximisation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import stdtrit

from fmus.checking.model_fit.measurements import Measurements
from fmus.checking.model_fit.side_response import Array, SideResponse

FLOOR = 0.01  # [m/s2] standard deviation below which residuals need no explanation
STRAY = 0.05  # share of residuals that may be anything
RANGE = 20.0  # [m/s2] range of these
ANNEALED = (0.3, 0.1, 0.03, FLOOR)  # [m/s2] floors of a search, one after the other
LEAST_INTERVAL = 2e-3  # smallest half width of an interval, as a share: FMUs have steps, too
_SCALES = {"lag": 0.1, "release": 0.1, "delay": 0.1, "second": 0.01, "exponent": 0.2}
_BOUNDS = {
    "lag": (0.0, 3.0), "release": (0.0, 3.0), "delay": (0.0, 2.0), "second": (0.0, 2.0),
    "exponent": (0.3, 4.0),
}  # fmt: skip
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

    def covers(self) -> bool:
        """Return whether no residual needs an explanation."""
        return self.linear.deviation <= FLOOR and bool((1.0 - self.linear.weights).sum() < 1.0)


def refine(
    estimate: Estimate, side: int, response: SideResponse, names: tuple[str, ...],
    floors: Sequence[float] = ANNEALED,
) -> Estimate:  # fmt: skip
    """Fit the named parameters of one side's response, from the given one on.

    Args:
        estimate: Estimate of the rest.
        side: Side: 0 is driving, 1 is braking.
        response: Response to begin with.
        names: Names of its parameters that are fitted.
        floors: Floors of the residuals' deviation [m/s2], one after the other: far from the
            solution, residuals are large without being stray.
    """
    scales = np.array([_scale(response, name) for name in names])

    def made(point: Array) -> SideResponse:
        return replace(response, **_values(names, point * scales))

    point = np.array([getattr(response, name) for name in names]) / scales
    linear: Linear | None = None
    for floor in floors if names else floors[-1:]:
        linear = solve(estimate.measured, estimate.columns(side, made(point)), floor=floor,
                       weights=None if linear is None else linear.weights)  # fmt: skip
        damping = 1e-2
        for _ in range(15):
            if not names:
                break
            J = _slopes(estimate, side, made, point, linear)
            better = None
            while better is None and damping < 1e4:
                tried = np.array([getattr(made(point + _step(linear, J, damping)), name)
                                  for name in names]) / scales  # fmt: skip
                found = solve(estimate.measured, estimate.columns(side, made(tried)),
                              weights=linear.weights, floor=floor)  # fmt: skip
                if found.cost < linear.cost:
                    better = found
                else:
                    damping *= 10.0
            if better is None:
                break
            gained, linear, point = linear.cost - better.cost, better, tried
            damping = max(0.1 * damping, 1e-6)
            if gained < 0.05:
                break
    assert linear is not None
    return estimate.with_side(side, made(point), names, linear)


def _scale(response: SideResponse, name: str) -> float:
    return _SCALES.get(name) or max(0.1 * float(getattr(response, name)), 1e-9)


def _values(names: Sequence[str], values: Array) -> dict[str, float]:
    return {
        name: float(np.clip(value, *_BOUNDS.get(name, (1e-3, np.inf))))
        for name, value in zip(names, values, strict=True)
    }


def _slopes(estimate, side, made, point, linear):  # type: ignore[no-untyped-def]
    J = np.empty((linear.residual.size, point.size))
    for i in range(point.size):
        moved = point.copy()
        moved[i] += _DIFFERENCE
        column = estimate.columns(side, made(moved))[side]
        J[:, i] = (column - linear.rows[:, side]) * linear.coefficients[side] / _DIFFERENCE
    return J


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
    for side, (response, names) in enumerate(
        zip(estimate.responses, estimate.names, strict=True)
    ):
        if names:
            scales = np.array([_scale(response, name) for name in names])
            point = np.array([getattr(response, name) for name in names]) / scales

            def made(at, response=response, names=names, scales=scales):  # type: ignore[no-untyped-def]
                return replace(response, **_values(names, at * scales))

            blocks.append(_slopes(estimate, side, made, point, linear))
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
    quantile = float(stdtrit(max(n - A.shape[1], 1), 0.975))
    one, two = (
        estimate.mass(side) * max(quantile * float(relative[side]), LEAST_INTERVAL)
        for side in (0, 1)
    )
    return one, two
