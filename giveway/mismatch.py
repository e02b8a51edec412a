"""Whether a vehicle answered as the controller's model of it said it would."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from giveway.run_result import EgoResult
    from giveway.tracks import EgoTrack

    Array = NDArray[np.float64]

_MOVING = 0.05  # [m/s] below it brakes hold, and the model does not apply
_ENOUGH = 20  # steps to judge by
_TOLERATED = 0.05  # [m] over the horizon


@dataclass(frozen=True)
class Mismatch:
    """How far the model was off.

    Attributes:
        position_error: [m] 95 % of the predictions over the horizon were closer.
        speed_error: [m/s] root mean square, one step ahead.
        mass: M [kg] that fits best; nan if the drive does not tell.
        friction: alpha [N.s/m] likewise.
    """

    position_error: float
    speed_error: float
    mass: float
    friction: float


def remark(ego: EgoResult, time_step: float, margin: float) -> str:
    """What the user should know of a vehicle whose FMU is not ours; empty if all is well.

    Args:
        ego: how it drove.
        time_step: of the co-simulation [s].
        margin: the error that its controller allows for [m].
    """
    config = ego.config
    mass, friction = config.vehicle.mass, config.vehicle.friction
    horizon = config.mpc.horizon
    found = measure(ego.track, mass, friction, time_step, horizon)
    if found is None or found.position_error <= max(_TOLERATED, 1.5 * margin):
        return ""
    fitting = ""
    if np.isfinite(found.mass):
        fitting = f" (M = {found.mass:.4g} kg and alpha = {found.friction:.4g} N.s/m fit better)"
    fmu, profile = config.vehicle.fmu, config.vehicle.profile
    named = f" --profile {profile}" if profile else ""
    return (
        f"ego '{ego.id}': the vehicle does not answer as the controller's M = {mass:g} kg, alpha = "
        f"{friction:g} N.s/m predict: off by up to {found.position_error:.2g} m in "
        f"{horizon * time_step:.3g} s{fitting}; match them with: giveway fmu identify {fmu}{named} "
        f"-o {profile or 'car.toml'}"
    )


def measure(
    track: EgoTrack, mass: float, friction: float, time_step: float, horizon: int
) -> Mismatch | None:
    """Compare a drive with M v' + alpha v = u; None: it does not tell.

    Args:
        track: of the vehicle.
        mass: M [kg].
        friction: alpha [N.s/m].
        time_step: [s].
        horizon: steps that are predicted at once.
    """
    v, u, s = track.speed, track.force, track.position
    moving = np.minimum(v[:-1], v[1:]) > _MOVING
    if np.count_nonzero(moving) < _ENOUGH:
        return None
    change = np.diff(v)
    error = change - time_step / mass * (u[:-1] - friction * v[:-1])
    speed_error = float(np.sqrt(np.mean(error[moving] ** 2)))
    fitted = _fit(v[:-1][moving], u[:-1][moving], change[moving], time_step)
    return Mismatch(
        _position_error(v, u, s, mass, friction, time_step, horizon), speed_error, *fitted
    )


def _position_error(
    v: Array, u: Array, s: Array, mass: float, friction: float, time_step: float, horizon: int
) -> float:
    """The 95th percentile of how far off [m] the model is after ``horizon`` steps of driving."""
    starts = np.arange(max(0, len(v) - horizon))
    driving = np.lib.stride_tricks.sliding_window_view(v, horizon + 1).min(axis=1) > _MOVING
    starts = starts[driving[: len(starts)]]
    if not len(starts):
        return 0.0
    speed, position = v[starts], s[starts]
    for k in range(horizon):
        ahead = speed + time_step / mass * (u[starts + k] - friction * speed)
        position = position + 0.5 * time_step * (speed + ahead)
        speed = ahead
    return float(np.percentile(np.abs(position - s[starts + horizon]), 95))


def _fit(v: Array, u: Array, change: Array, time_step: float) -> tuple[float, float]:
    """M and alpha by least squares; nan where the drive does not tell them apart."""
    nothing = float("nan"), float("nan")
    A = np.stack([u, -v], axis=1) * time_step
    solution, _, rank, singular = np.linalg.lstsq(A / np.linalg.norm(A, axis=0), change, rcond=None)
    if rank < 2 or singular[-1] < 1e-3 * singular[0]:
        return nothing
    per_mass, rate = solution / np.linalg.norm(A, axis=0)
    if not per_mass > 0.0:
        return nothing
    return 1.0 / per_mass, max(0.0, rate / per_mass)
