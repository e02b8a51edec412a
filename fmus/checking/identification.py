"""Identification: step tests yield M and alpha, so that the MPC's model fits the vehicle.

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
from fmus.checking.model_fit.fitting import SETTLING, STANDSTILL, Drive, Fit, fit, prepare
from fmus.checking.model_fit.prediction import position_errors, speed_errors
from fmus.checking.model_fit.remarks import fit_remarks, saturation_remarks
from fmus.checking.model_fit.saturation import ResistanceModel, force_limits
from fmus.checking.model_fit.sides import Sides, fit_apart, side_remarks
from fmus.errors import FmuOutputError, FmuProfileError, FmuStartError
from fmus.isolation import processes_reused
from fmus.profile.advice import gain_line
from fmus.profile.tables import Axis
from fmus.profile.vehicle_profile import FittedModel, SideModel, VehicleProfile

LEVELS = (0.1, 0.25, 0.5, 1.0)  # Shares of the largest force in the tests
SPEEDS = (0.0, 2.0, 4.0, 8.0, 12.0)  # [m/s] speeds at the start of the tests
HARDEST = 8.0  # [m/s2] largest deceleration or acceleration of a test
LEAD_IN, STEP, PAUSE = SETTLING + 1.0, 1.5, 1.0  # [s] durations of the phases
NO_FIT = 0.3  # R squared below which there is no model
VALIDATION = (  # shares of the largest force, each held for HELD; none of them is in LEVELS
    0.3, 0.6, -0.2, 0.15, -0.4, 0.45, 0.8, -0.6, 0.0, 0.2, -0.15, 0.7, -0.3, 0.35, -0.8, 0.55,
    0.05, -0.1, 0.65, -0.5, 0.4, -0.05, 0.0, -0.25,
)  # fmt: skip
HELD = 0.6  # [s]
HEAVIEST = 1e6  # [kg] largest M that counts


class Mpc(NamedTuple):
    """The MPC for which a model is identified."""

    step_size: float  # [s] dt
    horizon: int  # [steps] N
    force_limit: float  # [N] largest force u_max; no test uses more


@dataclass(frozen=True)
class Identification:
    """A vehicle's model, its accuracy, and the drives behind it.

    Attributes:
        model: Model for the profile.
        intervals: Half widths of the 95 % intervals of M [kg] and alpha [N.s/m].
        drive_limit: Largest drive force [N] that the vehicle carries out, or None if it was not
            reached.
        brake_limit: Largest brake force [N] that arrives, or None if it was not reached.
        largest_force: Largest force of the tests [N].
        fit: Fitted M and alpha with lag and dead time.
        tests: Drives that were fitted.
        validation: Drive that was not fitted.
        remarks: Remarks for the user, one line each.
        sides: Results for driving and braking apart.
    """

    model: FittedModel
    intervals: tuple[float, float]
    drive_limit: float | None
    brake_limit: float | None
    largest_force: float
    fit: Fit
    tests: tuple[Trace, ...]
    validation: Trace
    remarks: tuple[str, ...]
    sides: Sides

    @property
    def fitted_drives(self) -> list[Drive]:
        """The tests as they were fitted."""
        limits = tuple(
            np.inf if limit is None else limit for limit in (self.drive_limit, self.brake_limit)
        )
        return [prepare(trace, (limits[0], limits[1])) for trace in self.tests]


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
    """Find M, alpha, lag and dead time of a vehicle by step tests.

    Args:
        opener: Function that opens the vehicle.
        mpc: MPC for which the model is meant.
        path: Path of the FMU, for messages.
        profile: Profile of the vehicle, for advice on its lines.
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
    largest = _largest_force(opener, path, profile, mpc)
    one_more()
    starter = _Starter(opener, 0.5 * largest, max(speeds))
    tests = _drive_tests(starter, largest, speeds, one_more)
    limits = force_limits(tests)
    validation = starter.drive(
        _validation(0.9 * min(largest, *limits), max(speeds)), float(np.median(speeds))
    )
    one_more()
    found = modelled(tests, validation, mpc.horizon, path, profile)
    return replace(found, largest_force=largest)


def modelled(
    tests: Sequence[Sequence[Trace]],
    validation: Trace,
    horizon: int,
    path: Path,
    profile: VehicleProfile | None = None,
) -> Identification:
    """Fit the model to drives that have been recorded.

    Args:
        tests: Drives by level of force, from weak to strong.
        validation: Drive by which the model is judged.
        horizon: Horizon of the MPC [steps].
        path: Path of the FMU, for messages.
        profile: Profile of the vehicle, for advice on its lines.

    Raises:
        FmuOutputError: the vehicle does not respond to forces like a vehicle.
    """
    limits = force_limits(tests)
    traces = tuple(trace for group in tests for trace in group)
    drives = [prepare(trace, limits) for trace in traces]
    found = fit(drives)
    if found is None:
        raise FmuOutputError(
            f"{path}: it does not respond to forces like a vehicle; expected more speed with more "
            "force"
        )
    sides = fit_apart(drives, found.delay)
    model = _rated(found, validation, limits, horizon).model_copy(
        update={
            name: _side_model(side, limit)
            for name, side, limit in zip(
                ("drive", "brake"), (sides.drive, sides.brake), limits, strict=True
            )
        }
    )
    if model.r_squared < NO_FIT:
        raise FmuOutputError(
            f"{path}: no M and alpha describe it (R² = {model.r_squared:.2f}): its speed does not "
            "follow M v' + alpha v = u; 'giveway fmu check' shows what it does instead"
        )
    return Identification(
        model=model,
        intervals=found.intervals,
        drive_limit=_finite(limits[0]),
        brake_limit=_finite(limits[1]),
        largest_force=max(float(np.abs(trace.force).max()) for trace in traces),
        fit=found,
        tests=traces,
        validation=validation,
        remarks=(
            *saturation_remarks(limits),
            *fit_remarks(found, model, traces, limits),
            *side_remarks(sides, validation.step_size, profile),
        ),
        sides=sides,
    )


def _drive_tests(
    starter: _Starter, largest: float, speeds: Sequence[float], one_more: Callable[[], None]
) -> list[list[Trace]]:
    """Drive the tests: a list of traces per level of force, from weak to strong, one per speed."""
    tests = []
    for level in LEVELS:
        group = []
        for speed in speeds:
            phases = _test(level * largest, speed, top=1.25 * max(speeds) + 1.0)
            group.append(starter.drive(phases, speed))
            one_more()
        tests.append(group)
    return tests


def _finite(limit: float) -> float | None:
    return float(limit) if np.isfinite(limit) else None


def _largest_force(opener: Opener, path: Path, profile: VehicleProfile | None, mpc: Mpc) -> float:
    """Return the force [N] of the hardest tests, within the limit and a road vehicle's grip."""
    share = 0.05
    while True:
        force = share * mpc.force_limit
        speed = drive(opener, [Phase(force, 2.0)]).speed
        half = speed.size // 2
        gained = float(speed[-1] - speed[half])
        if abs(speed[-1] - speed[0]) > 0.02 and abs(gained) > 1e-3:
            break
        if share >= 1.0:
            raise FmuOutputError(
                f"{path}: 2 s of {force:g} N move it by {speed[-1] - speed[0]:.2g} m/s; expected a "
                "vehicle that drives off; see the variable under [inputs] of the profile, or raise "
                "--force-limit"
            )
        share = min(2.0 * share, 1.0)
    if gained < 0.0:
        axes = [role for role, axis in profile.inputs if isinstance(axis, Axis)] if profile else []
        turned = gain_line(profile, "inputs", axes[0] if axes else "force", -1.0)
        raise FmuOutputError(
            f"{path}: {force:g} N forwards drive it backwards ({speed[-1]:.2g} m/s after 2 s); "
            f"turn the sign with {turned} (or in [outputs.speed]) of the profile"
        )
    apparent_mass = force * (speed.size - 1 - half) * mpc.step_size / gained
    return min(mpc.force_limit, HARDEST * apparent_mass)


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
        Phase(force, STEP, below=top),
        Phase(0.0, PAUSE),
        Phase(-force, STEP, above=max(0.4 * speed, 0.5)),
        Phase(0.0, PAUSE, above=STANDSTILL),
    ]


def _validation(force: float, fastest: float) -> list[Phase]:
    """Return phases of changing force that keep the vehicle moving, and a stop at the end."""
    changes = [
        Phase(share * force, HELD, above=0.5 if share < 0.0 else -np.inf,
              below=fastest if share > 0.0 else np.inf)
        for share in VALIDATION
    ]  # fmt: skip
    return [Phase(0.0, LEAD_IN), *changes, Phase(-0.5 * force, 5.0, above=STANDSTILL)]


def _rated(found: Fit, validation: Trace, limits: tuple[float, float], horizon: int) -> FittedModel:
    """Return the model with its errors in the drive that was held out."""
    held_out = prepare(validation, limits)
    ahead = position_errors(validation, found.mass, found.friction, horizon)
    one_step = speed_errors(validation, found.mass, found.friction)
    return FittedModel(
        mass=found.mass,
        friction=found.friction,
        lag=found.lag,
        delay=found.delay,
        r_squared=_r_squared(found, [held_out]),
        speed_error=float(np.sqrt(np.mean(one_step**2))) if one_step.size else 0.0,
        position_error=float(np.quantile(ahead, 0.95)) if ahead.size else 0.0,
        horizon=horizon * validation.step_size,
        time_step=validation.step_size,
    )


def _side_model(side: ResistanceModel | None, limit: float) -> SideModel | None:
    """Return a side's table of the profile; its limit is None if it is infinite."""
    if side is None or side.mass > HEAVIEST:
        return None
    most = limit / side.mass if np.isfinite(limit) else None
    return SideModel(mass=side.mass, lag=side.lag, delay=side.delay, limit=most)


def _r_squared(found: Fit, drives: Sequence[Drive]) -> float:
    measured = np.concatenate([drive.acceleration[drive.used] for drive in drives])
    fitted = np.concatenate([found.acceleration(drive)[drive.used] for drive in drives])
    spread = float(((measured - measured.mean()) ** 2).sum()) if measured.size else 0.0
    return 1.0 - float(((measured - fitted) ** 2).sum()) / spread if spread > 0.0 else 0.0
