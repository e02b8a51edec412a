"""What an ego reacts to at one instant."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.ego.foresight.crowd_foresight import CrowdForesight
from giveway.ego.kerbs import NO_KERBS
from giveway.ego.perception.leader import Leader
from giveway.geometry.kernel import Array
from pedestrian_model import Crowd

NOBODY: NDArray[np.int64] = np.empty(0, dtype=np.int64)


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
    numbers: NDArray[np.int64] | None = None  # (n,) of the crowd: a person keeps its number
    errors: Array | None = None  # (n,) [m] its positions are off at most; None: as perception says
    to_clear: float = 0.0  # [m] to be driven on to leave the crossings and junctions that it is on
    kerbs: Array = NO_KERBS  # (n, 3) of those on sidewalks
    hasty: NDArray[np.int64] = NOBODY  # numbers of who set out for the road too suddenly just now
