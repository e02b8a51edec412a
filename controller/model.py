"""The vehicle model of the controllers: longitudinal, linear, discrete in time."""

from dataclasses import dataclass

from controller.defaults import TIME_STEP
from controller.parameters import require_not_negative, require_positive


@dataclass(frozen=True, slots=True)
class LongitudinalModel:
    """M s'' + alpha s' = u by forward Euler (Yang & Özgüner 2019, eqs. (2) and (3)).

    The state is x = [position [m], speed [m/s]]. The input u is a force [N].

    Raises:
        ParameterError: a value is not finite or out of range.
    """

    mass: float = 1000.0  # M [kg]
    friction: float = 100.0  # alpha [N s/m]
    time_step: float = TIME_STEP  # dt [s]

    def __post_init__(self) -> None:
        require_positive("mass", self.mass, "kg")
        require_not_negative("friction", self.friction, "N s/m")
        require_positive("time_step", self.time_step, "s")

    @property
    def decay(self) -> float:
        """The share of the speed that is left after a step without force: 1 - alpha dt / M."""
        return 1.0 - self.friction * self.time_step / self.mass

    @property
    def speed_per_force(self) -> float:
        """The speed that a unit force adds in a step: dt / M [(m/s)/N]."""
        return self.time_step / self.mass
