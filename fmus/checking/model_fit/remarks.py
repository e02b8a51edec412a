"""Remarks for the user about an identified model, one line each."""

from __future__ import annotations

import numpy as np

from fmus.checking.model_fit.common_model import CommonModel
from fmus.checking.model_fit.estimation import Estimate
from fmus.checking.model_fit.side_models import SIDES, active
from fmus.profile.advice import gain_line
from fmus.profile.vehicle_profile import FittedModel, VehicleProfile

UNEQUAL = 1.15  # Factor between the two masses from which a remark is made
GAPS = 0.1  # share of a side's steps that do not follow its model, from which a remark is made
OTHER = 0.1  # share of the resistance that is not alpha v, from which a remark is made
CURVED = 0.05  # difference of a characteristic's exponent from 1, from which a remark is made


def estimate_remarks(estimate: Estimate, model: FittedModel, *, positions: bool) -> list[str]:
    """Remark on what the tests show beside M, lag and dead time.

    Args:
        estimate: Estimate of both sides.
        model: Model of the profile.
        positions: True if the vehicle has a position of its own.
    """
    remarks = []
    for side, (name, table) in enumerate(zip(SIDES, (model.drive, model.brake), strict=True)):
        if table is None:
            remarks.append(f"the tests do not show how it {name}s: there is no [model.{name}]")
            continue
        response, mass = estimate.responses[side], table.mass
        if table.limit is not None:
            then = "" if table.power_from is None else f", from {table.power_from:.3g} m/s on less"
            remarks.append(
                f"no more than {table.limit * mass:.0f} N of {name} force arrive, "
                f"{table.limit:.3g} m/s²{then}"
            )
        if table.rate is not None:
            remarks.append(f"its {name} force changes by {table.rate * mass:.4g} N/s at most")
        if response.second > 0.0 and response.lag**2 < 4.0 * response.second:
            frequency = 1.0 / (2.0 * np.pi * np.sqrt(response.second))
            damping = 0.5 * response.lag / np.sqrt(response.second)
            remarks.append(f"a {name} force makes it shake at {frequency:.2g} Hz, damped by "
                           f"{damping:.2g}; the controllers know only its mean")  # fmt: skip
        if response.release is not None:
            remarks.append(f"a {name} force rises with a lag of {response.lag:.2g} s and falls "
                           f"with one of {response.release:.2g} s")  # fmt: skip
        if abs(response.exponent - 1.0) > CURVED:
            half = 0.5**response.exponent
            remarks.append(f"the {name} pedal is not linear: half of it gives {100 * half:.0f} % "
                           "of the force; M is that of the full pedal")  # fmt: skip
        gaps = 1.0 - float(estimate.linear.weights[active(estimate, side)].mean())
        if gaps > GAPS:
            remarks.append(f"in {100 * gaps:.0f} % of the steps the {name} force is interrupted "
                           "or another one, as in a gearbox that shifts")  # fmt: skip
    return [*remarks, *_lateness(model, positions=positions)]


def _lateness(model: FittedModel, *, positions: bool) -> list[str]:
    late = [side.lag + side.delay for side in (model.drive, model.brake) if side is not None]
    if model.sensor_lag > 0.0:
        return [f"its speed output is {model.sensor_lag:.2g} s behind its position: a filter of "
                "the sensor, which a run allows for"]  # fmt: skip
    if max(late) <= model.time_step:
        return []
    alike = max(late) - min(late) <= model.time_step
    if alike and not positions:
        return [
            f"it responds {max(late):.2g} s late, by an actuator or a sensor: without a position "
            "of its own that is open; the controllers take it for an actuator"
        ]
    return [f"forces act {max(late):.2g} s late"] if alike else []


def resistance_remarks(estimate: Estimate, common: CommonModel) -> list[str]:
    """Remark on a constant force, and on one that grows with the speed squared.

    Args:
        estimate: Estimate of both sides.
        common: M and alpha of both sides together.
    """
    measured = estimate.measured
    speed = measured.speed[measured.used]
    resistance = estimate.linear.coefficients[2:] * common.mass
    differs = common.residual > 1.4 * estimate.linear.deviation
    if not differs or common.residual - estimate.linear.deviation < 0.005:
        return []
    fastest = float(speed.max())
    terms = [
        (float(factor), size, unit)
        for factor, size, unit in zip(
            resistance, (1.0, fastest, fastest**2), ("N", "N.s/m v", "N.s²/m² v²"), strict=True
        )
    ]
    most = max(abs(factor) * size for factor, size, _ in terms)
    if all(
        abs(factor) * size < OTHER * most for factor, size, unit in terms if not unit.endswith(" v")
    ):
        return []
    words = " + ".join(
        f"{factor:.3g} {unit}" for factor, size, unit in terms if abs(factor) * size > 0.02 * most
    )
    return [f"its resistance is not alpha v: {words} fits better"]


def side_remarks(model: FittedModel, profile: VehicleProfile | None) -> list[str]:
    """Return remarks on the differences of the two sides, one line each.

    Args:
        model: Model with both sides.
        profile: Profile of the vehicle, for the line to change in it.
    """
    drive, brake = model.drive, model.brake
    if drive is None or brake is None:
        return []
    remarks = []
    late = [side.lag + side.delay for side in (drive, brake)]
    if abs(late[0] - late[1]) > model.time_step:
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
