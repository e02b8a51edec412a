"""The cause for which a stationary ego is waiting."""

from controller import Decision
from giveway.ego.percept import Perceived

_NEAR = 3.0  # distance [m] beyond the one kept, within which an obstacle is what it waits for
_FREE = ("clear", "drive on")  # reasons of a planning controller that sees nobody in its way


def waits_for(
    front: float, kept: float, seen: Perceived, decision: Decision, eases_off: bool
) -> str:
    """Return why a stationary ego is waiting; it is empty when the ego drives off.

    Args:
        front: Station of its front bumper [m].
        kept: Distance [m] that the bumper keeps to whatever is in front.
        seen: What the ego reacts to.
        decision: Decision of its controller.
        eases_off: Whether it brakes less than a step before.
    """
    place, cause = min(
        (seen.pedestrian - front - kept, "person"),
        (seen.leader.station - front - kept, "vehicle"),
        (seen.stop - front, seen.stops_for),
    )
    if place <= _NEAR:
        return cause
    if decision.acting == "safety":
        return "person"
    if seen.ahead.size and seen.ahead.min() - front - kept <= 0.0:
        return "vehicle" if seen.predicted is None else "person"
    if decision.force > 0.0 or eases_off:
        return ""
    return "none" if decision.reason in _FREE else "plan"
