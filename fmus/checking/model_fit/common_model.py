"""M and alpha of the paper's model, for both sides together.

The model is the MPC's own one-step prediction, M (v+ - v) / dt + alpha v = F (Yang & Özgüner 2019,
eq. (3)), where F is the mean over the step of the force that acts behind each side's response.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fmus.checking.model_fit.estimation import Estimate
from fmus.checking.model_fit.measurements import Measurements
from fmus.checking.model_fit.side_response import Array

NORMAL_95 = 1.96  # half width of the interval of 95 %, in standard errors


@dataclass(frozen=True)
class CommonModel:
    """M v' + alpha v = F.

    Attributes:
        mass: M [kg].
        friction: alpha [N.s/m].
        intervals: Half widths of the 95 % intervals of M [kg] and alpha [N.s/m].
        residual: Root mean square [m/s2] of the accelerations that are not explained.
    """

    mass: float
    friction: float
    intervals: tuple[float, float]
    residual: float


def fit_common(
    measured: Measurements, estimate: Estimate, map_friction: float
) -> CommonModel | None:
    """Fit M and alpha by least squares, or return None if forces do not move the vehicle.

    Args:
        measured: Measurements, with speeds at the beginning of each step.
        estimate: Estimate of both sides, from the same drives.
        map_friction: Friction [N.s/m] that an inverse map subtracts from the force.
    """
    acting = sum(measured.acting(side, response) * measured.largest
                 for side, response in enumerate(estimate.responses))  # fmt: skip
    v, y = measured.speed[measured.used], measured.acceleration
    scale = np.array([measured.largest, max(float(np.abs(v).max(initial=0.0)), 1e-9)])
    X = np.column_stack((acting + map_friction * v, -v)) / scale
    # Noise in v is also in v': the mean speed of the step, an instrument, is free of this.
    means = (v + 0.5 * measured.step * y) / scale[1]
    Z = np.column_stack((X[:, 0], -means)) * estimate.linear.weights[:, None]
    bread = np.linalg.pinv(Z.T @ X)
    solution = bread @ (Z.T @ y)
    if solution[1] < 0.0:  # a negative friction would drive: fit without friction
        solution = np.array([Z[:, 0] @ y / (Z[:, 0] @ X[:, 0]), 0.0])
    if solution[0] <= 0.0:
        return None
    left = y - X @ solution
    solution = solution / scale
    mass, friction = 1.0 / solution[0], solution[1] / solution[0]
    slopes = np.array([[-(mass**2), 0.0], [-friction * mass, mass]])
    spread = bread @ _scores(Z, left, measured.drive) @ bread.T / np.outer(scale, scale)
    covariance = slopes @ spread @ slopes.T
    half_mass, half_friction = NORMAL_95 * np.sqrt(np.maximum(np.diag(covariance), 0.0))
    return CommonModel(
        float(mass), float(friction), (float(half_mass), float(half_friction)),
        float(np.sqrt(estimate.linear.weights @ left**2 / estimate.linear.weights.sum())),
    )  # fmt: skip


def _scores(Z: Array, left: Array, group: NDArray[np.int_]) -> Array:
    """Return the covariance (2, 2) of the sums of errors, which are correlated in a drive.

    It is that of clusters (Liang & Zeger 1986).
    """
    if not group.any():  # a single drive: its errors are taken as independent
        return np.asarray(Z.T @ Z * np.mean(left**2))
    scores = np.array([Z[group == g].T @ left[group == g] for g in np.unique(group)])
    return np.asarray(scores.T @ scores * len(scores) / (len(scores) - 1))
