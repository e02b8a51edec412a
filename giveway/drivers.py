"""Who drives an ego: its FMU, loaded, and its controller, from the configuration."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from controller import (
    ControllerError,
    LongitudinalModel,
    Mpc,
    MpcParameters,
    Pid,
    PidParameters,
    Regulator,
)
from fmus import FmuError, VehicleFmu, bundled_fmu, describe
from giveway.ego import Driver
from giveway.errors import ControlError, VehicleError
from pedestrian_model import PRESETS, Predictor

if TYPE_CHECKING:
    from contextlib import ExitStack

    from giveway.config import RunConfig

_BUNDLED: dict[str, Literal["2.0", "3.0"]] = {"fmi2": "2.0", "fmi3": "3.0"}


def make_regulator(config: RunConfig, time_step: float) -> Regulator:
    """The controller of one ego.

    Args:
        config: of this ego alone.
        time_step: of the co-simulation [s].

    Raises:
        ControlError: its parameters contradict each other, or its solver is missing.
    """
    regulation = config.regulation
    try:
        pid = Pid(
            PidParameters(
                K_p=config.pid.proportional_gain,
                K_i=config.pid.integral_gain,
                K_d=config.pid.derivative_gain,
                reference_speed=regulation.reference_speed,
                safe_distance=regulation.safe_distance,
                buffer_distance=config.pid.buffer_distance,
                force_limit=config.mpc.force_limit,
            ),
            time_step,
        )
        if config.controller == "pid":
            return Regulator(None, pid)
        model = LongitudinalModel(
            mass=config.vehicle.mass,
            friction=config.vehicle.friction,
            time_step=time_step,
        )
        mpc = Mpc(
            model,
            MpcParameters(
                horizon=config.mpc.horizon,
                reference_speed=regulation.reference_speed,
                safe_distance=regulation.safe_distance,
                speed_min=config.mpc.speed_min,
                speed_max=config.mpc.speed_max,
                force_limit=config.mpc.force_limit,
                force_rate_limit=config.mpc.force_rate_limit,
                solver=config.mpc.solver,
            ),
        )
    except ControllerError as error:
        raise ControlError(str(error)) from error
    return Regulator(mpc, pid)


def make_driver(
    config: RunConfig, regulator: Regulator, time_step: float, stack: ExitStack
) -> Driver:
    """One ego's FMU, loaded, with its controller.

    Args:
        config: of this ego alone.
        regulator: its controller.
        time_step: of the co-simulation [s].
        stack: closes the FMU.

    Raises:
        VehicleError: the FMU cannot be loaded.
    """
    parameters = PRESETS[config.crowd.preset]
    vehicle = _vehicle(config, time_step, stack)
    predictor = None
    if config.controller == "mpc":
        predictor = Predictor(parameters, time_step, config.mpc.horizon)
    return Driver(
        config, vehicle, _description(vehicle), regulator, predictor, parameters.max_speed
    )


def _vehicle(config: RunConfig, time_step: float, stack: ExitStack) -> VehicleFmu:
    settings = config.vehicle
    bundled = _BUNDLED.get(settings.fmu)
    path = Path(settings.fmu) if bundled is None else bundled_fmu(bundled)
    start_values = {"M": settings.mass, "alpha": settings.friction, "exact": settings.exact}
    try:
        return stack.enter_context(VehicleFmu(path, step_size=time_step, start_values=start_values))
    except FmuError as error:
        raise VehicleError(str(error)) from error


def _description(vehicle: VehicleFmu) -> dict[str, object]:
    """What the manifest says of the FMU."""
    return dataclasses.asdict(describe(vehicle.path))
