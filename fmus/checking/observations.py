"""What the drives of a check show: each function is one test of the traces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fmus.checking.findings import Finding
from fmus.checking.fitting import STANDSTILL, fit, prepare
from fmus.checking.prediction import position_errors
from fmus.checking.saturation import saturation
from fmus.profile import Axis

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from fmus.checking.fitting import Fit
    from fmus.checking.manoeuvres import Trace
    from fmus.profile import VehicleProfile

MOVES = 0.02  # [m/s] a change that is one
CREEPS = 0.1  # [m/s] against the way it should go
START_TOLERANCE = 0.05  # [m/s]
RATIO_TOLERANCE = 0.02  # of a factor between two quantities that should be the same
MASS_TOLERANCE = 0.05  # of the controller's M
POSITION_TOLERANCE = 0.1  # [m] at the horizon of the controller
NO_VEHICLE = 0.3  # of R squared: below, M and alpha say nothing
LATE = 2.0  # steps of lag and dead time that are worth a warning

_SPEED_UNITS = (("km/h", 3.6), ("mph", 1 / 0.44704), ("kn", 3600 / 1852), ("ft/s", 1 / 0.3048))
_LENGTH_UNITS = (("km", 1e-3), ("mm", 1e3), ("cm", 1e2), ("ft", 1 / 0.3048), ("mi", 1 / 1609.344))
_ACCELERATION_UNITS = (("g", 1 / 9.80665), ("km/h/s", 3.6), ("cm/s2", 1e2), ("ft/s2", 1 / 0.3048))


@dataclass(frozen=True)
class Expected:
    """What the run will assume of the vehicle.

    Attributes:
        mass: M of the controller's model [kg].
        friction: alpha of it [N.s/m].
        horizon: of the MPC [steps].
        start_speed: of the run [m/s].
        force: of the manoeuvres [N].
        largest_force: u_max [N].
        profile: of the vehicle; None: the FMU is ours.
    """

    mass: float
    friction: float
    horizon: int
    start_speed: float
    force: float
    largest_force: float
    profile: VehicleProfile | None

    @property
    def role(self) -> str:
        """The first input that the profile wires."""
        inputs = self.profile.inputs if self.profile else None
        return next((name for name, axis in inputs or () if isinstance(axis, Axis)), "force")

    @property
    def braking_role(self) -> str:
        """The input that brakes."""
        return {"drive_force": "brake_force", "throttle": "brake"}.get(self.role, self.role)


def start_speed(rolling: Trace, expected: Expected) -> Finding:
    """Is the vehicle as fast at the start as it was asked to be?"""
    name, wanted, got = "start speed", expected.start_speed, float(rolling.speed[0])
    if abs(got - wanted) <= START_TOLERANCE:
        return Finding(name, "pass", f"{got:.3f} m/s, as asked")
    unit = _unit(got / wanted if wanted else np.nan, _SPEED_UNITS)
    if unit:
        return Finding(
            name, "fail", f"asked for {wanted:g} m/s it says {got:.4g} m/s: that is in {unit}",
            f'set `unit = "{unit}"` in [outputs.speed]',
        )  # fmt: skip
    return Finding(
        name, "fail", f"asked for {wanted:g} m/s it starts at {got:.4g} m/s",
        "name its parameter for it in [initial.speed]; without that table it drives up to it",
    )  # fmt: skip


def reproducible(one: Trace, other: Trace) -> Finding:
    """Do two fresh instances do the same, bit for bit?"""
    name = "reproducible"
    if one.same_motion(other):
        return Finding(name, "pass", "two runs, the same bits")
    apart = float(np.abs(one.speed - other.speed).max())
    return Finding(
        name, "warn", f"two runs with the same forces differ by up to {apart:.2g} m/s",
        "results of giveway will differ from run to run; give the FMU's noise a fixed seed",
    )  # fmt: skip


def idles(idle: Trace) -> Finding:
    """Does it stay where it is when nothing pushes?"""
    name, fastest = "stands still", float(idle.speed[np.argmax(np.abs(idle.speed))])
    if abs(fastest) <= MOVES:
        return Finding(name, "pass", "no force, no motion")
    if fastest < -MOVES:
        return Finding(
            name, "fail", f"without force it goes backwards ({fastest:.3g} m/s)",
            "a spring, or a slope? A vehicle stands still: see the start values under [parameters]",
        )  # fmt: skip
    return Finding(
        name, "warn", f"without force it creeps to {fastest:.3g} m/s",
        "as an automatic gearbox does; the controllers have to brake against it",
    )  # fmt: skip


def drives(response: Trace, expected: Expected) -> Finding:
    """Does a force forwards drive it forwards?"""
    name = "drives"
    driven = response.force > 0.0
    end = int(np.flatnonzero(driven)[-1]) + 1
    gained = float(response.speed[end] - response.speed[0])
    seconds = end * response.step_size
    text = f"{seconds:g} s of {response.force[0]:.4g} N: {gained:+.4g} m/s"
    if gained > MOVES:
        return Finding(name, "pass", text)
    if gained < -MOVES:
        return Finding(
            name, "fail", f"{text}: it goes the wrong way",
            f"set `gain = -1.0` in [inputs.{expected.role}] (or in [outputs.speed])",
        )  # fmt: skip
    return Finding(
        name, "fail", f"{text}: it does not move",
        f"is [inputs.{expected.role}] the right variable? A gear, ignition or hand brake may have "
        "to be set under [parameters]",
    )  # fmt: skip


def brakes(rolling: Trace, expected: Expected) -> Finding:
    """Does a force backwards slow it down, and hold it in the end?"""
    name = "brakes"
    first = int(np.flatnonzero(rolling.force < 0.0)[0])
    before, slowest = float(rolling.speed[first]), float(rolling.speed[first:].min())
    halfway = float(rolling.speed[min(first + round(0.5 / rolling.step_size), len(rolling.force))])
    text = f"from {before:.3g} m/s with {expected.force:.0f} N to {slowest:.3g} m/s"
    role = expected.braking_role
    if halfway > before + MOVES:
        return Finding(
            name, "fail", f"{text}: braking makes it faster ({halfway:.3g} m/s)",
            f"set `gain = -1.0` in [inputs.{role}]",
        )  # fmt: skip
    if slowest > before - MOVES:
        return Finding(
            name,
            "fail",
            f"{text}: it does not slow down",
            f"is [inputs.{role}] the right variable?",
        )
    if slowest < -CREEPS:
        return Finding(
            name, "fail" if role in ("brake", "brake_force") else "warn",
            f"{text}: held on, the brakes drive it backwards",
            "brakes hold a standing vehicle; let the FMU keep speed 0 there",
        )  # fmt: skip
    return Finding(name, "pass", text)


def coasts(response: Trace, expected: Expected) -> Finding:
    """Does it roll out, slower and slower, without any force?"""
    name = "coasts"
    edges = np.flatnonzero(np.diff(response.force)) + 1
    begin, end = int(edges[0]), int(edges[1])
    # What still acts of the drive force fades in the first half.
    before, after = float(response.speed[(begin + end) // 2]), float(response.speed[end])
    seconds = 0.5 * (end - begin) * response.step_size
    text = f"{seconds:g} s without force: {before:.3g} to {after:.3g} m/s"
    if after < -CREEPS:
        return Finding(name, "fail", f"{text}: it turns round like a spring", "this is no vehicle")
    if after > before + CREEPS:
        return Finding(
            name, "warn", f"{text}: it gets faster",
            f"zero force may not be zero of [inputs.{expected.role}]: see its `offset`",
        )  # fmt: skip
    return Finding(name, "pass", text)


def position_follows_speed(response: Trace, expected: Expected) -> Finding:
    """Is the speed what the position does per second?"""
    name = "speed and position"
    if expected.profile and expected.profile.outputs.position is None:
        return Finding(name, "skip", "no position among the outputs: the speed is integrated")
    way = np.cumsum(0.5 * (response.speed[1:] + response.speed[:-1])) * response.step_size
    moved = response.position[1:] - response.position[0]
    ratio, misfit = _ratio(way, moved)
    if not np.isfinite(ratio) or (ratio == 0.0 and misfit == 0.0):
        return Finding(name, "skip" if not np.any(way) else "fail", "the position does not move")
    if misfit > 0.05:
        return Finding(
            name, "fail", f"the position is not the way driven (off by {100 * misfit:.0f} %)",
            "is [outputs.position] the right variable? Without that table the speed is integrated",
        )  # fmt: skip
    text = f"the position moves {ratio:.4g} m per metre that the speed accounts for"
    if abs(ratio - 1.0) <= RATIO_TOLERANCE:
        return Finding(name, "pass", text)
    return Finding(name, "fail", *_way_remedy(text, ratio))


def _way_remedy(text: str, ratio: float) -> tuple[str, str]:
    if abs(ratio + 1.0) <= RATIO_TOLERANCE:
        return text, "set `gain = -1.0` in [outputs.position]"
    for unit, factor in _SPEED_UNITS:
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
    unit = _unit(ratio, _LENGTH_UNITS)
    if unit:
        return (
            f"{text}: the position seems to be in {unit}",
            f'set `unit = "{unit}"` in [outputs.position]',
        )
    return text, f"set `gain = {1.0 / ratio:.6g}` in [outputs.position], or the right unit there"


def acceleration_follows_speed(response: Trace, expected: Expected) -> Finding:
    """Is the acceleration what the speed does per second?"""
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
        return Finding(name, "fail", text, "set `gain = -1.0` in [outputs.acceleration]")
    unit = _unit(ratio, _ACCELERATION_UNITS)
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
    """The factor from the speed's slope to the acceleration, and the misfit.

    Some FMUs give the mean over the step, others the value at its end: whichever fits better.
    """
    v, h = response.speed, response.step_size
    changes = np.flatnonzero(np.diff(response.force)) + 1
    near = np.abs(np.arange(1, v.size - 1)[:, None] - changes).min(axis=1, initial=v.size)
    around = np.stack((v[:-2], v[1:-1], v[2:]))
    stops = (around.min(axis=0) <= STANDSTILL) & (around.max(axis=0) > STANDSTILL)
    calm = (near > 1) & ~stops
    measured = response.acceleration[1:-1][calm]
    slopes = ((v[1:-1] - v[:-2]) / h, (v[2:] - v[:-2]) / (2.0 * h))
    return min((_ratio(slope[calm], measured) for slope in slopes), key=lambda found: found[1])


def quick_fit(traces: Sequence[Trace]) -> Fit | None:
    """M, alpha and the actuator from the drives of a check."""
    return fit([prepare(trace) for trace in traces])


def matches_model(model: Fit | None, response: Trace, expected: Expected) -> Finding:
    """Do the controller's M and alpha describe this vehicle?"""
    name = "controller's model"
    if model is None or model.r_squared < NO_VEHICLE:
        how = "" if model is None else f" (R² = {model.r_squared:.2f})"
        return Finding(
            name, "fail", f"M v' + alpha v = u does not describe how it moves{how}",
            "is this a vehicle driven by the input that the profile names?",
        )  # fmt: skip
    errors = position_errors(response, expected.mass, expected.friction, expected.horizon)
    off = float(np.quantile(errors, 0.95)) if errors.size else 0.0
    seconds = expected.horizon * response.step_size
    text = (
        f"M = {model.mass:.5g} kg, alpha = {model.friction:.4g} N.s/m; the controller's: "
        f"{expected.mass:g}, {expected.friction:g}: its prediction is off by {_small(off)} m "
        f"after {seconds:g} s"
    )
    ratio = model.mass / expected.mass
    if abs(ratio * 1000.0 - 1.0) < 0.3:
        return Finding(
            name, "fail", f"{text}: 1000 times too strong, the force seems to be in kN",
            f'set `unit = "kN"` in [inputs.{expected.role}]',
        )  # fmt: skip
    if abs(ratio - 1.0) <= MASS_TOLERANCE and off <= POSITION_TOLERANCE:
        return Finding(name, "pass", text)
    return Finding(
        name, "warn", text, "'giveway fmu identify' writes its own M and alpha into the profile"
    )


def actuator_limits(model: Fit | None, full: Trace, rolling: Trace, expected: Expected) -> Finding:
    """Do the largest forces of the controller arrive?"""
    name = "force limits"
    if model is None:
        return Finding(name, "skip", "not to be said without a model")
    drive, brake = (
        saturation([trace], sign, model) for trace, sign in ((full, 1.0), (rolling, -1.0))
    )
    lowest = min(drive, brake)
    if not np.isfinite(lowest):
        return Finding(name, "pass", f"{expected.largest_force:.0f} N drive as they should")
    which = "drive" if drive <= brake else "brake"
    return Finding(
        name, "warn", f"no more than {lowest:.0f} N of {which} force arrive",
        f"run it with --force-limit {lowest:.0f} or less",
    )  # fmt: skip


def actuator_lag(model: Fit | None, step: float) -> Finding:
    """How late do forces act?"""
    name = "actuator lag"
    if model is None:
        return Finding(name, "skip", "not to be said without a model")
    late = model.lag + model.delay
    if late <= 0.0:
        return Finding(name, "pass", "forces act at once")
    text = f"forces act {late:.2g} s late (lag {model.lag:.2g} s, dead time {model.delay:.2g} s)"
    if late <= LATE * step:
        return Finding(name, "pass", text)
    return Finding(
        name, "warn", text,
        "'giveway fmu identify' measures what that costs, and the run keeps more distance",
    )  # fmt: skip


def pace(response: Trace) -> Finding:
    """What does a step cost?"""
    name, cost = "time per step", 1e6 * response.cost
    text = f"{np.median(cost):.0f} us (median), {np.quantile(cost, 0.95):.0f} us (95 %)"
    if np.median(response.cost) <= response.step_size:
        return Finding(name, "pass", text)
    return Finding(name, "warn", f"{text}: slower than real time", "runs with it will take long")


def warnings(traces: Mapping[str, Trace]) -> Finding:
    """What the guards remarked on the way."""
    seen = list(dict.fromkeys(text for trace in traces.values() for text in trace.warnings))
    if not seen:
        return Finding("warnings", "pass", "none")
    more = f" (and {len(seen) - 1} more)" if len(seen) > 1 else ""
    return Finding("warnings", "warn", f"{seen[0]}{more}")


def _ratio(x: NDArray[np.float64], y: NDArray[np.float64]) -> tuple[float, float]:
    """The factor from x to y by least squares, and the largest misfit relative to y's largest."""
    power = float(x @ x)
    if power == 0.0:
        return np.nan, 0.0
    ratio = float(x @ y) / power
    largest = float(np.abs(y).max())
    return ratio, float(np.abs(y - ratio * x).max()) / largest if largest else 0.0


def _unit(ratio: float, units: tuple[tuple[str, float], ...]) -> str:
    """The unit whose numbers are ``ratio`` times those of SI; empty if none is."""
    return next((u for u, f in units if abs(ratio / f - 1.0) <= RATIO_TOLERANCE), "")


def _small(value: float) -> str:
    """Two digits, and what is mere rounding as 0."""
    return f"{value:.2g}" if value > 1e-9 else "0"
