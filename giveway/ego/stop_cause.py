"""Finds why a stationary ego is waiting, for the column ``waits_for``."""

from controller import Decision, VehicleLayer
from giveway.ego.percept import Perceived

_NEAR = 3.0  # distance [m] beyond the kept one, within which an obstacle is the cause
_FREE = ("clear", "drive on")  # reasons of a planning controller with nobody in its way


def waits_for(
    front: float, kept: float, seen: Perceived, decision: Decision, eases_off: bool
) -> str:
    """Return why a stationary ego is waiting, or an empty text if the ego drives off.

    Args:
        front: Station of its front bumper [m].
        kept: Distance [m] that the bumper keeps to an obstacle.
        seen: Percept, rules and predictions that the ego reacts to.
        decision: Decision of its controller.
        eases_off: Whether the ego brakes less than a step before.
    """
    place, cause = min(
        (seen.pedestrian - front - kept, "person"),
        (seen.leader.station - front - kept, "vehicle"),
        (seen.stop - front, seen.stops_for),
    )
    if place <= _NEAR:
        return cause
    if decision.acting == "safety":
        return "vehicle" if decision.reason == VehicleLayer.REASON else "person"
    if seen.ahead.size and seen.ahead.min() - front - kept <= 0.0:
        return "vehicle" if seen.predicted is None else "person"
    if decision.force > 0.0 or eases_off:
        return ""
    return "none" if decision.reason in _FREE else "plan"
