"""The model of an ego's vehicle: that of its profile, or one that is found before the run."""

from math import inf
from pathlib import Path

from controller import Actuator, ActuatorSide, LateSpeed, LongitudinalModel
from fmus import (
    FmuError,
    VehicleProfile,
    bundled_fmu,
    choose_profile,
    is_bundled,
    prepare,
    read_profile,
)
from fmus.checking import is_vehicle, quick_model
from fmus.profile.vehicle_profile import FittedModel, SideModel
from giveway.config import EgoRunConfig
from giveway.config.files.identified import identified_vehicle
from giveway.config.tables.basics import BUNDLED_VEHICLES, VehicleConfig
from giveway.errors import VehicleError, retold

_NEAR = 0.1  # deviation of M, as a share, up to which the default car's flags suit a vehicle
_LATE = 0.05  # lag plus dead time [s] up to which they do
_QUICK = 1.5  # time [s] that a step may take before a run


def fmu_path(settings: VehicleConfig) -> Path:
    """The .fmu file that a configuration names."""
    version = BUNDLED_VEHICLES.get(settings.fmu)
    return Path(settings.fmu) if version is None else bundled_fmu(version)


def with_coarse_model(config: EgoRunConfig, time_step: float) -> EgoRunConfig:
    """Return the configuration with what a quick identification finds of an unknown vehicle.

    An FMU that is not giveway's, and whose profile has no [model], is driven for some seconds. If
    it is no car like the default one, M, alpha and the limits are those that are found, except for
    those that are set; it is then driven with its lag and dead time. An FMU that fails is left to
    the run, which keeps the rows up to the failure.

    Args:
        config: Configuration of the ego.
        time_step: Control step of the co-simulation [s].
    """
    settings, told = config.vehicle, config.vehicle.model_fields_set
    path = fmu_path(settings)
    if {"mass", "friction"} & told or is_bundled(path) or model_of(config) is not None:
        return config
    try:
        profile = impatient(choose_profile(path, profile_of(settings)))
        model = quick_model(path, profile, step_size=time_step)
    except FmuError:
        return config
    if _is_usual(model) or not is_vehicle(model):
        return config
    update = {key: value for key, value in identified_vehicle(model).items() if key not in told}
    vehicle = settings.model_copy(update=update)
    return config.model_copy(update={"vehicle": vehicle, "found": model})


def impatient(profile: VehicleProfile) -> VehicleProfile:
    """Return the profile with a short time limit of steps, as an FMU that hangs is left to the run.

    Args:
        profile: Profile of the vehicle.
    """
    limit = min(profile.fmu.step_timeout, _QUICK)
    return profile.model_copy(
        update={"fmu": profile.fmu.model_copy(update={"step_timeout": limit})}
    )


def _is_usual(model: FittedModel) -> bool:
    """Return whether a model is so near the default car that this one's flags suit it."""
    usual = VehicleConfig()
    sides = [side for side in (model.drive, model.brake) if side is not None]
    strong = all(side.limit is None or side.limit > usual.acceleration_limit for side in sides)
    quick = all(side.lag + side.delay <= _LATE and side.rate is None for side in sides)
    quick = quick and model.sensor_lag == 0.0
    return strong and quick and abs(model.mass / usual.mass - 1.0) <= _NEAR


def model_margin(config: EgoRunConfig, time_step: float) -> float:
    """The distance [m] kept in addition to the safe distance, for the identified model's error.

    If the horizon is longer than that of the fit, the distance grows with its square, as does the
    distance driven under an unmodelled acceleration.

    Args:
        config: Configuration of the ego.
        time_step: Control step of the co-simulation [s].

    Raises:
        VehicleError: the profile cannot be read.
    """
    model = model_of(config)
    if model is None:
        return 0.0
    error = model.position_error if model.sides_error is None else model.sides_error
    return error * max(1.0, config.model_steps * time_step / model.horizon) ** 2


def actuator_of(config: EgoRunConfig, time_step: float) -> Actuator | None:
    """The actuator of the ego's vehicle as its profile describes it; None without a model.

    ``[vehicle] force_limit`` may only lower the profile's limits.

    Args:
        config: Configuration of the ego.
        time_step: Control step of the co-simulation [s].

    Raises:
        VehicleError: the profile or the FMU cannot be read.
    """
    model = driven_model(config, time_step)
    if model is None:
        return None
    common = SideModel(mass=model.mass, lag=model.lag, delay=model.delay)
    mass, most = config.vehicle.mass, config.vehicle.force_limit

    def side(known: SideModel | None) -> ActuatorSide:
        found = known or common
        scale = found.mass / model.mass
        return ActuatorSide(
            scale=scale,
            lag=found.lag,
            delay=found.delay,
            limit=min(inf if found.limit is None else found.limit * mass, most / scale),
            power_from=found.power_from or inf,
            rate=inf if found.rate is None else found.rate * mass,
        )

    return Actuator(side(model.drive), side(model.brake))


def late_speed_of(config: EgoRunConfig, time_step: float) -> LateSpeed | None:
    """The estimator of the ego's speed if its FMU's speed output lags behind; None if it does not.

    Args:
        config: Configuration of the ego.
        time_step: Control step of the co-simulation [s].

    Raises:
        VehicleError: the profile or the FMU cannot be read.
    """
    model, vehicle = model_of(config), config.vehicle
    if model is None or model.sensor_lag <= 0.0:
        return None
    own = LongitudinalModel(vehicle.mass, vehicle.friction, time_step)
    actuator = actuator_of(config, time_step) or Actuator()
    return LateSpeed(own, model.sensor_lag, actuator, vehicle.force_limit)


def driven_model(config: EgoRunConfig, time_step: float) -> FittedModel | None:
    """The identified model, with the delay of the FMU's own steps in its dead times.

    Args:
        config: Configuration of the ego.
        time_step: Control step of the co-simulation [s].

    Raises:
        VehicleError: the profile or the FMU cannot be read.
    """
    model, path = model_of(config), fmu_path(config.vehicle)
    if model is None:
        return None
    with retold(FmuError, VehicleError):
        profile = choose_profile(path, profile_of(config.vehicle))
        known = profile.model_copy(update={"model": model})
        return prepare(path, step_size=time_step, profile=known).fitted


def model_of(config: EgoRunConfig) -> FittedModel | None:
    """The model in the profile, or the coarse one, or None.

    Raises:
        VehicleError: the profile cannot be read.
    """
    with retold(FmuError, VehicleError):
        profile = profile_of(config.vehicle)
    if profile is None or profile.model is None:
        return config.found
    return profile.model


def profile_of(settings: VehicleConfig) -> VehicleProfile | None:
    """The profile that a configuration names, or None."""
    return read_profile(Path(settings.profile)) if settings.profile else None
