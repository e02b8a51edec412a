"""The check whether a vehicle behaved as its controller's model predicts."""

from dataclasses import replace

import numpy as np

from fmus.checking.manoeuvres import Trace
from fmus.checking.model_fit.common_model import fit_common
from fmus.checking.model_fit.estimation import Estimate
from fmus.checking.model_fit.measurements import Measurements
from fmus.checking.model_fit.prediction import acting_force, position_errors, true_speed
from giveway.ego.vehicle_model import driven_model
from giveway.results.ego_result import EgoResult
from giveway.run_data.tracks import EgoTrack

_TOLERATED = 0.05  # Largest tolerated position error [m] over the horizon
_FEWEST = 10  # Smallest number of steps for a fit
_SURE = 0.1  # Largest relative half width of M's 95 % interval for a fit to be reported


def remark(ego: EgoResult, time_step: float, margin: float) -> str:
    """Return the remark on a vehicle that differs from its controller's model, or "".

    Args:
        ego: Result of the ego.
        time_step: Time step of the co-simulation [s].
        margin: Position error that its controller allows for [m].
    """
    config = ego.config
    if not config.optimises or not len(ego.track.time):
        return ""  # only an optimising controller has a model
    mass, friction = config.vehicle.mass, config.vehicle.friction
    model = driven_model(config, time_step)
    trace = _trace(ego.track, time_step, 0.0 if model is None else model.sensor_lag)
    acting = trace
    if model is not None:
        mass, friction = model.mass, model.friction
        acting = replace(trace, force=acting_force(trace, model))
    errors = position_errors(acting, mass, friction, config.model_steps)
    error = float(np.percentile(errors, 95)) if errors.size else 0.0
    if not error > max(_TOLERATED, 1.5 * margin):
        return ""
    fmu, profile = config.vehicle.fmu, config.vehicle.profile
    named = f" --profile {profile}" if profile else ""
    missed = (
        f"ego '{ego.id}': the vehicle does not answer as the controller's M = {mass:g} kg, alpha = "
        f"{friction:g} N.s/m predict: off by up to {error:.2g} m in "
        f"{config.model_steps * time_step:.3g} s"
    )
    if margin > 0.0:  # the vehicle has been identified already
        return (
            f"{missed}, {margin:.2g} m as identified: at forces that do not arrive, or too late; "
            f"see its limits with: giveway fmu check {fmu}{named}"
        )
    return (
        f"{missed}{_fitting(trace)}; match them with: giveway fmu identify {fmu}{named} "
        f"-o {profile or 'car.toml'}"
    )


def _trace(track: EgoTrack, time_step: float, lag: float) -> Trace:
    """Return the trace of a run's drive, with the distance from its speeds by forward Euler.

    The model adds the speeds up by forward Euler. An FMU may do it otherwise (the exact distance of
    a step has half a change of speed more). M and alpha do not depend on it. The ``lag`` [s] of the
    speed output is allowed for.
    """
    steps, speed = len(track.speed) - 1, true_speed(track.speed, lag, time_step)
    distance = np.concatenate(([0.0], np.cumsum(time_step * speed[:-1])))
    nothing = np.zeros(steps)
    return Trace(
        time_step,
        track.force[:-1],
        distance,
        speed,
        track.acceleration,
        cost=nothing,
        warnings=(),
    )


def _fitting(trace: Trace) -> str:
    """Return the M and alpha that fit better, in brackets, or "" if they cannot be told."""
    measured = Measurements.of([trace], euler=True)
    if measured.acceleration.size < _FEWEST:
        return ""
    found = fit_common(measured, Estimate.of(measured), 0.0)
    if found is None or not found.intervals[0] <= _SURE * found.mass:
        return ""
    return f" (M = {found.mass:.4g} kg and alpha = {found.friction:.4g} N.s/m fit better)"
