"""People before whom their way ends: they walk on off the walkways.

Networks have routes over places that are not for walking: dead ends, missing crossings, gaps
between the shapes of lanes. People also get pushed past a corner. A person there, with the next
way-point behind the edge of the walkways, would stay for ever. After some seconds without progress,
edges do not hold this person any more on the way to the next way-point.
"""

import math

import numpy as np
import shapely
from numpy.typing import NDArray

from giveway.crowd.roster import Roster
from giveway.geometry.kernel import Array
from pedestrian_model import OFF_WALKWAYS, Surroundings, targets

_EVERY = 1.0  # time [s] between two looks at everybody
_PROGRESS = 0.5  # distance [m] by which a person comes nearer to a way-point to make progress
_PATIENCE = 5.0  # time [s] without progress after which a person may leave the walkways; own choice
_CLOSE = 0.5  # distance [m] to a wall that may hold somebody; own choice
_INTO = 0.3  # least cosine of the angle between a way and a wall's back that it presses on


class Impasses:
    """Finds people whom the edge of the walkways holds for good, and lets them walk on.

    Args:
        roster: Crowd and its people.
        surroundings: Walls and lights.
        walkable: Area in which people can walk.
    """

    def __init__(
        self, roster: Roster, surroundings: Surroundings, walkable: shapely.MultiPolygon
    ) -> None:
        self._roster, self._surroundings = roster, surroundings
        self._walkable = walkable
        self._next = -math.inf  # time [s] of the next look
        # Of each person that ever was in the crowd: way-point, least distance to it, since when
        self._waypoint = np.empty(0, dtype=np.int64)
        self._least, self._since = np.empty(0), np.empty(0)
        shapely.prepare(walkable)

    def update(self, time: float) -> None:
        """Let people walk on whose way has been blocked for some seconds.

        Args:
            time: SUMO's clock [s].
        """
        roster = self._roster
        if time < self._next or not len(roster):
            return
        self._next = time + _EVERY
        crowd, there = roster.crowd, targets(roster.crowd, np.arange(len(roster)))
        rows = self._without_progress(time, there)
        if not len(rows):
            return
        at = crowd.waypoint_start[rows] + crowd.waypoint_index[rows]
        # kerbs with a light or a gap keep their signals
        at, rows = (one[crowd.waypoint_signal[at] < 0] for one in (at, rows))
        here, there = crowd.position[rows], there[rows]
        blocked = ~shapely.covers(self._walkable, shapely.linestrings(np.stack([here, there], 1)))
        blocked |= self._presses(here, there)
        crowd.waypoint_signal[at[blocked]] = OFF_WALKWAYS

    def _without_progress(self, time: float, there: Array) -> NDArray[np.int64]:
        """Return the rows of people who have not come nearer to ``there`` (n, 2) [m] for long."""
        roster, more = self._roster, len(self._roster.ids) - len(self._since)
        if more > 0:
            self._waypoint = np.append(self._waypoint, np.full(more, -1, dtype=np.int64))
            self._least = np.append(self._least, np.zeros(more))
            self._since = np.append(self._since, np.zeros(more))
        who, index = roster.person_ids, roster.crowd.waypoint_index
        left = np.hypot(*(there - roster.crowd.position).T)
        nearer = (index != self._waypoint[who]) | (left < self._least[who] - _PROGRESS)
        self._waypoint[who] = index
        self._least[who[nearer]], self._since[who[nearer]] = left[nearer], time
        return np.flatnonzero(time - self._since[who] >= _PATIENCE)

    def _presses(self, here: Array, there: Array) -> NDArray[np.bool_]:
        """Return whether each way (k,) leads into a wall that is close."""
        walls = self._surroundings.walls
        assert walls is not None
        distance, normal = walls.nearest(here)
        way = there - here
        way /= np.maximum(np.hypot(way[:, 0], way[:, 1]), 1e-9)[:, None]
        into: NDArray[np.bool_] = (way * normal).sum(axis=1) < -_INTO
        return (distance < _CLOSE) & into
