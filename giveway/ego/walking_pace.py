"""The force at walking pace of a vehicle that creeps or feels the grade of the road."""

from math import sin

from controller.driving_constants import STANDING
from fmus import Vehicle
from fmus.checking import Standing

_GRAVITY = 9.81  # [m/s^2]
_PACE = 2.0  # speed [m/s] below which the force bears the weight; fully 1 m/s below it
_RELEASE = 1.0  # force [N] that lets the brakes go where the vehicle rolls by itself


class WalkingPace:
    """Adds to a controller's force what the controllers do not know: creep and weight.

    Otherwise a vehicle would not come to rest before the stop, or would roll back when it drives
    off. At a standstill its brakes are held (``hold`` of the profile).

    Args:
        mass: Mass M [kg] of the controllers' model.
        rests: Motion of the vehicle at rest.
        vehicle: Vehicle FMU.
    """

    def __init__(self, mass: float, rests: Standing, vehicle: Vehicle) -> None:
        self._weight = mass * _GRAVITY if vehicle.knows_grades else 0.0
        self._pull, self._creep = rests.creep_force if rests.hold else 0.0, rests.creep
        self._plain = self._weight == self._pull == 0.0

    def force(self, asked: float, speed: float, grade: float = 0.0) -> float:
        """Return the force [N] that is passed on to the vehicle.

        Args:
            asked: Force [N] of the controller.
            speed: Speed [m/s].
            grade: Grade [rad] of the road, uphill positive.
        """
        stands = speed <= STANDING
        if self._plain or speed >= _PACE or (stands and asked <= 0.0):
            return asked
        borne = asked + min(_PACE - speed, 1.0) * self._weight * sin(grade)
        if speed < self._creep:
            borne -= self._pull * (1.0 - max(speed, 0.0) / self._creep)
        return max(borne, min(asked, _RELEASE)) if stands else borne
