"""M and alpha of a vehicle from step tests, so that the MPC's model is the vehicle's.

The vehicle is what the controller sees: force in, position and speed out. Of a vehicle that is
driven by an acceleration, a speed or pedals it is the whole chain from the force on.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fmus.checking import actuator
from fmus.checking.fitting import SETTLING, STANDSTILL, Drive, Fit, fit, prepare
from fmus.checking.manoeuvres import Phase, Trace, drive
from fmus.checking.prediction import position_errors, speed_errors
from fmus.checking.saturation import force_limits
from fmus.errors import FmuOutputError, FmuProfileError, FmuStartError
from fmus.profile import FittedModel

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from fmus.checking.manoeuvres import Opener

LEVELS = (0.1, 0.25, 0.5, 1.0)  # of the largest force of the tests
SPEEDS = (0.0, 2.0, 4.0, 8.0, 12.0)  # [m/s] at the start of the tests
HARDEST = 8.0  # [m/s2] no test drives or brakes harder
LEAD_IN, STEP, PAUSE = SETTLING + 1.0, 1.5, 1.0  # [s]
POOR_FIT = 0.9  # of R squared, below which a remark says so
NO_FIT = 0.3  # of R squared, below which there is no model
VALIDATION = (  # of the largest force, each held for HELD; no level of the tests
    0.3, 0.6, -0.2, 0.15, -0.4, 0.45, 0.8, -0.6, 0.0, 0.2, -0.15, 0.7, -0.3, 0.35, -0.8, 0.55,
    0.05, -0.1, 0.65, -0.5, 0.4, -0.05, 0.0, -0.25,
)  # fmt: skip
HELD = 0.6  # [s]


@dataclass(frozen=True)
class Identification:
    """A vehicle's model, how sure it is, and what it was validated with.

    Attributes:
        model: for the profile.
        intervals: half widths of the 95 % intervals of M [kg] and alpha [N.s/m].
        drive_limit: largest drive force that the vehicle carries out [N]; None: not reached.
        brake_limit: of the brakes [N], likewise.
        largest_force: of the tests [N].
        fit: M and alpha with lag and dead time.
        tests: what was fitted.
        validation: what was not.
        remarks: what the user should know, one line each.
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

    @property
    def fitted_drives(self) -> list[Drive]:
        """The tests as they were fitted."""
        limits = tuple(
            np.inf if limit is None else limit for limit in (self.drive_limit, self.brake_limit)
        )
        return [prepare(trace, (limits[0], limits[1])) for trace in self.tests]


def identify(
    opener: Opener,
    *,
    path: Path,
    step_size: float,
    horizon: int,
    force_limit: float,
    speeds: Sequence[float] = SPEEDS,
    progress: Callable[[int, int], None] | None = None,
) -> Identification:
    """Find M, alpha, lag and dead time of a vehicle by step tests.

    Args:
        opener: makes the vehicle.
        path: of the FMU, for messages.
        step_size: of the MPC, dt [s].
        horizon: of the MPC, N [steps].
        force_limit: u_max of the MPC [N]; no test uses more.
        speeds: from which the tests start [m/s].
        progress: told how many of the drives are done, and of how many.

    Raises:
        FmuOutputError: the vehicle does not respond to forces like a vehicle.
        FmuError: the FMU fails in a test.
    """
    tell = progress or (lambda _done, _all: None)
    total = len(speeds) * len(LEVELS) + 2
    tell(0, total)
    largest = _largest_force(opener, path, force_limit, step_size)
    tell(1, total)
    begin = _Beginning(opener, 0.5 * largest, max(speeds))
    tests: list[list[Trace]] = [[] for _ in LEVELS]
    for number, level in enumerate(LEVELS):
        for speed in speeds:
            phases = _test(level * largest, speed, top=1.25 * max(speeds) + 1.0)
            tests[number].append(begin.drive(phases, speed))
            tell(1 + sum(map(len, tests)), total)
    limits = force_limits(tests)
    traces = tuple(trace for group in tests for trace in group)
    found = fit([prepare(trace, limits) for trace in traces])
    validation = begin.drive(
        _validation(0.9 * min(largest, *limits), max(speeds)), float(np.median(speeds))
    )
    tell(total, total)
    if found is None:
        raise FmuOutputError(f"{path}: {_NOT_A_VEHICLE}; expected more speed with more force")
    model = _rated(found, validation, limits, step_size, horizon)
    if model.r_squared < NO_FIT:
        msg = (
            f"{path}: no M and alpha describe it (R² = {model.r_squared:.2f}): its speed does not "
            "follow M v' + alpha v = u; 'giveway fmu check' shows what it does instead"
        )
        raise FmuOutputError(msg)
    return Identification(
        model=model,
        intervals=found.intervals,
        drive_limit=_finite(limits[0]),
        brake_limit=_finite(limits[1]),
        largest_force=largest,
        fit=found,
        tests=traces,
        validation=validation,
        remarks=(*_saturation(limits), *_remarks(found, model, traces, limits)),
    )


_NOT_A_VEHICLE = "it does not respond to forces like a vehicle"


def _finite(limit: float) -> float | None:
    return float(limit) if np.isfinite(limit) else None


def _largest_force(opener: Opener, path: Path, force_limit: float, step_size: float) -> float:
    """The force [N] of the hardest tests: what the limit and a road vehicle's tyres allow."""
    share = 0.05
    while True:
        force = share * force_limit
        speed = drive(opener, [Phase(force, 2.0)]).speed
        half = speed.size // 2
        gained = float(speed[-1] - speed[half])
        if abs(speed[-1] - speed[0]) > 0.02 and abs(gained) > 1e-3:
            break
        if share >= 1.0:
            msg = (
                f"{path}: 2 s of {force:g} N move it by {speed[-1] - speed[0]:.2g} m/s; expected a "
                "vehicle that drives off; see the variable under [inputs] of the profile, or raise "
                "--force-limit"
            )
            raise FmuOutputError(msg)
        share = min(2.0 * share, 1.0)
    if gained < 0.0:
        msg = (
            f"{path}: {force:g} N forwards drive it backwards ({speed[-1]:.2g} m/s after 2 s); "
            "turn the sign with `gain = -1.0` under [inputs] (or [outputs.speed]) of the profile"
        )
        raise FmuOutputError(msg)
    apparent_mass = force * (speed.size - 1 - half) * step_size / gained
    return min(force_limit, HARDEST * apparent_mass)


@dataclass
class _Beginning:
    """Starts tests at a speed: by the FMU's own means, or by driving up to it."""

    opener: Opener
    force: float  # [N] to drive up with
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
    """Drive and brake with one force, about one speed."""
    return [
        Phase(0.0, LEAD_IN),
        Phase(force, STEP, below=top),
        Phase(0.0, PAUSE),
        Phase(-force, STEP, above=max(0.4 * speed, 0.5)),
        Phase(0.0, PAUSE, above=STANDSTILL),
    ]


def _validation(force: float, fastest: float) -> list[Phase]:
    """Changing forces that keep the vehicle moving, and a stop at the end."""
    changes = [
        Phase(share * force, HELD, above=0.5 if share < 0.0 else -np.inf,
              below=fastest if share > 0.0 else np.inf)
        for share in VALIDATION
    ]  # fmt: skip
    return [Phase(0.0, LEAD_IN), *changes, Phase(-0.5 * force, 5.0, above=STANDSTILL)]


def _rated(
    found: Fit, validation: Trace, limits: tuple[float, float], step_size: float, horizon: int
) -> FittedModel:
    """The model with its errors in the drive that was held out."""
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
        horizon=horizon * step_size,
        time_step=step_size,
    )


def _r_squared(found: Fit, drives: Sequence[Drive]) -> float:
    measured = np.concatenate([drive.acceleration[drive.used] for drive in drives])
    fitted = np.concatenate([found.acceleration(drive)[drive.used] for drive in drives])
    spread = float(((measured - measured.mean()) ** 2).sum()) if measured.size else 0.0
    return 1.0 - float(((measured - fitted) ** 2).sum()) / spread if spread > 0.0 else 0.0


def _saturation(limits: tuple[float, float]) -> list[str]:
    return [
        f"no more than {limit:.0f} N of {name} force arrive: run with --force-limit {limit:.0f} or "
        "less"
        for name, limit in zip(("drive", "brake"), limits, strict=True)
        if np.isfinite(limit)
    ]


def _remarks(
    found: Fit, model: FittedModel, traces: Sequence[Trace], limits: tuple[float, float]
) -> list[str]:
    remarks = []
    if model.r_squared < POOR_FIT:
        remarks.append(
            f"poor fit: R² = {model.r_squared:.2f}; M v' + alpha v = u is not how it moves, "
            f"expect the MPC to be off by {model.position_error:.2g} m at its horizon"
        )
    late = model.lag + model.delay
    if late > model.time_step:
        remarks.append(
            f"forces act {late:.2g} s late; the MPC does not know that: its position error of "
            f"{model.position_error:.2g} m at the horizon has it in"
        )
    return [*remarks, *_resistance(found, [prepare(trace, limits) for trace in traces])]


def _resistance(found: Fit, drives: Sequence[Drive]) -> list[str]:
    """What else resists: a constant force and one that grows with the square of the speed."""
    speed = np.concatenate([drive.speed[:-1][drive.used] for drive in drives])
    acting = np.concatenate(
        [actuator.mean_force(d.force, d.step, found.lag, found.delay)[d.used] for d in drives]
    )
    measured = np.concatenate([drive.acceleration[drive.used] for drive in drives])
    left = np.concatenate([(d.acceleration - found.acceleration(d))[d.used] for d in drives])
    X = np.column_stack((acting, -speed, -np.ones_like(speed), -speed * np.abs(speed)))
    scale = np.maximum(np.abs(X).max(axis=0), 1e-300)
    theta, *_ = np.linalg.lstsq(X / scale, measured, rcond=None)
    better = float(np.sqrt(np.mean((measured - X / scale @ theta) ** 2)))
    if better > 0.7 * found.residual or found.residual - better < 0.005 or theta[0] <= 0.0:
        return []
    fastest = float(speed.max())
    worst = float(np.sqrt(np.mean(left[speed > 0.8 * fastest] ** 2)))
    terms = _terms(theta[1:] / scale[1:] * scale[0] / theta[0], fastest)
    return [
        f"its resistance is not alpha v: {terms} fits better; near {fastest:.0f} m/s the MPC's "
        f"model misses {worst:.2g} m/s²"
    ]


def _terms(resistance: NDArray[np.float64], fastest: float) -> str:
    """A sum in words, without the terms that hardly matter at any speed.

    Args:
        resistance: viscous [N.s/m], constant [N] and quadratic [N.s2/m2].
        fastest: [m/s].
    """
    viscous, constant, quadratic = resistance.tolist()
    terms = (
        (constant, 1.0, "N"),
        (viscous, fastest, "N.s/m v"),
        (quadratic, fastest**2, "N.s²/m² v²"),
    )
    most = max(abs(factor) * size for factor, size, _ in terms)
    return " + ".join(
        f"{factor:.3g} {unit}" for factor, size, unit in terms if abs(factor) * size > 0.02 * most
    )
