"""Least squares for M and alpha of the MPC's model, with the actuator's lag and dead time.

The model is the MPC's own one-step prediction, M (v+ - v) / dt + alpha v = F (Yang & Özgüner 2019,
eq. (3)), where F is the mean over the step of the force that acts. For a given lag and dead time
it is linear in 1 / M and alpha / M; the two are found by a search that minimises the residual.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from fmus.checking.manoeuvres import Trace
from fmus.checking.model_fit.actuator import mean_force

STANDSTILL = 0.05  # [m/s] speed below which steps are not fitted: brakes may hold the vehicle
SETTLING = 1.0  # [s] first part of a drive that is not fitted: earlier forces are unknown
LONGEST_LAG = 2.0  # [s] upper bound of the search
LONGEST_DELAY = 1.0  # [s] upper bound of the search
FINENESS = 1e-3  # resolution of lag and dead time, as a share of a step
NOTICEABLE = 0.02  # share by which a lag or dead time must improve the residual
EXACT = 1e-9  # [m/s2] residual that is mere rounding
NORMAL_95 = 1.96  # half width of the interval of 95 %, in standard errors


@dataclass(frozen=True)
class Drive:
    """A trace that is ready for the fit.

    Attributes:
        force: Commanded force (n,) [N].
        speed: Speed (n + 1,) [m/s].
        step: Duration of a step [s].
        used: Flags (n,) of the steps that count.
    """

    force: NDArray[np.float64]
    speed: NDArray[np.float64]
    step: float
    used: NDArray[np.bool_]

    @property
    def acceleration(self) -> NDArray[np.float64]:
        """The mean acceleration (n,) [m/s2] over each step."""
        return np.diff(self.speed) / self.step


def prepare(trace: Trace, limits: tuple[float, float] = (np.inf, np.inf)) -> Drive:
    """Mark the steps that the fit may use: moving, unsaturated, and after the first second.

    Args:
        trace: Trace of a drive.
        limits: Largest drive and brake force that the vehicle carries out [N].
    """
    moving = np.minimum(trace.speed[:-1], trace.speed[1:]) > STANDSTILL
    settled = np.arange(trace.force.size) * trace.step_size >= SETTLING - 1e-9
    beyond = (trace.force > limits[0]) | (trace.force < -limits[1])
    memory = round(SETTLING / trace.step_size)
    since = np.cumsum(beyond)
    recently = since - np.concatenate((np.zeros(memory, int), since))[: since.size] > 0
    return Drive(trace.force, trace.speed, trace.step_size, moving & settled & ~recently)


@dataclass(frozen=True)
class Fit:
    """The fitted model M v' + alpha v = F, and the lag and dead time of the force.

    Attributes:
        intervals: Half widths of the 95 % intervals of M [kg] and alpha [N.s/m].
        residual: Root mean square of the unexplained acceleration [m/s2].
        r_squared: Share of the acceleration's variation that is explained.
    """

    mass: float
    friction: float
    lag: float
    delay: float
    intervals: tuple[float, float]
    residual: float
    r_squared: float

    def acceleration(self, drive: Drive) -> NDArray[np.float64]:
        """Return the model's acceleration (n,) [m/s2] at the measured speed."""
        acting = mean_force(drive.force, drive.step, self.lag, self.delay)
        return (acting - self.friction * drive.speed[:-1]) / self.mass


def fit(drives: Sequence[Drive], *, actuator: bool = True) -> Fit | None:
    """Fit the model to the drives with least squares, or return None with fewer than ten steps.

    A lag or dead time is reported only if it improves the fit noticeably.

    Args:
        drives: Measured drives.
        actuator: True to search also for lag and dead time.
    """
    if sum(int(drive.used.sum()) for drive in drives) < 10:
        return None

    @cache
    def cost(lag: float, delay: float) -> float:
        return solve(drives, lag, delay).residual

    best = simplest = (0.0, 0.0)
    if actuator and cost(0.0, 0.0) > EXACT:
        best = _search(cost, drives[0].step)
        candidates = [(0.0, 0.0), _line_search(cost, 0), _line_search(cost, 1), best]
        enough = max(cost(*best) * (1.0 + NOTICEABLE), EXACT)
        simplest = next(pair for pair in candidates if cost(*pair) <= enough)
    solution = solve(drives, *simplest)
    return solution if np.isfinite(solution.mass) else None


def least_squares(
    X: NDArray[np.float64], y: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the coefficients of X that come closest to y, times the scale of X's columns.

    The scale is returned, too.
    """
    scale = np.maximum(np.abs(X).max(axis=0), 1e-300)
    scaled, *_ = np.linalg.lstsq(X / scale, y, rcond=None)
    return scaled, scale


def resistance_rows(
    drives: Sequence[Drive], lag: float, delay: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the equations M v' + alpha v + c_0 + c_2 v |v| = F, one for each step that counts.

    Returns:
        Coefficients (m, 4) of 1 / M, alpha / M, c_0 / M and c_2 / M, and v' (m,) [m/s2].
    """
    acting, v, y = _used(drives, lag, delay)
    return np.column_stack((acting, -v, -np.ones_like(v), -v * np.abs(v))), y


def _used(
    drives: Sequence[Drive], lag: float, delay: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return acting force [N], v [m/s] and v' [m/s2] (m,) of the steps that count."""
    acting = [mean_force(d.force, d.step, lag, delay)[d.used] for d in drives]
    v = [d.speed[:-1][d.used] for d in drives]
    y = [d.acceleration[d.used] for d in drives]
    return np.concatenate(acting), np.concatenate(v), np.concatenate(y)


def solve(drives: Sequence[Drive], lag: float, delay: float) -> Fit:
    """Solve the linear least-squares problem in theta = (1 / M, alpha / M)."""
    acting, v, y = _used(drives, lag, delay)
    X = np.column_stack((acting, -v))
    group = np.repeat(np.arange(len(drives)), [int(drive.used.sum()) for drive in drives])
    theta, scale = least_squares(X, y)
    if theta[1] < 0.0:  # a negative friction would drive: fit without friction
        theta = np.array(
            [(X[:, 0] / scale[0]) @ y / max(((X[:, 0] / scale[0]) ** 2).sum(), 1e-300), 0.0]
        )
    left = y - X / scale @ theta
    inverse, ratio = theta / scale
    residual = float(np.sqrt(np.mean(left**2)))
    if inverse <= 0.0:  # forces do not move the vehicle
        return Fit(np.inf, 0.0, lag, delay, (np.inf, np.inf), residual, 0.0)
    mass = 1.0 / inverse
    spread = float(np.sqrt(np.mean((y - y.mean()) ** 2)))
    return Fit(
        mass=float(mass),
        friction=float(ratio * mass),
        lag=lag,
        delay=delay,
        intervals=_intervals(X, left, group, mass, ratio * mass),
        residual=residual,
        r_squared=1.0 - (residual / spread) ** 2 if spread > 0.0 else 0.0,
    )


def _intervals(
    X: NDArray[np.float64],
    left: NDArray[np.float64],
    group: NDArray[np.int_],
    mass: float,
    friction: float,
) -> tuple[float, float]:
    """Return the 95 % half widths of M and alpha.

    Errors may be correlated within a drive, but not between drives. The covariance is that of
    clusters (Liang & Zeger 1986), carried to M and alpha to first order.
    """
    scale = np.maximum(np.abs(X).max(axis=0), 1e-300)
    Z = X / scale
    bread = np.linalg.pinv(Z.T @ Z)
    scores = np.array([Z[group == g].T @ left[group == g] for g in np.unique(group)])
    if len(scores) > 1:
        meat = scores.T @ scores * len(scores) / (len(scores) - 1)
    else:
        meat = Z.T @ Z * float(np.mean(left**2))
    covariance = bread @ meat @ bread / np.outer(scale, scale)
    # M = 1 / theta_1, alpha = theta_2 / theta_1
    slopes = np.array([[-(mass**2), 0.0], [-friction * mass, mass]])
    variances = np.diag(slopes @ covariance @ slopes.T)
    half_mass, half_friction = NORMAL_95 * np.sqrt(np.maximum(variances, 0.0))
    return float(half_mass), float(half_friction)


def _search(cost: Callable[[float, float], float], step: float) -> tuple[float, float]:
    """Find lag and dead time of least cost on a coarse grid, then on ever finer ones."""
    lags = [0.0, *np.geomspace(step / 4, LONGEST_LAG, 9)]
    delays = [0.0, *np.geomspace(step / 2, LONGEST_DELAY, 9)]
    best = min(((a, b) for a in lags for b in delays), key=lambda pair: cost(*pair))
    reach = [max(best[0] * 0.6, step / 4), max(best[1] * 0.6, step / 2)]
    while reach[0] + reach[1] > FINENESS * step:
        around = [
            (max(0.0, best[0] + i * reach[0]), max(0.0, best[1] + j * reach[1]))
            for i in (-1, 0, 1)
            for j in (-1, 0, 1)
        ]
        found = min(around, key=lambda pair: cost(*pair))
        if found == best:
            reach = [r * 0.5 for r in reach]
        best = found
    return best


def _line_search(cost: Callable[[float, float], float], axis: int) -> tuple[float, float]:
    """Do the same search with only the lag (axis 0) or only the dead time (axis 1)."""

    def pair(value: float) -> tuple[float, float]:
        return (value, 0.0) if axis == 0 else (0.0, value)

    longest = LONGEST_DELAY if axis else LONGEST_LAG
    grid = np.concatenate(([0.0], np.geomspace(longest / 200, longest, 25)))
    at = int(np.argmin([cost(*pair(float(value))) for value in grid]))
    low, high = float(grid[max(at - 1, 0)]), float(grid[min(at + 1, grid.size - 1)])
    while high - low > FINENESS * longest / 200:
        third = (high - low) / 3.0
        if cost(*pair(low + third)) <= cost(*pair(high - third)):
            high -= third
        else:
            low += third
    return pair(0.5 * (low + high))
