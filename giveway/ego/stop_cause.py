"""What an ego that stands stands for."""

from controller import Decision
from giveway.ego.percept import Seen

_NEAR = 3.0  # [m] in addition to the distance kept: what is so near is what the ego stands for
_FREE = ("clear", "drive on")  # reasons of a planning controller that sees nobody in its way


def waits_for(front: float, kept: float, seen: Seen, decision: Decision, eases_off: bool) -> str:
    """What an ego that stands stands for; empty when it drives off.

    Args:
        front: station of its front bumper [m].
        kept: distance [m] from there that it keeps to who is in front.
        seen: what it reacts to.
        decision: its controller's.
        eases_off: it brakes less than a step before.
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
