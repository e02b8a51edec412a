"""The manoeuvres that the actuator of a vehicle is capable of."""

from dataclasses import replace
from math import inf

from controller.actuator import Actuator
from controller.planning.parameters import PlannerParameters

_SPARE = 0.8  # share of the largest deceleration with which a manoeuvre counts on a stop


def within(p: PlannerParameters, actuator: Actuator, mass: float) -> PlannerParameters:
    """Return the parameters with the manoeuvres and forces that the actuator is capable of.

    Args:
        p: Parameters of the planner.
        actuator: Actuator of the vehicle.
        mass: Mass M [kg] of the model.
    """
    m, brake = p.manoeuvres, actuator.brake
    hardest = min(p.force_limit, brake.limit) / mass
    manoeuvres = replace(
        m,
        accelerations=tuple(max(a, -hardest) for a in m.accelerations),
        deceleration=min(m.deceleration, _SPARE * hardest),
        headway=m.headway + brake.lag,
    )
    return replace(p, force_limit=hardest * mass, manoeuvres=manoeuvres)


def jerks_of(actuator: Actuator, usual: float, mass: float) -> tuple[float, float]:
    """Return the jerks [m/s^3] with which accelerations can fall and rise.

    Args:
        actuator: Actuator of the vehicle.
        usual: Jerk [m/s^3] of manoeuvres.
        mass: Mass M [kg] of the model.
    """
    jerks = []
    for side in (actuator.brake, actuator.drive):
        lagging = _SPARE * _SPARE * side.limit / (mass * side.lag) if side.lag > 0.0 else inf
        jerks.append(min(usual, lagging, side.rate / mass))
    return jerks[0], jerks[1]
