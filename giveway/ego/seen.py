"""What an ego reacts to at one instant, and what it stands for."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from controller import Decision
from giveway.ego.foresight import CrowdForesight
from giveway.ego.leader import Leader
from giveway.geometry.kernel import Array
from pedestrian_model import Crowd

_NEAR = 3.0  # [m] in addition to the distance kept: what is so near is what the ego stands for
_FREE = ("clear", "drive on")  # reasons of a planning controller that sees nobody in its way


class Seen(NamedTuple):
    """What the ego reacts to at one instant."""

    pedestrian: float  # station [m] of the closest pedestrian in front; inf: none
    leader: Leader
    stop: float  # station [m] where the front bumper has to stop; inf: nowhere
    stops_for: str  # what asks for that: "light", "stop" or "yield"; empty: nothing
    ahead: Array  # (N,) stations [m] of the closest obstacle at steps 1 ... N
    predicted: Array | None  # (N, n, 2) [m] positions at steps 1 ... N, until the next look
    relevant: NDArray[np.bool_] | None  # (n,) who has been predicted; None: the whole crowd
    closest: float  # station [m] as ``pedestrian``, but of the true positions: for the tables
    crowd: Crowd  # the pedestrians as they are seen
    foresight: (
        CrowdForesight | None
    )  # for a controller that foresees, if a pedestrian may come in front
    poses: Array  # (N, m, 7) of all vehicles at steps 0 ... N-1
    row: int  # the ego's among them


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
