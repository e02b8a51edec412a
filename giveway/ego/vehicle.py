"""Opens and checks an ego's vehicle FMU, from the configuration."""

import dataclasses
from collections.abc import Sequence
from contextlib import ExitStack
from hashlib import sha256
from pathlib import Path
from typing import Any

from fmus import (
    FmuError,
    FmuOutputError,
    FmuStartCrashError,
    FmuUnsuitableError,
    Vehicle,
    VehicleProfile,
    choose_profile,
    describe,
    is_bundled,
    open_vehicle,
    prepare,
)
from fmus.checking import (
    Answers,
    Standing,
    Told,
    convergence,
    holding,
    judge,
    measure,
    opener_of,
    openers_held,
    remedy,
    standing,
    stays,
    told_of,
    too_weak,
)
from giveway.config import EgoRunConfig, RunConfig
from giveway.config.tables.basics import DEFAULT_SPEED, EXACT
from giveway.config.tables.controllers import PaperPidOptions
from giveway.ego.vehicle_model import (
    fmu_path,
    impatient,
    model_margin,
    model_of,
    profile_of,
)
from giveway.errors import VehicleError, retold
from giveway.run_data.outputs import ROAD_GRADE
from giveway.run_data.tracks import EGO_COLUMNS

_CHECK_FORCE = 4000.0  # largest force [N] of the self-check
_FILTERED = 4.0  # [m] difference of position and speed that a filter of half a second makes
_SAME_STEP = 1e-6  # relative tolerance for two equal step sizes
_OTHER_SIZE = 2.0  # ratio of masses from which the defaults for a car no longer fit
# FMUs that passed the self-check in this process
_sound: dict[tuple[str, str, float, float, float, float, float | None], Standing] = {}


def require_vehicles(egos: Sequence[EgoRunConfig], time_step: float) -> None:
    """Make sure, before anything runs, that every FMU can be read and its profile fits.

    Args:
        egos: Configuration of each ego.
        time_step: Control step of the co-simulation [s].

    Raises:
        VehicleError: one cannot be driven.
    """
    for config in egos:
        path, profile = fmu_path(config.vehicle), profile_of(config.vehicle)
        with retold(FmuError, VehicleError):
            prepare(path, step_size=time_step, profile=profile)
        taken = {ROAD_GRADE[0], *(column.name for column in EGO_COLUMNS)}
        weak = too_weak(profile, config.vehicle.mass, config.vehicle.force_limit)
        if weak:
            raise VehicleError(f"[vehicle] of ego '{config.ego_id}': {weak}")
        for name in () if profile is None else profile.record:
            if name in taken:
                raise VehicleError(
                    f"{config.vehicle.profile or path}: record: '{name}' is a column of ego.csv "
                    "already; expected a variable of another name, or a copy of it in the FMU"
                )


def open_for(
    config: EgoRunConfig, time_step: float, stack: ExitStack
) -> tuple[Vehicle, dict[str, object], Standing]:
    """Open the vehicle of one ego; return it, its description for the manifest and how it rests.

    An FMU that is not giveway's is first driven for some seconds, in full and in smaller steps.

    Args:
        config: Configuration of the ego.
        time_step: Control step of the co-simulation [s].
        stack: Exit stack that closes the vehicle.

    Raises:
        FmuError: it cannot be loaded, its steps do not converge, or it goes the wrong way.
    """
    settings = config.vehicle
    path, profile = fmu_path(settings), profile_of(settings)
    ours, rests, remark = is_bundled(path), Standing(), ""
    start_values: dict[str, Any] = {}
    if ours and profile is None:
        start_values = {
            "M": settings.mass,
            "alpha": settings.friction,
            "exact": settings.fmu.endswith(EXACT),
        }
    isolated = {"auto": None, "process": True, "none": False}[settings.isolation]

    if not ours:
        profile = choose_profile(path, profile)
        rests = _require_sound(path, profile, config, time_step)
        if config.found is not None and config.found.sensor_lag > 0.0:
            profile = profile.model_copy(update={"model": config.found})
        if rests.hold and profile.inputs.hold is None:
            profile, remark = holding(profile, rests.hold), _held(path, rests)
    vehicle = open_vehicle(
        path,
        step_size=time_step,
        profile=profile,
        start_values=start_values,
        isolated=isolated,
    )
    stack.callback(vehicle.close)
    described: dict[str, object] = dataclasses.asdict(describe(path))
    described["bundled"] = ours
    described["isolated"] = not ours if isolated is None else isolated
    if profile is not None:
        described["profile"] = profile.model_dump(exclude_unset=True)
    if remark:
        described["standing"] = remark
    return vehicle, described, rests


def _held(path: Path, found: Standing) -> str:
    """Return the remark on a vehicle whose brakes are held at a standstill."""
    return (
        f"{path.name} {found.fact}: at a standstill its brakes are held with {found.hold:.4g} N; "
        "`hold` in [inputs] of its profile can be another force, or 0"
    )


def _require_sound(
    path: Path,
    profile: VehicleProfile,
    config: EgoRunConfig,
    time_step: float,
) -> Standing:
    """Drive an FMU for some seconds in full steps and in smaller ones, once per process.

    The FMU is always isolated, so that a crash does not end this process. An FMU that fails with
    every step is left to the run, which keeps the rows up to the failure.

    Returns:
        Its motion at rest, and the brake force that holds it.

    Raises:
        FmuError: its steps do not converge, it does not answer as a vehicle that can be driven and
            stopped, or as another one than the profile and the flags tell, or nothing holds it.
    """
    speed = config.ego.initial_speed
    speed = DEFAULT_SPEED if speed is None else speed
    vehicle, mass = config.vehicle, _told_mass(config, profile)
    force = min(_CHECK_FORCE, vehicle.force_limit)
    digest = sha256(path.read_bytes()).hexdigest()
    key = (digest, profile.model_dump_json(), time_step, speed, force, vehicle.force_limit, mass)
    if key in _sound:
        return _sound[key]
    try:
        if profile.fmu.self_check:
            _require_convergence(path, profile, time_step, force, speed)
        answers, sudden = _answers(path, profile, time_step, vehicle.force_limit)
    except (FmuStartCrashError, FmuUnsuitableError):
        raise  # the run would have no rows, and would wait for a hang again
    except FmuError:
        return Standing()
    told = told_of(profile, mass)
    for finding in judge(answers, told, profile):
        if finding.verdict != "pass":
            raise FmuUnsuitableError(sudden or f"{path}: {finding.text}; {finding.remedy}")
    _sound[key] = found = _at_rest(path, profile, time_step, answers, told)
    return found


def _at_rest(
    path: Path, profile: VehicleProfile, time_step: float, answers: Answers, told: Told
) -> Standing:
    """Find what keeps an FMU at rest; one that fails on the way is left to the run.

    Raises:
        FmuUnsuitableError: nothing does.
    """
    free = _without_bound(impatient(profile))
    opener = opener_of(path, step_size=time_step, profile=free)
    held = openers_held(path, step_size=time_step, profile=free)
    try:
        found = standing(opener, held, profile, answers, told)
    except FmuError:
        return Standing()
    finding = stays(found, profile)
    if finding.verdict == "fail":
        raise FmuUnsuitableError(f"{path}: {finding.text}; {finding.remedy}")
    return found


def _answers(
    path: Path, profile: VehicleProfile, time_step: float, force_limit: float
) -> tuple[Answers, str]:
    """Measure how an FMU answers, and say if its speed changes as that of no car.

    Raises:
        FmuError: the FMU fails.
    """
    bounded = impatient(_for_filters(profile))
    try:
        return measure(
            opener_of(path, step_size=time_step, profile=bounded), brake_force=force_limit
        ), ""
    except FmuOutputError as error:
        sudden = str(error)
    unbounded = _without_bound(bounded)
    opener = opener_of(path, step_size=time_step, profile=unbounded)
    return measure(opener, brake_force=force_limit), sudden


def _require_convergence(
    path: Path, profile: VehicleProfile, time_step: float, force: float, speed: float
) -> None:
    """Make sure that smaller steps give the same drive; a motion that no car has is left to others.

    Raises:
        FmuUnsuitableError: they do not.
        FmuError: the FMU fails.
    """
    try:
        result = convergence(
            opener_of(path, step_size=time_step, profile=_without_bound(profile)),
            prepare(path, step_size=time_step, profile=profile).step_plan.step,
            force=force,
            start_speed=speed,
        )
    except FmuOutputError:
        return
    if result.problem:
        raise FmuUnsuitableError(f"{path}: {result.problem}; {remedy(result)}")


def _told_mass(config: EgoRunConfig, profile: VehicleProfile) -> float | None:
    """Return the mass [kg] that a flag or the configuration tells, or None."""
    mass = config.vehicle.mass
    if profile.model is not None:
        return None if mass == profile.model.mass else mass
    told = config.found is None and "mass" in config.vehicle.model_fields_set
    return mass if told else None


def _without_bound(profile: VehicleProfile) -> VehicleProfile:
    """Return the profile without a bound of the acceleration, which diverging solvers exceed."""
    profile = _for_filters(profile)
    limits = profile.limits.model_copy(update={"acceleration": 1e12})
    return profile.model_copy(update={"limits": limits})


def _for_filters(profile: VehicleProfile) -> VehicleProfile:
    """Return the profile for full braking, in which a filtered speed lags behind the position."""
    jump = max(profile.limits.position_jump, _FILTERED)
    limits = profile.limits.model_copy(update={"position_jump": jump})
    return profile.model_copy(update={"limits": limits})


def model_remark(config: EgoRunConfig, time_step: float) -> str:
    """The remark on the identified vehicle model; empty if no model was identified.

    Args:
        config: Configuration of the ego.
        time_step: Control step of the co-simulation [s].
    """
    model = model_of(config)
    if model is None:
        return ""
    settings = config.vehicle
    text = (
        f"ego '{config.ego_id}': identified M = {model.mass:.4g} kg, alpha = {model.friction:.4g} "
        f"N.s/m (R² = {model.r_squared:.3f})"
    )
    if (settings.mass, settings.friction) != (model.mass, model.friction):
        text += f", overruled by M = {settings.mass:g} kg, alpha = {settings.friction:g} N.s/m"
    if config.found is not None:
        text += f", coarsely, as no profile has its [model]: giveway fmu identify {settings.fmu}"
    if config.optimises:
        margin = model_margin(config, time_step)
        text += f"; the MPC keeps {margin:.2g} m more than the safe distance for its errors"
    if abs(model.time_step - time_step) > _SAME_STEP * time_step:
        text += f"; it was fitted for steps of {model.time_step:g} s and not {time_step:g} s"
    return text + _other_size(config)


def _other_size(config: EgoRunConfig) -> str:
    """The advice on the gain of the paper's PID for a vehicle of another size; empty for a car."""
    ratio, own = config.vehicle.mass / RunConfig().vehicle.mass, config.own_options
    default = PaperPidOptions().proportional_gain
    usual = isinstance(own, PaperPidOptions) and own.proportional_gain == default
    if not usual or 1.0 / _OTHER_SIZE < ratio < _OTHER_SIZE:
        return ""
    gain = float(f"{ratio * default:.2g}")
    return f"; for the same accelerations the PID needs --set proportional_gain={gain:.10g}"
