"""The crowd's flat records, grouped by pedestrian."""

import numpy as np
from numpy.typing import NDArray

from giveway.run_data.tracks import CrowdTrack
from giveway.run_data.walks import WalkTrack


class PedestrianGroups:
    """Reductions over each pedestrian's records; results are (n,), and nan without records.

    ``order`` (R,) sorts the records by pedestrian, and by time within a pedestrian. Pedestrian i
    owns the entries ``bounds[i]`` to ``bounds[i + 1]`` of it.
    """

    def __init__(self, crowd: CrowdTrack | WalkTrack) -> None:
        self.order = np.argsort(crowd.pedestrian, kind="stable")
        self.pedestrian = crowd.pedestrian[self.order]
        self.bounds = np.searchsorted(self.pedestrian, np.arange(len(crowd.ids) + 1))
        self.present = np.diff(self.bounds) > 0
        self.first = self.bounds[:-1][self.present]
        self.last = self.bounds[1:][self.present] - 1

    def at(self, values: NDArray[np.float64], places: NDArray[np.intp]) -> NDArray[np.float64]:
        """Return the value at one place in ``order`` per present pedestrian; ``values`` is (R,)."""
        return self._spread(values[self.order[places]])

    def total(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the sum of the values (R,) of each pedestrian, added up in the order of time."""
        sums = np.bincount(self.pedestrian, values[self.order], minlength=self.present.size)
        return np.where(self.present, sums, np.nan)

    def first_minimum(self, values: NDArray[np.float64]) -> NDArray[np.intp]:
        """Return the earliest place in ``order`` of each present pedestrian's smallest value."""
        if not self.first.size:
            return self.first
        ordered = values[self.order]
        smallest = np.minimum.reduceat(ordered, self.first)
        hits = ordered == np.repeat(smallest, self.last - self.first + 1)
        places = np.where(hits, np.arange(ordered.size), ordered.size)
        return np.minimum.reduceat(places, self.first)

    def walked(self, crowd: CrowdTrack) -> NDArray[np.float64]:
        """Return the distance [m] of each record (R,) to the same pedestrian's previous record.

        The first record has 0. Two records with a gap in time are joined by a straight line.
        """
        x, y = crowd.x[self.order], crowd.y[self.order]
        distance = np.zeros(x.size)
        distance[1:] = np.hypot(np.diff(x), np.diff(y))
        distance[self.first] = 0.0
        walked = np.empty(x.size)
        walked[self.order] = distance
        return walked

    def _spread(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        spread = np.full(self.present.size, np.nan)
        spread[self.present] = values
        return spread
