"""What moves a crowd: all that giveway asks of a model of people."""

from typing import Protocol

from pedestrian_model.crowd import Crowd
from pedestrian_model.parameters import VciParameters
from pedestrian_model.surroundings import Surroundings
from pedestrian_model.vehicles import Vehicles


class PedestrianModel(Protocol):
    """Moves a crowd, step by step."""

    @property
    def parameters(self) -> VciParameters:
        """Bodies and limits of its people, whatever moves them."""

    @property
    def time_step(self) -> float:
        """[s]."""

    def advance(self, crowd: Crowd, vehicles: Vehicles, surroundings: Surroundings = ...) -> None:
        """Change position, velocity and waypoint_index of ``crowd`` in place, a time step on."""
