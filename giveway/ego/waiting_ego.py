"""An ego before it departs, with its vehicle FMU loaded and its controller set up."""

from dataclasses import dataclass, field

from controller import Controller, SafetyParameters, WorstMotion
from fmus import FmuError, Vehicle
from fmus.checking import Standing
from giveway.config import EgoRunConfig
from giveway.ego.people_assumed import people_at_worst
from giveway.ego.recorded_ego import RecordedVehicle
from giveway.errors import VehicleError, retold
from giveway.plug_ins.plugged_in_controller import PluggedIn
from pedestrian_model import CrowdPredictor


@dataclass
class WaitingEgo:
    """An ego that has not departed yet, with its vehicle FMU loaded and its controller set up.

    Attributes:
        config: Configuration of the ego.
        vehicle: Vehicle FMU.
        description: Description of the FMU, for the manifest.
        controller: Controller, which decides on the force.
        predictor: Predictor of the crowd, or None for a controller that does not predict.
    """

    config: EgoRunConfig
    vehicle: Vehicle
    description: dict[str, object]
    controller: Controller
    predictor: CrowdPredictor | None
    walking_speed_limit: float  # highest walking speed [m/s]
    safety: SafetyParameters | None  # limits of the safety layer, or None without one
    rests: Standing = field(default_factory=Standing)  # motion of the vehicle at rest

    @property
    def id(self) -> str:
        """SUMO's id of the vehicle."""
        return self.config.ego_id

    @property
    def taken_over(self) -> bool:
        """Return whether the ego takes over a vehicle of the scenario."""
        return bool(self.config.ego.take_over)

    @property
    def recorded(self) -> bool:
        """Return whether the ego repeats its recorded drive of an earlier run."""
        return isinstance(self.vehicle, RecordedVehicle)

    def start(self, speed: float) -> None:
        """Start the FMU at the departure, with ``speed`` [m/s].

        Raises:
            VehicleError: the FMU cannot be started.
        """
        with retold(FmuError, VehicleError):
            self.vehicle.start(position=0.0, speed=speed)

    @property
    def warnings(self) -> list[str]:
        """The warnings about its FMUs, one sentence each."""
        own = self.controller.warnings if isinstance(self.controller, PluggedIn) else []
        standing = self.description.get("standing")
        return [*self.vehicle.warnings, *([str(standing)] if standing else []), *own]

    def close(self) -> None:
        """End its controller if that is a process. The exit stack closes the vehicle."""
        if isinstance(self.controller, PluggedIn):
            self.controller.close()

    @property
    def clearance(self) -> float:
        """The distance [m] that the safety layer keeps to pedestrians' bodies.

        It does not cover errors of tracked positions, which differ by person.
        """
        if self.safety is None:
            return 0.0
        error = 0.0 if self.config.tracks_people else self.safety.position_error
        return self.safety.margin + error

    @property
    def worst(self) -> WorstMotion:
        """The worst motion assumed of people, with or without a safety layer."""
        if self.safety is not None:
            return self.safety.worst
        return people_at_worst(self.config)

    @property
    def horizon(self) -> int:
        """The prediction horizon [steps]; at least 1, also for controllers that do not predict."""
        return max(1, self.controller.horizon)
