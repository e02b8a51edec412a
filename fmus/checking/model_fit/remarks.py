"""Remarks for the user about an identified model, one line each."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fmus.checking.manoeuvres import Trace
from fmus.checking.model_fit.fitting import Drive, Fit, least_squares, prepare, resistance_rows
from fmus.profile.vehicle_profile import FittedModel

POOR_FIT = 0.9  # R squared below which a remark says so


def saturation_remarks(limits: tuple[float, float]) -> list[str]:
    """Remark on the largest drive and brake force that arrive [N], if they were reached."""
    return [
        f"no more than {limit:.0f} N of {name} force arrive: run with --vehicle-force-limit "
        f"{limit:.0f} or less{' (which bounds the brakes, too)' if name == 'drive' else ''}"
        for name, limit in zip(("drive", "brake"), limits, strict=True)
        if np.isfinite(limit)
    ]


def fit_remarks(
    found: Fit, model: FittedModel, traces: Sequence[Trace], limits: tuple[float, float]
) -> list[str]:
    """Remark on how well M v' + alpha v = u describes the vehicle, and on other resistance.

    Args:
        found: Fitted M, alpha and actuator.
        model: The same model with its errors.
        traces: Traces that were fitted.
        limits: Largest forces of the steps that were fitted [N].
    """
    remarks = []
    if model.r_squared < POOR_FIT:
        remarks.append(
            f"poor fit: R² = {model.r_squared:.2f}; M v' + alpha v = u is not how it moves, "
            f"expect the MPC to be off by {model.position_error:.2g} m at its horizon"
        )
    late = model.lag + model.delay
    if late > model.time_step:
        remarks.append(
            f"forces act {late:.2g} s late; the MPC does not know that: its position error of "
            f"{model.position_error:.2g} m at the horizon has it in"
        )
    return [*remarks, *_resistance(found, [prepare(trace, limits) for trace in traces])]


def _resistance(found: Fit, drives: Sequence[Drive]) -> list[str]:
    """Remark on further resistance: a constant force, and one that grows with speed squared."""
    speed = np.concatenate([drive.speed[:-1][drive.used] for drive in drives])
    left = np.concatenate([(d.acceleration - found.acceleration(d))[d.used] for d in drives])
    X, measured = resistance_rows(drives, found.lag, found.delay)
    theta, scale = least_squares(X, measured)
    better = float(np.sqrt(np.mean((measured - X / scale @ theta) ** 2)))
    if better > 0.7 * found.residual or found.residual - better < 0.005 or theta[0] <= 0.0:
        return []
    fastest = float(speed.max())
    worst = float(np.sqrt(np.mean(left[speed > 0.8 * fastest] ** 2)))
    terms = _terms(theta[1:] / scale[1:] * scale[0] / theta[0], fastest)
    return [
        f"its resistance is not alpha v: {terms} fits better; near {fastest:.0f} m/s the MPC's "
        f"model misses {worst:.2g} m/s²"
    ]


def _terms(resistance: NDArray[np.float64], fastest: float) -> str:
    """Return a sum in words, without the terms that hardly matter at any speed.

    Args:
        resistance: Coefficients: viscous [N.s/m], constant [N] and quadratic [N.s2/m2].
        fastest: Highest speed [m/s].
    """
    viscous, constant, quadratic = resistance.tolist()
    terms = (
        (constant, 1.0, "N"),
        (viscous, fastest, "N.s/m v"),
        (quadratic, fastest**2, "N.s²/m² v²"),
    )
    most = max(abs(factor) * size for factor, size, _ in terms)
    return " + ".join(
        f"{factor:.3g} {unit}" for factor, size, unit in terms if abs(factor) * size > 0.02 * most
    )
