"""An ego before it departs: its vehicle FMU is loaded, its controller is set up."""

from contextlib import ExitStack
from dataclasses import dataclass
from math import sqrt

from controller import Controller, PluggedIn, SafetyParameters, WorstMotion
from fmus import FmuError, Vehicle
from giveway.config import EgoRunConfig
from giveway.config.presets import parameters_of
from giveway.ego.predictors import predictor_of
from giveway.ego.recorded import NoController, RecordedVehicle
from giveway.ego.vehicle import identified_reaction_time, model_margin, open_for
from giveway.ego.worst_motion import people_at_worst
from giveway.errors import VehicleError
from giveway.records.tracks import EgoTrack
from pedestrian_model import CrowdPredictor

_MARGIN = 0.05  # Distance [m] between the front bumper and whoever may get there; docs/safety.md
_WITHIN = 2.0 * sqrt(2.0)  # standard deviations: the noise is cut off at two of them in x and in y


@dataclass
class WaitingEgo:
    """An ego that has not departed yet: its vehicle FMU is loaded, its controller is set up.

    Attributes:
        config: of the ego.
        vehicle: its FMU.
        description: of the FMU, for the manifest.
        controller: decides on its force.
        predictor: of the crowd; None: the controller looks at the present only.
    """

    config: EgoRunConfig
    vehicle: Vehicle
    description: dict[str, object]
    controller: Controller
    predictor: CrowdPredictor | None
    walking_speed_limit: float  # [m/s]
    safety: SafetyParameters | None  # None: nothing watches over the controller

    @property
    def id(self) -> str:
        """SUMO's id of the vehicle."""
        return self.config.ego_id

    @property
    def taken_over(self) -> bool:
        """Whether the vehicle is the scenario's."""
        return bool(self.config.ego.take_over)

    @property
    def recorded(self) -> bool:
        """Whether it will drive as it did in a run that is over."""
        return isinstance(self.vehicle, RecordedVehicle)

    def start(self, speed: float) -> None:
        """Set the FMU to where it departs.

        Raises:
            VehicleError: it fails.
        """
        try:
            self.vehicle.start(position=0.0, speed=speed)
        except FmuError as error:
            raise VehicleError(str(error)) from error

    @property
    def warnings(self) -> list[str]:
        """What the user should know of its FMUs."""
        own = self.controller.warnings if isinstance(self.controller, PluggedIn) else []
        return [*self.vehicle.warnings, *own]

    def close(self) -> None:
        """End its controller, if that is a process; the vehicle is closed by its stack."""
        if isinstance(self.controller, PluggedIn):
            self.controller.close()

    @property
    def clearance(self) -> float:
        """The distance that the safety layer keeps to pedestrians' bodies [m].

        What it adds for the errors of tracked positions is in none: they differ.
        """
        if self.safety is None:
            return 0.0
        error = 0.0 if self.config.tracks_people else self.safety.position_error
        return self.safety.margin + error

    @property
    def worst(self) -> WorstMotion:
        """What people are taken to do at worst, with or without a safety layer."""
        if self.safety is not None:
            return self.safety.worst
        return people_at_worst(self.config.safety.people, self.config.crowd.preset)

    @property
    def horizon(self) -> int:
        """Steps that are looked ahead; the first one in any case."""
        return max(1, self.controller.horizon)


def make_waiting_ego(
    config: EgoRunConfig,
    controller: Controller,
    time_step: float,
    stack: ExitStack,
) -> WaitingEgo:
    """Load one ego's vehicle FMU and join it with its controller.

    Args:
        config: of the ego.
        controller: decides on its force.
        time_step: of the co-simulation [s].
        stack: closes the FMU.

    Raises:
        VehicleError: the FMU cannot be loaded.
    """
    crowd = parameters_of(config.crowd.preset)
    expected = parameters_of(config.perception.preset or config.crowd.preset)
    try:
        vehicle, description = open_for(config, time_step, stack)
    except FmuError as error:
        raise VehicleError(str(error)) from error
    predictor = predictor_of(config, controller, time_step, expected)
    fastest = max(crowd.max_speed, expected.max_speed)
    safety = safety_parameters(config, time_step) if config.safety_layer else None
    ego = WaitingEgo(config, vehicle, description, controller, predictor, fastest, safety)
    stack.callback(ego.close)
    return ego


def recorded_ego(config: EgoRunConfig, track: EgoTrack, time_step: float) -> WaitingEgo:
    """An ego that will drive as it did in a run that is over.

    Args:
        config: of the ego.
        track: its rows.
        time_step: of the co-simulation [s].
    """
    vehicle = RecordedVehicle(track, time_step)
    fastest = parameters_of(config.crowd.preset).max_speed
    return WaitingEgo(config, vehicle, {}, NoController(), None, fastest, None)


def safety_parameters(config: EgoRunConfig, time_step: float) -> SafetyParameters:
    """The limits that the safety layer counts on; the body's width is not known yet.

    Args:
        config: of the ego.
        time_step: of the co-simulation [s].
    """
    safety, walking = config.safety, parameters_of(config.crowd.preset)
    worst = people_at_worst(safety.people, config.crowd.preset)
    reaction = safety.reaction_time
    return SafetyParameters(
        walking_acceleration=worst.acceleration,
        walking_speed=worst.speed,
        setting_out=worst.setting_out,
        body_radius=walking.body_radius,
        margin=_MARGIN + model_margin(config, time_step),
        position_error=_WITHIN * config.perception.position_noise,
        force_limit=config.vehicle.force_limit,
        reaction_time=identified_reaction_time(config) if reaction is None else reaction,
    )
