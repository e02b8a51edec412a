"""The priority of pedestrians on zebras and at their green light.

People on such a crossing have priority, and so do people who are about to enter an open one.
Priority fades over the first metre behind the crossing, so that no force begins abruptly.
"""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from giveway.crowd.crossings import (
    ASIDE,
    KERB_DISTANCE,
    have_priority,
    is_near,
    is_open,
    place_on,
    use_of,
)
from giveway.sumo.network.pedestrian_crossings import Crossing
from pedestrian_model import Crowd

_FADE = 1.0  # distance [m] behind a crossing over which priority fades
_REACH = max(KERB_DISTANCE, _FADE)  # distance [m] from a crossing at which people are examined
_CELL = 16.0  # cell size [m] of the grid in which crossings are found
_MOST_CELLS = 2**20  # largest number of cells; larger networks have larger cells


class PriorityOnFoot:
    """Sets the priority of the pedestrians of a crowd.

    Args:
        crossings: Crossings of the network.
        light_state: Function that returns the state of a traffic light by its id.
    """

    def __init__(
        self,
        crossings: Sequence[Crossing],
        light_state: Callable[[str], str],
    ) -> None:
        own = [crossing for crossing in crossings if crossing.zebra]
        ends = np.array([crossing.ends for crossing in own]).reshape(-1, 2, 2)
        way = ends[:, 1] - ends[:, 0]
        length = np.hypot(way[:, 0], way[:, 1])
        real = length > 0.0
        self._crossings = [crossing for crossing, is_real in zip(own, real, strict=True) if is_real]
        self._kerb, self._length = ends[real, 0], length[real]
        self._along = way[real] / self._length[:, None]
        width = np.array([crossing.width for crossing in self._crossings])
        self._half_width = width / 2.0 + ASIDE
        self._light_state = light_state
        if len(self._crossings):
            self._sort()

    def __len__(self) -> int:
        """The number of crossings on which people can have priority."""
        return len(self._crossings)

    def _sort(self) -> None:
        """Sort the crossings into the cells of a grid that they reach into."""
        middle = self._kerb + self._along * self._length[:, None] / 2.0
        along = np.abs(self._along)
        half = along * (self._length[:, None] / 2.0 + _REACH)
        half += along[:, ::-1] * self._half_width[:, None]
        low, high = middle - half, middle + half
        self._origin = low.min(axis=0)
        size = high.max(axis=0) - self._origin
        self._side = _CELL
        while np.prod(size / self._side + 1.0) > _MOST_CELLS:
            self._side *= 2.0
        self._columns, self._strips = (int(cells) + 1 for cells in size / self._side)
        first = ((low - self._origin) / self._side).astype(np.int64)
        last = ((high - self._origin) / self._side).astype(np.int64)
        cells: list[int] = []
        within: list[int] = []
        for number, (begin, end) in enumerate(zip(first.tolist(), last.tolist(), strict=True)):
            for strip in range(begin[1], end[1] + 1):
                for column in range(begin[0], end[0] + 1):
                    cells.append(strip * self._columns + column)
                    within.append(number)
        order = np.argsort(cells, kind="stable")
        self._sorted = np.array(within, dtype=np.int64)[order]
        count = np.bincount(cells, minlength=self._columns * self._strips)
        self._first = np.concatenate([[0], np.cumsum(count)])

    def update(self, crowd: Crowd) -> None:
        """Set ``crowd.priority`` to the present priorities."""
        crowd.priority[:] = 0.0
        if not len(crowd) or not self._crossings:
            return
        rows, which = self._pairs(crowd)
        if not len(rows):
            return
        u, w = place_on(crowd.position[rows], self._kerb[which], self._along[which])
        near = is_near(u, w, self._length[which], self._half_width[which], _REACH)
        if not near.any():
            return
        rows, which, u = rows[near], which[near], u[near]
        length = self._length[which]
        use = use_of(crowd, rows, u, self._along[which], length)
        outside = np.maximum(-u, u - length)
        own = have_priority(use, self._are_open(which)) & (outside <= KERB_DISTANCE)
        fading = np.where(use.leaving, np.maximum(0.0, 1.0 - outside / _FADE), 0.0)
        np.maximum.at(crowd.priority, rows, np.where(own, 1.0, fading))

    def _pairs(self, crowd: Crowd) -> tuple[NDArray[np.intp], NDArray[np.int64]]:
        """Return the indices (k,) of people and of crossings that share a cell."""
        column = np.floor((crowd.position[:, 0] - self._origin[0]) / self._side)
        strip = np.floor((crowd.position[:, 1] - self._origin[1]) / self._side)
        inside = (column >= 0) & (column < self._columns) & (strip >= 0) & (strip < self._strips)
        rows = np.flatnonzero(inside)
        cell = (strip[rows] * self._columns + column[rows]).astype(np.int64)
        first = self._first[cell]
        count = self._first[cell + 1] - first
        rows, first, count = rows[count > 0], first[count > 0], count[count > 0]
        ends = np.cumsum(count)
        total = int(ends[-1]) if len(ends) else 0
        at = np.arange(total) + np.repeat(first - (ends - count), count)
        return np.repeat(rows, count), self._sorted[at]

    def _are_open(self, which: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Return whether people may enter each of these crossings (k,) now."""
        states: dict[str, str] = {"": ""}
        open_now: dict[int, bool] = {}
        for number in which.tolist():
            if number in open_now:
                continue
            crossing = self._crossings[number]
            if crossing.system not in states:
                states[crossing.system] = self._light_state(crossing.system)
            state = states[crossing.system]
            open_now[number] = is_open(state, crossing.link, zebra=crossing.zebra)
        return np.array([open_now[number] for number in which.tolist()], dtype=np.bool_)
