"""Makes the controller of an ego from the configuration."""

import dataclasses
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

from controller import (
    STYLES,
    Controller,
    ControllerError,
    LongitudinalModel,
    ManoeuvreParameters,
    Mpc,
    MpcParameters,
    Pid,
    PidParameters,
    Planner,
    PlannerParameters,
    PlanningController,
    ReferenceParameters,
    SpeedController,
    TunedPid,
    TunedPidParameters,
)
from giveway.config import EgoRunConfig
from giveway.config.option import LANE, Section
from giveway.config.tables.controllers import PaperPidOptions, PlannerOptions
from giveway.ego.plug_in import plugged_in
from giveway.ego.vehicle_model import actuator_of, model_margin
from giveway.errors import ControlError, retold

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Parameters = TypeVar("Parameters", bound="DataclassInstance")


def make_controller(
    config: EgoRunConfig, time_step: float, fastest: float | None = None
) -> Controller:
    """The controller of one ego.

    Args:
        config: Configuration of the ego.
        time_step: Control step of the co-simulation [s].
        fastest: Reference speed [m/s] from the lanes' limits, or None before it is known.

    Raises:
        ControlError: its parameters contradict each other, or its solver is missing.
    """
    speed: float = config.vehicle.speed_max if fastest is None else fastest
    if config.reference_speed != LANE:
        speed = config.reference_speed
    regulation = config.regulation.model_copy(update={"reference_speed": speed})
    config = config.model_copy(update={"regulation": regulation})
    with retold(ControllerError, ControlError):
        if config.plugged_in:
            return plugged_in(config, time_step)
        return _CONTROLLERS[config.controller](config, time_step)


def filled(kind: type[Parameters], *tables: Section, **own: Any) -> Parameters:
    """Parameters of a controller, taken from the tables' options of the same names.

    Args:
        kind: Dataclass of the parameters. A field that no table has keeps its default.
        tables: Tables of the configuration. The first one that has an option counts.
        own: Parameters that are not taken from a table.
    """
    for field in dataclasses.fields(kind):
        for table in tables:
            if field.name not in own and field.name in type(table).model_fields:
                own[field.name] = getattr(table, field.name)
    return kind(**own)


def _paper_mpc(config: EgoRunConfig, time_step: float) -> SpeedController:
    """The paper's MPC, with the paper's PID where the QP has no solution."""
    safe_distance = config.regulation.safe_distance + model_margin(config, time_step)
    own = config.own_options
    parameters = filled(
        MpcParameters, own, config.vehicle, config.regulation, safe_distance=safe_distance
    )
    return SpeedController(Mpc(_model(config, time_step), parameters), _pid(config, time_step))


def _pid(config: EgoRunConfig, time_step: float) -> Pid:
    """The paper's PID, with the force limit of the vehicle."""
    own = config.own(PaperPidOptions)
    parameters = filled(
        PidParameters,
        config.regulation,
        own,
        config.vehicle,
        K_p=own.proportional_gain,
        K_i=own.integral_gain,
        K_d=own.derivative_gain,
    )
    return Pid(parameters, time_step)


def _tuned_pid(config: EgoRunConfig, time_step: float) -> TunedPid:
    """The tuned PID, with the limits of the vehicle's actuator."""
    own = config.own_options
    reference = filled(ReferenceParameters, config.regulation, own)
    parameters = filled(TunedPidParameters, own, config.vehicle, reference=reference)
    return TunedPid(parameters, _model(config, time_step))


def manoeuvres_of(own: PlannerOptions, margin: float = 0.0) -> ManoeuvreParameters:
    """The planner's manoeuvres: options that are set, and the driving style for the others.

    Args:
        own: Options of the planner.
        margin: Distance [m] kept to people for the errors of the vehicle's model.
    """
    usual = STYLES[own.style]
    weight = usual if own.precaution_weight is None else own.precaution_weight
    distance = own.minimum_distance + margin
    return filled(ManoeuvreParameters, own, precaution_weight=weight, minimum_distance=distance)


def _planning(config: EgoRunConfig, time_step: float) -> PlanningController:
    """The planning MPC."""
    regulation, own = config.regulation, config.own(PlannerOptions)
    margin = model_margin(config, time_step)
    parameters = filled(
        PlannerParameters,
        regulation,
        own,
        config.vehicle,
        horizon=max(4, round(own.horizon / time_step)),
        safe_distance=regulation.safe_distance + margin,
        manoeuvres=manoeuvres_of(own, margin),
    )
    actuator = actuator_of(config, time_step)
    return PlanningController(Planner(_model(config, time_step), parameters, actuator))


def _model(config: EgoRunConfig, time_step: float) -> LongitudinalModel:
    return filled(LongitudinalModel, config.vehicle, time_step=time_step)


_CONTROLLERS: dict[str, Callable[[EgoRunConfig, float], Controller]] = {
    "mpc": _planning,
    "pid-tuned": lambda config, h: SpeedController(
        None, _tuned_pid(config, h), actuator_of(config, h)
    ),
    "mpc-paper": _paper_mpc,
    "pid-paper": lambda config, h: SpeedController(None, _pid(config, h)),
}
