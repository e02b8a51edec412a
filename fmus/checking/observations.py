"""The tests of a check that look at traces. Each function returns what was seen as one finding."""

from collections.abc import Mapping
from typing import Final

import numpy as np
from numpy.typing import NDArray

from fmus.checking.expected import Expected
from fmus.checking.findings import Finding
from fmus.checking.manoeuvres import Trace
from fmus.checking.model_fit.measurements import STANDSTILL
from fmus.profile.vehicle_profile import FittedModel

MOVES: Final = 0.02  # [m/s] change of speed above which the vehicle moves
CREEPS: Final = 0.1  # [m/s] tolerated speed in the wrong direction
START_TOLERANCE: Final = 0.05  # largest error of the start speed [m/s]
MASS_TOLERANCE: Final = 0.05  # largest relative error of the controller's M
RATIO_TOLERANCE: Final = 0.02  # largest relative error of the way by the speed
MISFIT: Final = 0.05  # largest deviation from a constant ratio, relative to the largest value
NO_VEHICLE: Final = 0.3  # R squared below which M and alpha say nothing
HARD: Final = 7.5  # [m/s2] limit above which a car is not thought weaker than told
LATE: Final = 2.0  # steps of lag and dead time from which on a warning is given
FILTERS: Final = tuple(0.05 * n for n in range(1, 31))  # [s] time constants that are tried
IDENTIFY: Final = "'giveway fmu identify' writes its own model into the profile"


def start_speed(rolling: Trace, expected: Expected) -> Finding:
    """Test whether the vehicle starts with the commanded speed."""
    name, wanted, got = "start speed", expected.start_speed, float(rolling.speed[0])
    if abs(got - wanted) <= START_TOLERANCE:
        return Finding(name, "pass", f"{got:.3f} m/s, as asked")
    return Finding(name, "fail", f"asked for {wanted:g} m/s it starts at {got:.4g} m/s")


def reproducible(one: Trace, other: Trace) -> Finding:
    """Test whether two new instances do the same, bit by bit."""
    name = "reproducible"
    if one.same_motion(other):
        return Finding(name, "pass", "two runs, the same bits")
    apart = float(np.abs(one.speed - other.speed).max())
    return Finding(
        name, "warn", f"two runs with the same forces differ by up to {apart:.2g} m/s",
        "results of giveway will differ from run to run; give the FMU's noise a fixed seed",
    )  # fmt: skip


def idles(idle: Trace) -> Finding:
    """Test whether the vehicle stays at its place without a force."""
    name, fastest = "stands still", float(idle.speed[np.argmax(np.abs(idle.speed))])
    if abs(fastest) <= MOVES:
        return Finding(name, "pass", "no force, no motion")
    if fastest < -MOVES:
        return Finding(name, "fail", f"without force it goes backwards ({fastest:.3g} m/s)")
    return Finding(
        name, "warn", f"without force it creeps to {fastest:.3g} m/s",
        "as an automatic gearbox does",
    )  # fmt: skip


def holds(rolling: Trace, braking_role: str) -> Finding:
    """Test whether brakes that are held on stop a vehicle and let it stand."""
    name, slowest = "brakes hold", float(rolling.speed.min())
    last = rolling.speed[-1 - round(1.0 / rolling.step_size) :]
    if last.min() > STANDSTILL and last[0] - last[-1] < STANDSTILL:
        return Finding(name, "fail", f"held on, they do not stop it: {last[-1]:.3g} m/s is left")
    if slowest >= -CREEPS:
        return Finding(name, "pass", f"held on, they slow it down to {slowest:.3g} m/s")
    return Finding(
        name, "fail" if braking_role in ("brake", "brake_force") else "warn",
        f"held on, the brakes drive it backwards, with {-slowest:.3g} m/s",
    )  # fmt: skip


def coasts(response: Trace) -> Finding:
    """Test whether the vehicle rolls ever more slowly without a force."""
    name = "coasts"
    edges = np.flatnonzero(np.diff(response.force)) + 1
    begin, end = int(edges[0]), int(edges[1])
    # In the first two thirds the drive force may still fade.
    before, after = float(response.speed[(begin + 2 * end) // 3]), float(response.speed[end])
    seconds = (end - (begin + 2 * end) // 3) * response.step_size
    text = f"{seconds:g} s without force: {before:.3g} to {after:.3g} m/s"
    if after < -CREEPS:
        return Finding(name, "fail", f"{text}: it turns round like a spring")
    if after > before + CREEPS:
        return Finding(name, "warn", f"{text}: it gets faster; is zero force its zero?")
    return Finding(name, "pass", text)


def described(model: FittedModel, expected: Expected, step: float) -> Finding:
    """Test whether M and alpha describe this vehicle, and whether they are the controller's."""
    name = "controller's model"
    if model.r_squared < NO_VEHICLE:
        how = f"does not describe how it moves (R² = {model.r_squared:.2f})"
        return Finding(name, "fail", f"M v' + alpha v = u {how}")
    late = model.lag + model.delay
    text = f"M = {model.mass:.5g} kg, alpha = {model.friction:.4g} N.s/m"
    if late > 0.0:
        text += f"; forces act {late:.2g} s late (lag {model.lag:.2g}, dead time {model.delay:.2g})"
    sides = (("drive", model.drive), ("brake", model.brake))
    for which, side in sides:
        if side is not None and side.limit is not None:
            text += f"; no more than {side.limit * side.mass:.0f} N of {which} force arrive"
    limited = any(side and side.limit and side.limit < HARD for _, side in sides)
    plain = late <= LATE * step and not limited
    if abs(model.mass / expected.mass - 1.0) <= MASS_TOLERANCE and (expected.identified or plain):
        return Finding(name, "pass", text)
    return Finding(name, "warn", f"{text}; the controller's: {expected.mass:g} kg", IDENTIFY)


def position_follows_speed(response: Trace, expected: Expected) -> Finding:
    """Test whether the speed is the rate of change of the position."""
    name = "speed and position"
    if expected.profile and expected.profile.outputs.position is None:
        return Finding(name, "skip", "no position among the outputs: the speed is integrated")
    way = np.cumsum(0.5 * (response.speed[1:] + response.speed[:-1])) * response.step_size
    ratio, misfit = _ratio(way, response.position[1:] - response.position[0])
    if not np.isfinite(ratio) or (ratio == 0.0 and misfit == 0.0):
        return Finding(name, "skip" if not np.any(way) else "fail", "the position does not move")
    if misfit <= MISFIT:
        right = abs(ratio - 1.0) <= RATIO_TOLERANCE
        text = f"the position moves {ratio:.4g} m per metre that the speed accounts for"
        return Finding(name, "pass" if right else "fail", text)
    late = _filtered(response)
    if late is None:
        off = f"off by {100 * misfit:.0f} %"
        return Finding(name, "fail", f"the position is not the way driven ({off})")
    return Finding(
        name, "warn", f"the speed follows the position's rate {late:.2g} s late: filtered",
        "'giveway fmu identify' measures it as `sensor_lag`",
    )  # fmt: skip


def _filtered(response: Trace) -> float | None:
    """Return the time constant [s] of a filter that makes the speed of the position, or None."""
    h = response.step_size
    best: tuple[float, float | None] = (MISFIT, None)
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


def acceleration_follows_speed(response: Trace, expected: Expected) -> Finding:
    """Test whether the acceleration is the rate of change of the speed."""
    name = "acceleration"
    if expected.profile and expected.profile.outputs.acceleration is None:
        return Finding(name, "skip", "not among the outputs: the speed's difference is taken")
    ratio, misfit = _acceleration_ratio(response)
    if not np.isfinite(ratio):
        return Finding(name, "skip", "the speed does not change")
    text = f"{ratio:.4g} times what the speed does per second"
    if misfit > 0.1:
        return Finding(name, "warn", f"{text}, and not always; it may be left out")
    return Finding(name, "pass" if abs(ratio - 1.0) <= 0.05 else "fail", text)


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


def time_per_step(response: Trace) -> Finding:
    """Measure how long a step takes."""
    name, cost = "time per step", 1e6 * response.cost
    text = f"{np.median(cost):.0f} us (median), {np.quantile(cost, 0.95):.0f} us (95 %)"
    if np.median(response.cost) <= response.step_size:
        return Finding(name, "pass", text)
    return Finding(name, "warn", f"{text}: slower than real time", "runs with it will take long")


def warnings(traces: Mapping[str, Trace]) -> Finding:
    """Report the warnings of the guards."""
    seen = list(dict.fromkeys(text for trace in traces.values() for text in trace.warnings))
    if not seen:
        return Finding("warnings", "pass", "none")
    more = f" (and {len(seen) - 1} more)" if len(seen) > 1 else ""
    return Finding("warnings", "warn", f"{seen[0]}{more}")
