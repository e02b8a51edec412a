"""Identification: step tests yield M and alpha, and how each side of a vehicle responds.

The vehicle is treated as the controller sees it: force in, position and speed out. For a vehicle
driven by an acceleration, a speed or pedals, this includes the inverse map.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import count
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fmus.checking.manoeuvres import Opener, Phase, Trace, drive
from fmus.checking.model_fit.common_model import CommonModel, fit_common
from fmus.checking.model_fit.estimation import Estimate, half_widths
from fmus.checking.model_fit.measurements import (
    SETTLING,
    STANDSTILL,
    Measurements,
    sensor_lag,
)
from fmus.checking.model_fit.prediction import (
    acting_force,
    position_errors,
    speed_errors,
    true_speed,
    unfiltered,
)
from fmus.checking.model_fit.remarks import estimate_remarks, resistance_remarks, side_remarks
from fmus.checking.model_fit.selection import identify_sides
from fmus.checking.model_fit.side_models import HEAVIEST, poverty, side_model
from fmus.errors import FmuOutputError, FmuProfileError, FmuStartError
from fmus.isolation import processes_reused
from fmus.profile.advice import gain_line
from fmus.profile.tables import Axis
from fmus.profile.vehicle_profile import FittedModel, VehicleProfile

LEVELS = (0.05, 0.12, 0.25, 0.5, 1.0)  # Shares of the largest force in the tests
SPEEDS = (0.0, 2.0, 5.0, 9.0, 14.0, 20.0)  # [m/s] speeds at the start of the tests
HARDEST = 8.0  # [m/s2] largest deceleration or acceleration of a test
LEAD_IN, DRIVE, PAUSE, BRAKE, END = SETTLING + 1.0, 1.8, 1.8, 1.5, 1.0  # [s] durations of phases
FIRST_FORCE = 200.0  # [N] smallest force that is tried
STRONGEST = 1e7  # [N] largest force that is tried
MOVING = 1.0  # [m/s] speed at which a vehicle has driven off
VALIDATION = (  # shares of the largest force, each held for HELD; none of them is in LEVELS
    0.3, 0.6, -0.2, 0.15, -0.4, 0.45, 0.8, -0.6, 0.0, 0.2, -0.15, 0.7, -0.3, 0.35, -0.8, 0.55,
    0.05, -0.1, 0.65, -0.5, 0.4, -0.05, 0.0, -0.25,
)  # fmt: skip
HELD = 0.6  # [s]
FEWEST = 20  # smallest number of steps in motion that can be fitted


class Mpc(NamedTuple):
    """The MPC for which a model is identified."""

    step_size: float  # [s] dt
    horizon: int  # [steps] N
    force_limit: float | None = None  # [N] largest force of a test; None for that of a road vehicle


@dataclass(frozen=True)
class Identification:
    """A vehicle's model, its accuracy, and the drives behind it.

    Attributes:
        model: Model for the profile.
        intervals: Half widths of the 95 % intervals of M [kg] and alpha [N.s/m].
        side_intervals: Half widths [kg] of the 95 % intervals of M of driving and of braking.
        largest_force: Largest force of the tests [N].
        common: M and alpha of both sides together.
        estimate: Estimate of both sides.
        tests: Drives that were fitted.
        validation: Drive that was not fitted.
        held_out: Measurements of this drive.
        remarks: Remarks for the user, one line each.
        poor: Reason why the model must not be used, one clause; empty if there is none.
    """

    model: FittedModel
    intervals: tuple[float, float]
    side_intervals: tuple[float, float]
    largest_force: float
    common: CommonModel
    estimate: Estimate
    tests: tuple[Trace, ...]
    validation: Trace
    held_out: Measurements
    remarks: tuple[str, ...]
    poor: str


@processes_reused()
def identify(
    opener: Opener,
    mpc: Mpc,
    *,
    path: Path,
    profile: VehicleProfile | None = None,
    speeds: Sequence[float] = SPEEDS,
    progress: Callable[[int, int], None] | None = None,
) -> Identification:
    """Find M, alpha and the response of each side of a vehicle by step tests.

    Args:
        opener: Function that opens the vehicle.
        mpc: MPC for which the model is meant.
        path: Path of the FMU, for messages.
        profile: Profile of the vehicle: it has the inverse map, and the lines for advice.
        speeds: Speeds from which the tests start [m/s].
        progress: Function that receives the numbers of drives done and of all drives.

    Raises:
        FmuOutputError: the vehicle does not respond to forces like a vehicle.
        FmuError: the FMU fails in a test.
    """
    done, total = count(), len(speeds) * len(LEVELS) + 2

    def one_more() -> None:
        if progress is not None:
            progress(next(done), total)

    one_more()
    largest = HARDEST * apparent_mass(opener, path, profile)
    if mpc.force_limit is not None:
        largest = min(largest, mpc.force_limit)
    one_more()
    starter = _Starter(opener, 0.5 * largest, max(speeds))
    tests = []
    for level in LEVELS:
        for speed in speeds:
            phases = _test(level * largest, speed, top=1.25 * max(speeds) + 1.0)
            tests.append(starter.drive(phases, speed))
            one_more()
    validation = starter.drive(_validation(0.9 * largest, max(speeds)), float(np.median(speeds)))
    one_more()
    return modelled(tests, validation, mpc.horizon, path, profile)


def modelled(
    tests: Sequence[Trace],
    validation: Trace,
    horizon: int,
    path: Path,
    profile: VehicleProfile | None = None,
    *,
    coarse: bool = False,
    sensor: float | None = None,
) -> Identification:
    """Fit the model to drives that have been recorded.

    Args:
        tests: Drives with forces of several levels.
        validation: Drive by which the model is judged.
        horizon: Horizon of the MPC [steps].
        path: Path of the FMU, for messages.
        profile: Profile of the vehicle: it has the inverse map, and the lines for advice.
        coarse: True for a quick fit with lag, dead time, and limits of force and rate only.
        sensor: Lag [s] of the speed output that is to be taken out of the speeds before the fit.

    Raises:
        FmuOutputError: the vehicle does not respond to forces like a vehicle.
    """
    h, known = validation.step_size, sensor
    sensor = sensor_lag(tests) if known is None else known
    mapped = profile and (profile.inputs.acceleration or profile.inputs.speed_setpoint)
    map_friction = profile.inverse_map.friction if profile and mapped else 0.0
    # A sensor that is half a step ahead: the vehicle does forward Euler steps.
    euler = sensor is not None and abs(sensor + 0.5 * h) < 1e-3 * h
    late = sensor if sensor is not None and sensor > 0.5 * h else 0.0
    filtered = not coarse and (sensor is None or late > 0.0)
    seen = [replace(t, speed=unfiltered(t.speed, known or 0.0, h)) for t in (*tests, validation)]
    measured, held_out, beginnings = (
        Measurements.of(traces, map_friction=map_friction, full=_full_forces(profile), euler=at,
                        filtered=filtered)
        for traces, at in ((seen[:-1], euler), (seen[-1:], euler), (seen[:-1], True))
    )  # fmt: skip
    if min(measured.acceleration.size, held_out.acceleration.size) < FEWEST:
        raise FmuOutputError(
            f"{path}: it hardly moves in the step tests; expected a vehicle that drives off; "
            "'giveway fmu check' shows what is wrong"
        )
    estimate = identify_sides(measured, coarse=coarse)
    pressed = [max(float(np.abs(trace.force).max()) for trace in tests) > full
               for full in _full_forces(profile)]  # fmt: skip
    left = late if known is None else 0.0
    sides = [side_model(estimate, side, left, pressed=pressed[side]) for side in (0, 1)]
    if left > 0.0 and any(side.lag + side.delay > h for side in sides if side is not None):
        # Both lags in one response cannot be told apart well: that of the output is known.
        return modelled(tests, validation, horizon, path, profile, coarse=coarse, sensor=late)
    common = fit_common(beginnings, estimate, map_friction)
    if common is None or sides == [None, None]:
        raise FmuOutputError(
            f"{path}: it does not respond to forces like a vehicle; expected more speed with more "
            "force; 'giveway fmu check' shows what it does instead"
        )
    both = [side for side in sides if side is not None]
    judged = replace(validation, speed=true_speed(validation.speed, late, h))
    ahead = position_errors(judged, common.mass, common.friction, horizon)
    one_step = speed_errors(judged, common.mass, common.friction)
    # Without validation: also what is no vehicle at all is described, and called poor.
    model = FittedModel.model_construct(
        mass=common.mass,
        friction=common.friction,
        lag=float(np.mean([side.lag for side in both])),
        delay=float(np.mean([side.delay for side in both])),
        sensor_lag=late,
        r_squared=estimate.explained(held_out),
        speed_error=float(np.sqrt(np.mean(one_step**2))) if one_step.size else 0.0,
        position_error=float(np.quantile(ahead, 0.95)) if ahead.size else 0.0,
        horizon=horizon * h,
        time_step=h,
        drive=sides[0],
        brake=sides[1],
    )
    acting = replace(judged, force=acting_force(validation, model))
    errors = [
        position_errors(acting, model.mass, model.friction, horizon, exact=exact)
        for exact in (False, True)  # the layer's promise holds for both
    ]
    error = min(float(np.quantile(one, 0.95)) if one.size else 0.0 for one in errors)
    model = model.model_copy(update={"sides_error": error})
    return Identification(
        model=model,
        intervals=common.intervals,
        side_intervals=half_widths(estimate),
        largest_force=measured.largest,
        common=common,
        estimate=estimate,
        tests=tuple(tests),
        validation=validation,
        held_out=held_out,
        remarks=(
            *estimate_remarks(estimate, model, positions=sensor is not None),
            *resistance_remarks(estimate, common),
            *side_remarks(model, profile),
        ),
        poor="; ".join(poverty(estimate) if common.mass < HEAVIEST else ["no force moves it"]),
    )


def _full_forces(profile: VehicleProfile | None) -> tuple[float, float]:
    """Return the forces [N] of fully pressed pedals; infinite without pedals."""
    if profile is not None and profile.inputs.throttle and profile.inputs.brake:
        return profile.inputs.throttle.full_force, profile.inputs.brake.full_force
    return np.inf, np.inf


def apparent_mass(opener: Opener, path: Path, profile: VehicleProfile | None = None) -> float:
    """Return the force over the acceleration [kg] of a vehicle that drives off.

    Args:
        opener: Function that opens the vehicle.
        path: Path of the FMU, for messages.
        profile: Profile of the vehicle, for advice on its lines.

    Raises:
        FmuOutputError: no force drives it forwards.
    """
    forces = FIRST_FORCE * 2.0 ** np.arange(round(np.log2(STRONGEST / FIRST_FORCE)) + 1)
    phases = [Phase(float(force), 1.0, below=MOVING, above=-MOVING) for force in forces]
    trace = drive(opener, [Phase(0.0, 1.0), *phases])
    force, gained = float(trace.force[-1]), float(trace.speed[-1] - trace.speed[0])
    if gained <= -MOVING:
        axes = [role for role, axis in profile.inputs if isinstance(axis, Axis)] if profile else []
        turned = gain_line(profile, "inputs", axes[0] if axes else "force", -1.0)
        raise FmuOutputError(
            f"{path}: {force:g} N forwards drive it backwards ({trace.speed[-1]:.2g} m/s); turn "
            f"the sign with {turned} (or in [outputs.speed]) of the profile"
        )
    if gained < 0.5 * MOVING:
        raise FmuOutputError(
            f"{path}: forces of up to {force:.4g} N, each for 1 s, change its speed by "
            f"{gained:.2g} m/s; expected a vehicle that drives off; see the variable under "
            "[inputs] of the profile, or 'giveway fmu check'"
        )
    first = int(np.flatnonzero(trace.force == force)[0])
    seconds = (trace.force.size - first) * trace.step_size
    rough = force * seconds / max(float(trace.speed[-1] - trace.speed[first]), 1e-3)
    # Half of it for longer: a slow actuator has risen then, and a weak one is not at its limit.
    again = drive(opener, [Phase(0.0, 1.0), Phase(0.5 * rough, 3.0), Phase(0.0, 3.0)])
    change = np.diff(again.speed) / again.step_size
    pushed, last = int(np.flatnonzero(again.force)[-1]) + 1, max(round(0.5 / again.step_size), 1)
    gain = float(change[pushed - last : pushed].mean() - change[-last:].mean())  # [m/s2]
    return min(rough, 0.5 * rough / gain) if gain > 0.0 else rough


@dataclass
class _Starter:
    """Starts tests at a speed, by the FMU's parameter for it or by accelerating up to it."""

    opener: Opener
    force: float  # [N] force of the acceleration
    highest: float  # [m/s]

    def __post_init__(self) -> None:
        self.starts = True
        try:
            drive(self.opener, [], speed=self.highest)
        except (FmuStartError, FmuProfileError):
            self.starts = False

    def drive(self, phases: Sequence[Phase], speed: float) -> Trace:
        if self.starts:
            return drive(self.opener, phases, speed=speed)
        return drive(self.opener, [Phase(self.force, 60.0, below=speed), *phases])


def _test(force: float, speed: float, top: float) -> list[Phase]:
    """Return the phases of a test that drives and brakes with one force, around one speed."""
    return [
        Phase(0.0, LEAD_IN),
        Phase(force, DRIVE, below=top),
        Phase(0.0, PAUSE),
        Phase(-force, BRAKE, above=max(0.4 * speed, 0.5)),
        Phase(0.0, END, above=STANDSTILL),
    ]


def _validation(force: float, fastest: float) -> list[Phase]:
    """Return phases of changing force that keep the vehicle moving, and a stop at the end."""
    changes = [
        Phase(share * force, HELD, above=0.5 if share < 0.0 else -np.inf,
              below=fastest if share > 0.0 else np.inf)
        for share in VALIDATION
    ]  # fmt: skip
    return [Phase(0.0, LEAD_IN), *changes, Phase(-0.5 * force, 5.0, above=STANDSTILL)]
