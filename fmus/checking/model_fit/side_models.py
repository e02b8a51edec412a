"""The estimate as tables of the profile: one for driving, one for braking."""

from __future__ import annotations

import numpy as np

from fmus.checking.model_fit.estimation import Estimate
from fmus.checking.model_fit.side_response import Array
from fmus.profile.vehicle_profile import SideModel

SIDES = ("drive", "brake")
HEAVIEST = 1e6  # [kg] largest M that counts
FASTEST = 60.0  # [m/s] highest speed from which a limit of power is told
NEARLY = 0.95  # share of the largest command from which a limit is none
QUICK = 2  # Number of steps in which a force rises that has no limit of its rate
ENOUGH = 20  # Number of steps needed for a side
ACTIVE = 0.05  # share of the largest force from which a step tells something about a side
STRAYS = 0.5  # share of a side's steps that do not follow its model, from which the fit is poor
EXPLAINED = 0.8  # share of the variation of a side's accelerations below which the fit is poor


def active(estimate: Estimate, side: int) -> Array:
    """Return flags (m,) of the steps in which a side's force acts."""
    force = np.abs(estimate.linear.rows[:, side])
    return np.asarray(force > ACTIVE * max(float(force.max()), 1e-12))


def side_model(
    estimate: Estimate, side: int, sensor: float = 0.0, *, pressed: bool = False
) -> SideModel | None:
    """Return the table of a side, or None if the tests do not determine it.

    Two lags in a row are a lag, the longer one, and a dead time, the shorter one.

    Args:
        estimate: Estimate of both sides.
        side: Side: 0 is driving, 1 is braking.
        sensor: Lag [s] of the speed output, which is not one of the actuator.
        pressed: True if the tests have pressed the side's pedal fully: that is its limit.
    """
    mass, response = estimate.mass(side), estimate.responses[side]
    if not mass < HEAVIEST or active(estimate, side).sum() < ENOUGH:
        return None
    lag, delay = response.lag, response.delay
    root = lag**2 - 4.0 * response.second
    if response.second > 0.0 and root > 0.0:
        longer = 0.5 * (lag + float(np.sqrt(root)))
        lag, delay = longer, delay + lag - longer
    gone = min(lag, sensor)
    lag, delay = lag - gone, max(delay - (sensor - gone), 0.0)
    top = float(estimate.measured.commands[side].max())
    limit = response.limit if response.limit < NEARLY * top else np.inf
    if pressed:
        limit = min(response.limit, top)
    fastest = estimate.measured.largest / (QUICK * estimate.measured.step)
    power = response.power / limit if np.isfinite(limit) else np.inf
    return SideModel(
        mass=mass,
        lag=min(lag, 3.0),
        delay=min(delay, 2.0),
        limit=limit / mass if np.isfinite(limit) else None,
        power_from=power if power < FASTEST else None,
        rate=response.rate / mass if response.rate < fastest else None,
    )


def poverty(estimate: Estimate) -> list[str]:
    """Return the reasons why the estimate describes a side poorly, one clause each."""
    reasons = []
    for side, name in enumerate(SIDES):
        here = active(estimate, side)
        if here.sum() < ENOUGH:
            continue
        weights, left = estimate.linear.weights[here], estimate.linear.residual[here]
        strays = 1.0 - float(weights.mean())
        measured = estimate.measured.acceleration[here]
        spread = float(measured.var()) or 1.0
        explained = 1.0 - float(weights @ left**2 / max(weights.sum(), 1e-9)) / spread
        if strays > STRAYS:
            reasons.append(f"{100.0 * strays:.0f} % of its steps with a {name} force do not follow")
        elif explained < EXPLAINED:
            reasons.append(f"of its motion with a {name} force {100.0 * explained:.0f} % follow")
    return reasons
