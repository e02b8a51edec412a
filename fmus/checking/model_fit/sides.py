"""Separate fits of driving and braking, which have different actuators and strengths.

Engine and brakes are two devices. One fit of both gives a mean of their lags, and hides a pedal
whose ``full_force`` is wrong: the vehicle then seems to weigh more on one side than on the other.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from fmus.checking.model_fit.fitting import LONGEST_LAG, Drive, Fit, solve
from fmus.checking.model_fit.saturation import ResistanceModel
from fmus.profile.advice import gain_line
from fmus.profile.vehicle_profile import VehicleProfile

ENOUGH = 20  # Number of steps needed for a fit
# Numbers of lags that are tried first and then around the best one, and of refinements
COARSE, FINE, REFINED = 8, 5, 3
UNEQUAL = 1.15  # Factor between the two masses from which a remark is made


@dataclass(frozen=True)
class Sides:
    """The models of driving and braking; None where the tests do not determine them."""

    drive: ResistanceModel | None
    brake: ResistanceModel | None


def fit_apart(drives: Sequence[Drive], delay: float) -> Sides:
    """Return mass, lag and dead time of each side, from the steps after its own last force.

    Args:
        drives: Drives in which both forces occur, one after the other.
        delay: Dead time [s] of both together; each side has this dead time or none.
    """
    return Sides(_fit_side(drives, 1.0, delay), _fit_side(drives, -1.0, delay))


def _fit_side(drives: Sequence[Drive], sign: float, delay: float) -> ResistanceModel | None:
    own = [_of_side(drive, sign) for drive in drives]
    if sum(int(drive.used.sum()) for drive in own) < ENOUGH:
        return None

    @cache
    def fitted(lag: float) -> Fit:
        return min((solve(own, lag, late) for late in {0.0, delay}), key=lambda f: f.residual)

    lags = [0.0, *np.geomspace(own[0].step / 4, LONGEST_LAG, COARSE).tolist()]
    for _ in range(REFINED):
        best = min(lags, key=lambda lag: fitted(lag).residual)
        at = lags.index(best)
        low, high = lags[max(at - 1, 0)], lags[min(at + 1, len(lags) - 1)]
        lags = [best, *np.linspace(low, high, FINE).tolist()]
        lags.sort()
    found = fitted(min(lags, key=lambda lag: fitted(lag).residual))
    return ResistanceModel.of(found, own) if np.isfinite(found.mass) else None


def _of_side(drive: Drive, sign: float) -> Drive:
    """Return the drive with forces of one sign only, and the steps without the other's effect."""
    pushed = np.sign(drive.force)
    last = np.maximum.accumulate(np.where(pushed != 0.0, np.arange(pushed.size), 0))
    others = pushed[last] == -sign
    force = np.where(pushed == sign, drive.force, 0.0)
    return replace(drive, force=force, used=drive.used & ~others)


def side_remarks(sides: Sides, step: float, profile: VehicleProfile | None) -> list[str]:
    """Return remarks on the two sides for the user, one line each.

    Args:
        sides: Fits of both sides.
        step: Step of the controller [s]; lags that differ by less are taken as equal.
        profile: Profile of the vehicle, for the line to change in it.
    """
    drive, brake = sides.drive, sides.brake
    if drive is None or brake is None:
        return []
    remarks = []
    late = [side.lag + side.delay for side in (drive, brake)]
    if abs(late[0] - late[1]) > step:
        remarks.append(
            f"it drives {late[0]:.2g} s late (lag {drive.lag:.2g} s, dead time {drive.delay:.2g} "
            f"s) and brakes {late[1]:.2g} s late (lag {brake.lag:.2g} s, dead time "
            f"{brake.delay:.2g} s)"
        )
    ratio = brake.mass / drive.mass
    if not 1.0 / UNEQUAL < ratio < UNEQUAL:
        remarks.append(
            f"it drives like {drive.mass:.4g} kg and brakes like {brake.mass:.4g} kg"
            f"{_remedy(ratio, profile)}"
        )
    return remarks


def _remedy(ratio: float, profile: VehicleProfile | None) -> str:
    """Return the line that makes the brake as strong as the drive, if they can differ."""
    if profile is None:
        return ""
    inputs = profile.inputs
    if inputs.throttle is not None and inputs.brake is not None:
        strength = inputs.brake.full_force / ratio
        other = inputs.throttle.full_force * ratio
        return (
            f": if the throttle's is right, write `full_force = {strength:.4g}` in [inputs.brake]; "
            f"if the brake's is, `full_force = {other:.4g}` in [inputs.throttle]"
        )
    if inputs.brake_force is not None:
        line = gain_line(profile, "inputs", "brake_force", float(f"{1.0 / ratio:.4g}"))
        return f": if the drive force is right, write {line}"
    return ""
