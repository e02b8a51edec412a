"""Agreement of the outputs with each other; a constant factor between two is a wrong unit."""

import numpy as np
from numpy.typing import NDArray

from fmus.checking.expected import Expected
from fmus.checking.findings import Finding
from fmus.checking.manoeuvres import Trace
from fmus.checking.model_fit.measurements import STANDSTILL
from fmus.profile.advice import gain_line
from fmus.profile.vehicle_profile import VehicleProfile

RATIO_TOLERANCE = 0.02  # largest relative difference of two factors that should be the same

FILTERS = tuple(0.05 * n for n in range(1, 31))  # [s] time constants that are tried

SPEED_UNITS = (("km/h", 3.6), ("mph", 1 / 0.44704), ("kn", 3600 / 1852), ("ft/s", 1 / 0.3048))
_LENGTH_UNITS = (("km", 1e-3), ("mm", 1e3), ("cm", 1e2), ("ft", 1 / 0.3048), ("mi", 1 / 1609.344))
_ACCELERATION_UNITS = (("g", 1 / 9.80665), ("km/h/s", 3.6), ("cm/s2", 1e2), ("ft/s2", 1 / 0.3048))


def position_follows_speed(response: Trace, expected: Expected) -> Finding:
    """Test whether the speed is the rate of change of the position."""
    name = "speed and position"
    if expected.profile and expected.profile.outputs.position is None:
        return Finding(name, "skip", "no position among the outputs: the speed is integrated")
    way = np.cumsum(0.5 * (response.speed[1:] + response.speed[:-1])) * response.step_size
    ratio, misfit = _ratio(way, response.position[1:] - response.position[0])
    if not np.isfinite(ratio) or (ratio == 0.0 and misfit == 0.0):
        return Finding(name, "skip" if not np.any(way) else "fail", "the position does not move")
    if misfit > 0.05:
        late = _filtered(response)
        if late is not None:
            return Finding(
                name, "warn", f"the speed follows the position's rate {late:.2g} s late: filtered",
                "'giveway fmu identify' measures it as `sensor_lag`",
            )  # fmt: skip
        return Finding(
            name, "fail", f"the position is not the way driven (off by {100 * misfit:.0f} %)",
            "is [outputs.position] the right variable? Without that table the speed is integrated",
        )  # fmt: skip
    text = f"the position moves {ratio:.4g} m per metre that the speed accounts for"
    if abs(ratio - 1.0) <= RATIO_TOLERANCE:
        return Finding(name, "pass", text)
    return Finding(name, "fail", *_position_remedy(text, ratio, expected.profile))


def _filtered(response: Trace) -> float | None:
    """Return the time constant [s] of a filter that makes the speed of the position, or None."""
    h = response.step_size
    best: tuple[float, float | None] = (0.05, None)
    rate = np.diff(response.position) / h
    for lag in FILTERS:
        share, speed = -np.expm1(-h / lag), float(response.speed[0])
        filtered = np.empty_like(rate)
        for k, value in enumerate(rate):
            speed += share * (value - speed)
            filtered[k] = speed
        ratio, misfit = _ratio(filtered, response.speed[1:])
        if misfit < best[0] and abs(ratio - 1.0) <= RATIO_TOLERANCE:
            best = misfit, lag
    return best[1]


def _position_remedy(text: str, ratio: float, profile: VehicleProfile | None) -> tuple[str, str]:
    if abs(ratio + 1.0) <= RATIO_TOLERANCE:
        return text, f"set {gain_line(profile, 'outputs', 'position', -1.0)}"
    for unit, factor in SPEED_UNITS:
        if abs(ratio * factor - 1.0) <= RATIO_TOLERANCE:
            return (
                f"{text}: the speed seems to be in {unit}",
                f'set `unit = "{unit}"` in [outputs.speed]',
            )
        if abs(ratio / factor - 1.0) <= RATIO_TOLERANCE and unit != "ft/s":
            return (
                f"{text}: the speed seems to be in m/s, not {unit}",
                'set `unit = "m/s"` in [outputs.speed]',
            )
    unit = unit_of(ratio, _LENGTH_UNITS)
    if unit:
        return (
            f"{text}: the position seems to be in {unit}",
            f'set `unit = "{unit}"` in [outputs.position]',
        )
    line = gain_line(profile, "outputs", "position", float(f"{1.0 / ratio:.4g}"))
    return text, f"set {line}, or the right unit there"


def acceleration_follows_speed(response: Trace, expected: Expected) -> Finding:
    """Test whether the acceleration is the rate of change of the speed."""
    name = "acceleration"
    if expected.profile and expected.profile.outputs.acceleration is None:
        return Finding(name, "skip", "not among the outputs: the speed's difference is taken")
    ratio, misfit = _acceleration_ratio(response)
    text = f"{ratio:.4g} times what the speed does per second"
    if not np.isfinite(ratio):
        return Finding(name, "skip", "the speed does not change")
    if abs(ratio - 1.0) <= 0.05 and misfit <= 0.1:
        return Finding(name, "pass", text)
    if abs(ratio + 1.0) <= 0.05:
        line = gain_line(expected.profile, "outputs", "acceleration", -1.0)
        return Finding(name, "fail", text, f"set {line}")
    unit = unit_of(ratio, _ACCELERATION_UNITS)
    if unit:
        gain = 1.0 / dict(_ACCELERATION_UNITS)[unit]
        return Finding(
            name, "fail", f"{text}: it seems to be in {unit}",
            f"set `gain = {gain:.6g}` in [outputs.acceleration]",
        )  # fmt: skip
    return Finding(
        name, "warn", text, "is [outputs.acceleration] the right variable? It may be left out"
    )


def _acceleration_ratio(response: Trace) -> tuple[float, float]:
    """Return the factor from the speed's slope to the acceleration, and the misfit.

    Some FMUs give the mean over the step, others the value at its end. The better fit is used.
    """
    v, h = response.speed, response.step_size
    changes = np.flatnonzero(np.diff(response.force)) + 1
    near = np.abs(np.arange(1, v.size - 1)[:, None] - changes).min(axis=1, initial=v.size)
    around = np.stack((v[:-2], v[1:-1], v[2:]))
    stops = (around.min(axis=0) <= STANDSTILL) & (around.max(axis=0) > STANDSTILL)
    steady = (near > 1) & ~stops
    measured = response.acceleration[1:-1][steady]
    slopes = ((v[1:-1] - v[:-2]) / h, (v[2:] - v[:-2]) / (2.0 * h))
    return min((_ratio(slope[steady], measured) for slope in slopes), key=lambda found: found[1])


def _ratio(x: NDArray[np.float64], y: NDArray[np.float64]) -> tuple[float, float]:
    """Return the least-squares factor from x to y, and the misfit relative to y's largest value."""
    power = float(x @ x)
    if power == 0.0:
        return np.nan, 0.0
    ratio = float(x @ y) / power
    largest = float(np.abs(y).max())
    return ratio, float(np.abs(y - ratio * x).max()) / largest if largest else 0.0


def unit_of(ratio: float, units: tuple[tuple[str, float], ...]) -> str:
    """Return the unit whose numbers are ``ratio`` times those of SI, or an empty text."""
    return next((u for u, f in units if abs(ratio / f - 1.0) <= RATIO_TOLERANCE), "")
