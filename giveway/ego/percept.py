"""Everything that an ego reacts to at one instant."""

from dataclasses import dataclass, field
from math import inf

import numpy as np
from numpy.typing import NDArray

from controller import VehicleAhead
from giveway.ego.foresight.crowd_foresight import CrowdForesight
from giveway.ego.perception.hidden_people import NOWHERE, Hidden
from giveway.ego.perception.kerbs import NO_KERBS
from giveway.ego.perception.leader import NO_LEADER, Leader
from giveway.ego.perception.protocol import Percept
from giveway.ego.perception.sights import NO_CHANGES
from giveway.geometry.kernel import Array
from pedestrian_model import Crowd

NOBODY: NDArray[np.int64] = np.empty(0, dtype=np.int64)


@dataclass(slots=True)
class Perceived:
    """Everything that an ego reacts to at one instant: one object, refilled in place.

    Attributes:
        percept: Pedestrians as the ego perceives them.
        ids: Index (n,) of each of them in the roster, negative for false detections.
        pedestrian: Station [m] of the closest perceived pedestrian in front; inf without one.
        closest: Station [m] of the closest pedestrian of the truth in front, for the tables.
        leader: Vehicle in front.
        followed: Vehicle ahead that drives the same way or stands, or None without one.
        stop: Station [m] at which the front bumper has to stop; inf if it need not stop.
        stops_for: Cause of the stop, "light", "stop" or "yield"; empty without one.
        ahead: Stations (N,) [m] of the closest obstacle at steps 1 ... N.
        predicted: Positions (N, n, 2) [m] at steps 1 ... N, or None. The next look reuses them.
        relevant: Marks (n,) of the perceived people who are predicted, or None if all are.
        foresight: Foresight for a controller that asks for it, or None if nobody can come in front.
        poses: Poses (N, m, 7) of all vehicles at steps 0 ... N-1.
        row: Row of the ego among the vehicles.
        to_clear: Keep-clear distance [m]: distance to drive until the zone is free.
        kerbs: Kerbs (n, 3) of the people on sidewalks.
        hidden: Places ahead where people could come out of hiding.
        sights: Who comes in sight or is lost from sight, as
            :meth:`~giveway.ego.perception.sights.Sights.changes` returns it.
        sudden_starts: Ids of the people who violate the safety layer's assumption now, by a sudden
            start.
    """

    percept: Percept = field(default_factory=lambda: Percept(Crowd.empty(), NOBODY))
    ids: NDArray[np.int64] = field(default_factory=lambda: NOBODY)
    pedestrian: float = inf
    closest: float = inf
    leader: Leader = NO_LEADER
    followed: VehicleAhead | None = None
    stop: float = inf
    stops_for: str = ""
    ahead: Array = field(default_factory=lambda: np.empty(0))
    predicted: Array | None = None
    relevant: NDArray[np.bool_] | None = None
    foresight: CrowdForesight | None = None
    poses: Array = field(default_factory=lambda: np.empty((1, 1, 7)))
    row: int = 0
    to_clear: float = 0.0
    kerbs: Array = field(default_factory=lambda: NO_KERBS)
    hidden: Hidden = NOWHERE
    sights: Array = field(default_factory=lambda: NO_CHANGES)
    sudden_starts: NDArray[np.int64] = field(default_factory=lambda: NOBODY)
