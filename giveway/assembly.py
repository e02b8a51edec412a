"""From a configuration to the parts of a run, each set up and at its initial state."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np

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
from giveway.corridor import Corridor
from giveway.ego_path import EgoPath
from giveway.errors import ConfigError, ControlError, CrowdError, ScenarioError, VehicleError
from giveway.spawn import Spawned, spawn
from giveway.sumo import SumoSession
from giveway.tracks import VehicleShape
from pedestrian_model import (
    PRESETS,
    Crowd,
    CrowdModel,
    PedestrianModelError,
    Predictor,
    VciParameters,
    arrived,
)

if TYPE_CHECKING:
    from contextlib import ExitStack

    from numpy.typing import NDArray

    from giveway.config import RunConfig
    from sumo_scenarios import Scenario

_BUNDLED: dict[str, Literal["2.0", "3.0"]] = {"fmi2": "2.0", "fmi3": "3.0"}
ARRIVAL_RADIUS = 0.5  # [m] this close to the destination a pedestrian has arrived


@dataclass(frozen=True)
class Parts:
    """What a run is made of."""

    config: RunConfig
    sumo: SumoSession
    substeps: int  # control steps per SUMO step
    path: EgoPath
    departure: float  # [m] station of the front bumper at the start
    shape: VehicleShape
    vehicle: VehicleFmu
    vehicle_description: dict[str, object]
    regulator: Regulator
    corridor: Corridor
    horizon: int
    predictor: Predictor | None  # None: the controller looks at the present only
    spawned: Spawned
    crowd: Crowd
    crowd_model: CrowdModel

    def arrived(self, crowd: Crowd) -> NDArray[np.bool_]:
        """(n,) who of ``crowd`` has reached the last way-point."""
        return arrived(crowd, ARRIVAL_RADIUS)


def assemble(config: RunConfig, scenario: Scenario, stack: ExitStack) -> Parts:
    """Set up every part; SUMO and the FMU are closed by ``stack``.

    The cheap and the fallible come first, SUMO before the vehicle: what is wrong with a request
    is said before anything runs.

    Raises:
        GivewayError: a part cannot be set up as asked.
    """
    shape = VehicleShape(config.vehicle.length, config.vehicle.width)
    regulator = _regulator(config)
    sumo = stack.enter_context(
        SumoSession(
            scenario.config_file,
            seed=config.seed,
            step_length=config.sumo.step_length,
            ego_shape=shape,
        )
    )
    _require_ego(config, scenario, sumo.end)
    substeps = _substeps(config.time_step, sumo.step_length)
    path = EgoPath.through(sumo.lanes.along(config.ego.route, config.ego.lane))
    _require_room(config, path)
    spawned = spawn(config.crowd, path, config.seed)
    if config.ego.id in spawned.ids:
        msg = f"--ego-id '{config.ego.id}': a pedestrian has this id; choose another"
        raise ConfigError(msg)
    vehicle = _vehicle(config, stack)
    sumo.run_until(config.ego.depart_time)
    sumo.add_ego(
        config.ego.id,
        config.ego.route,
        lane=config.ego.lane,
        position=config.ego.depart_position,
        speed=config.ego.initial_speed,
    )
    if spawned.ids:
        sumo.add_persons(spawned.ids, config.crowd.host_edge)
    parameters = PRESETS[config.crowd.preset]
    horizon = config.mpc.horizon if config.controller == "mpc" else 1
    return Parts(
        config=config,
        sumo=sumo,
        substeps=substeps,
        path=path,
        departure=config.ego.depart_position,
        shape=shape,
        vehicle=vehicle,
        vehicle_description=_description(vehicle),
        regulator=regulator,
        corridor=Corridor(
            path,
            half_width=config.corridor_half_width,
            horizon=horizon,
            time_step=config.time_step,
            walking_speed_limit=parameters.max_speed,
        ),
        horizon=horizon,
        predictor=_predictor(config, parameters),
        spawned=spawned,
        crowd=_crowd(spawned),
        crowd_model=CrowdModel(parameters, config.time_step),
    )


def _regulator(config: RunConfig) -> Regulator:
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
            config.time_step,
        )
        if config.controller == "pid":
            return Regulator(None, pid)
        model = LongitudinalModel(
            mass=config.vehicle.mass,
            friction=config.vehicle.friction,
            time_step=config.time_step,
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


def _predictor(config: RunConfig, parameters: VciParameters) -> Predictor | None:
    if config.controller != "mpc":
        return None
    return Predictor(parameters, config.time_step, config.mpc.horizon)


def _crowd(spawned: Spawned) -> Crowd:
    """Everybody already walks: at the desired speed, towards the destination."""
    way = spawned.destination - spawned.position
    direction = way / np.maximum(np.hypot(way[:, 0], way[:, 1]), 1e-9)[:, None]
    try:
        return Crowd.create(
            spawned.position,
            spawned.desired_speed[:, None] * direction,
            spawned.desired_speed,
            [destination[None] for destination in spawned.destination],
        )
    except PedestrianModelError as error:
        raise CrowdError(f"pedestrians cannot be placed: {error}") from error


def _vehicle(config: RunConfig, stack: ExitStack) -> VehicleFmu:
    settings = config.vehicle
    bundled = _BUNDLED.get(settings.fmu)
    path = Path(settings.fmu) if bundled is None else bundled_fmu(bundled)
    start_values = {"M": settings.mass, "alpha": settings.friction, "exact": settings.exact}
    try:
        vehicle = stack.enter_context(
            VehicleFmu(path, step_size=config.time_step, start_values=start_values)
        )
        vehicle.start(position=0.0, speed=config.ego.initial_speed)
    except FmuError as error:
        raise VehicleError(str(error)) from error
    return vehicle


def _description(vehicle: VehicleFmu) -> dict[str, object]:
    """What the manifest says of the FMU."""
    return dataclasses.asdict(describe(vehicle.path))


def _substeps(time_step: float, step_length: float) -> int:
    """How many control steps make one SUMO step.

    Raises:
        ConfigError: they do not fit a whole number of times.
    """
    substeps = round(step_length / time_step)
    if substeps < 1 or abs(substeps * time_step - step_length) > 1e-9:
        msg = (
            f"--time-step {time_step:g}: SUMO's step of {step_length:g} s is not a whole multiple "
            "of it; choose another time step [s] or --sumo-step-length"
        )
        raise ConfigError(msg)
    return substeps


def _require_ego(config: RunConfig, scenario: Scenario, end: float) -> None:
    if config.ego.depart_time >= end:
        msg = (
            f"--ego-depart-time {config.ego.depart_time:g}: {scenario.config_file} ends at "
            f"{end:g} s; let the ego depart before [s]"
        )
        raise ConfigError(msg)
    if not config.ego.route:
        msg = (
            f"{scenario.config_file}: no route for the ego; name its edges with --ego-route "
            f"EDGE,EDGE or in {scenario.name}.giveway.toml, [ego] route"
        )
        raise ConfigError(msg)
    if config.crowd.pedestrians and not config.crowd.host_edge:
        msg = (
            f"{scenario.config_file}: no edge to host the added pedestrians; name one with "
            "--crowd-host-edge, or add none with --pedestrians 0"
        )
        raise ConfigError(msg)


def _require_room(config: RunConfig, path: EgoPath) -> None:
    needed = config.ego.depart_position + config.ego.travel_distance
    if needed > path.length:
        msg = (
            f"--ego-travel-distance {config.ego.travel_distance:g}: the ego's route is "
            f"{path.length:.1f} m long and it departs at {config.ego.depart_position:g} m; "
            "shorten the distance or lengthen --ego-route"
        )
        raise ScenarioError(msg)
