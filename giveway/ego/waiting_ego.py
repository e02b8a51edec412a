"""An ego before it departs: its vehicle FMU is loaded, its controller is set up."""

from dataclasses import dataclass

from controller import Controller, PluggedIn, SafetyParameters, WorstMotion
from fmus import FmuError, Vehicle
from giveway.config import EgoRunConfig
from giveway.ego.people_assumed import people_at_worst
from giveway.ego.recorded_ego import RecordedVehicle
from giveway.errors import VehicleError
from pedestrian_model import CrowdPredictor


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
