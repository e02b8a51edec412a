"""The tests of a check. Each function examines traces and returns one finding."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from fmus.checking.consistency import SPEED_UNITS, unit_of
from fmus.checking.expected import Expected
from fmus.checking.findings import Finding
from fmus.checking.identification import modelled
from fmus.checking.manoeuvres import Trace
from fmus.checking.model_fit.prediction import position_errors
from fmus.checking.scale import GROSS, gross_error
from fmus.errors import FmuOutputError
from fmus.profile.advice import gain_line
from fmus.profile.vehicle_profile import FittedModel, VehicleProfile

MOVES = 0.02  # [m/s] change of speed above which the vehicle moves
CREEPS = 0.1  # [m/s] tolerated speed in the wrong direction
START_TOLERANCE = 0.05  # Largest error of the start speed [m/s]
MASS_TOLERANCE = 0.05  # Largest relative error of the controller's M
POSITION_TOLERANCE = 0.1  # [m] tolerance at the controller's horizon
NO_VEHICLE = 0.3  # R squared below which M and alpha say nothing
WEAK = 2.0  # [m/s2] deceleration below which a force limit hardly fits the vehicle
FIRM = 6.0  # [m/s2] hard braking of a loaded truck on a dry road
LATE = 2.0  # steps of lag and dead time from which on a warning is given


def start_speed(rolling: Trace, expected: Expected) -> Finding:
    """Test whether the vehicle starts with the commanded speed."""
    name, wanted, got = "start speed", expected.start_speed, float(rolling.speed[0])
    if abs(got - wanted) <= START_TOLERANCE:
        return Finding(name, "pass", f"{got:.3f} m/s, as asked")
    unit = unit_of(got / wanted if wanted else np.nan, SPEED_UNITS)
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
        return Finding(
            name, "fail", f"without force it goes backwards ({fastest:.3g} m/s)",
            "a spring, or a slope? A vehicle stands still: see the start values under [parameters]",
        )  # fmt: skip
    return Finding(
        name, "warn", f"without force it creeps to {fastest:.3g} m/s",
        "as an automatic gearbox does; the controllers have to brake against it",
    )  # fmt: skip


def drives(response: Trace, expected: Expected) -> Finding:
    """Test whether a forward force drives the vehicle forwards."""
    name = "drives"
    end = int(np.flatnonzero(response.force > 0.0)[-1]) + 1
    gained = float(response.speed[end] - response.speed[0])
    seconds = end * response.step_size
    text = f"{seconds:g} s of {response.force[0]:.4g} N: {gained:+.4g} m/s"
    if gained > MOVES:
        return Finding(name, "pass", text)
    if gained < -MOVES:
        return Finding(
            name, "fail", f"{text}: it goes the wrong way",
            f"set {gain_line(expected.profile, 'inputs', expected.role, -1.0)} "
            "(or in [outputs.speed])",
        )  # fmt: skip
    return Finding(
        name, "fail", f"{text}: it does not move",
        f"is [inputs.{expected.role}] the right variable? A gear, ignition or hand brake may have "
        "to be set under [parameters]",
    )  # fmt: skip


def brakes(rolling: Trace, expected: Expected) -> Finding:
    """Test whether a backward force slows the vehicle down and finally holds it."""
    name = "brakes"
    first = int(np.flatnonzero(rolling.force < 0.0)[0])
    before, slowest = float(rolling.speed[first]), float(rolling.speed[first:].min())
    halfway = float(rolling.speed[min(first + round(0.5 / rolling.step_size), len(rolling.force))])
    text = f"from {before:.3g} m/s with {expected.force:.0f} N to {slowest:.3g} m/s"
    role = expected.braking_role
    if halfway > before + MOVES:
        return Finding(
            name, "fail", f"{text}: braking makes it faster ({halfway:.3g} m/s)",
            f"set {gain_line(expected.profile, 'inputs', role, -1.0)}",
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
    """Test whether the vehicle rolls ever more slowly without a force."""
    name = "coasts"
    edges = np.flatnonzero(np.diff(response.force)) + 1
    begin, end = int(edges[0]), int(edges[1])
    # In the first half the drive force may still fade.
    before, after = float(response.speed[(begin + end) // 2]), float(response.speed[end])
    seconds = 0.5 * (end - begin) * response.step_size
    text = f"{seconds:g} s without force: {before:.3g} to {after:.3g} m/s"
    if after < -CREEPS:
        return Finding(
            name, "fail", f"{text}: it turns round like a spring", "this is not a vehicle"
        )
    if after > before + CREEPS:
        return Finding(
            name, "warn", f"{text}: it gets faster",
            f"zero force may not be zero of [inputs.{expected.role}]: see its `offset`",
        )  # fmt: skip
    return Finding(name, "pass", text)


def quick_fit(traces: Sequence[Trace], profile: VehicleProfile | None = None) -> FittedModel | None:
    """Return the coarse model of the drives of a check, or None if forces do not move it."""
    try:
        return modelled(traces, traces[0], 1, Path(), profile, coarse=True).model
    except FmuOutputError:
        return None


def matches_model(model: FittedModel | None, response: Trace, expected: Expected) -> Finding:
    """Test whether the controller's M and alpha describe this vehicle."""
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
    lead = _missing_lead(model.mass, response.step_size, expected)
    for weight in expected.known:
        gross = gross_error(model.mass, weight, expected.role, _speed_unit(expected))
        if gross is not None:
            remedy = gross[1] if lead is None else _lead_remedy(lead)
            return Finding(name, "fail", f"{text}: {gross[0]}", remedy)
    if abs(ratio * 1000.0 - 1.0) < 0.3:
        return Finding(
            name, "fail", f"{text}: 1000 times too strong, the force seems to be in kN",
            f'set `unit = "kN"` in [inputs.{expected.role}]',
        )  # fmt: skip
    known = 0.0 if expected.identified is None else 1.5 * expected.identified.position_error
    if abs(ratio - 1.0) <= MASS_TOLERANCE and off <= max(POSITION_TOLERANCE, known):
        return Finding(name, "pass", text)
    if lead is not None:
        return Finding(name, "warn", text, _lead_remedy(lead))
    identify = "'giveway fmu identify' writes its own M and alpha into the profile"
    if not expected.known and not 1.0 / GROSS < ratio < GROSS:
        return Finding(
            name, "ask", f"{text}: does it weigh {model.mass:.3g} kg?",
            f"if so, {identify}; else a unit is wrong: 'giveway fmu check --mass' with what it "
            "weighs [kg], or --ego-class, says which",
        )  # fmt: skip
    return Finding(name, "warn", text, identify)


def _lead_remedy(lead: float) -> str:
    return (
        f"it takes about {lead:.2g} s to its set-point: write `lead = {lead:.2g}` in "
        "[inputs.speed_setpoint], and it answers as the controller thinks"
    )


def _speed_unit(expected: Expected) -> str:
    """Return the unit that the profile gives to the speed, or "" if the FMU's own counts."""
    return (expected.profile.outputs.speed.unit or "") if expected.profile else ""


def _missing_lead(mass: float, step: float, expected: Expected) -> float | None:
    """Return the time constant [s] that a speed controller's profile lacks, or None.

    With a lead T of one step, v' = (v_set - v) / tau = T / tau (u - alpha v) / M. Therefore the
    vehicle seems tau / T times as heavy as M of the inverse map.
    """
    setpoint = expected.profile.inputs.speed_setpoint if expected.profile else None
    if setpoint is None or setpoint.lead is not None or expected.profile is None:
        return None
    lead = step * mass / expected.profile.inverse_map.mass
    return lead if lead >= LATE * step else None


def actuator_limits(
    model: FittedModel | None, response: Trace, full: Trace, rolling: Trace, expected: Expected
) -> Finding:
    """Test whether the controller's largest forces arrive and suffice."""
    name, largest = "force limits", expected.largest_force
    if model is None:
        return Finding(name, "skip", "not to be said without a model")
    known = quick_fit([full, response, rolling], expected.profile) or model
    sides = (("drive", known.drive), ("brake", known.brake))
    limits = [(side.limit * side.mass, name) for name, side in sides if side and side.limit]
    if not limits:
        hardest = largest / known.mass
        lagging = _missing_lead(known.mass, response.step_size, expected) is not None
        if hardest >= WEAK or lagging:  # a lead is missing then
            return Finding(name, "pass", f"{largest:.0f} N drive as they should")
        enough = float(f"{FIRM * known.mass:.1g}")
        return Finding(
            name, "warn", f"{largest:.0f} N brake it with {hardest:.2g} m/s² at most",
            f"check and identify it with --force-limit {enough:.0f}, run it with "
            f"--vehicle-force-limit {enough:.0f}",
        )  # fmt: skip
    lowest, which = min(limits)
    return Finding(
        name, "warn", f"no more than {lowest:.0f} N of {which} force arrive",
        f"run it with --vehicle-force-limit {lowest:.0f} or less",
    )  # fmt: skip


def actuator_lag(model: FittedModel | None, step: float, expected: Expected) -> Finding:
    """Test whether forces act late."""
    name = "actuator lag"
    if model is None:
        return Finding(name, "skip", "not to be said without a model")
    late = model.lag + model.delay
    if late <= 0.0:
        return Finding(name, "pass", "forces act at once")
    text = f"forces act {late:.2g} s late (lag {model.lag:.2g} s, dead time {model.delay:.2g} s)"
    if late <= LATE * step or expected.identified is not None:
        return Finding(name, "pass", text)
    return Finding(
        name, "warn", text,
        "'giveway fmu identify' measures what that costs, and the run keeps more distance",
    )  # fmt: skip


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


def _small(value: float) -> str:
    """Return the value with two digits; mere rounding becomes 0."""
    return f"{value:.2g}" if value > 1e-9 else "0"
