"""People who wait for a gap stay off the roadway, whoever pushes them. This works with any model.

Other people and passing vehicles would push them onto the roadway, where vehicles stop for them
while they wait for the vehicles. Those who have come to the kerb stand there, and give way to
others slowly. Those who do not cross are not pushed onto a crossing either: they slide along it.
"""

import numpy as np
import shapely
from numpy.typing import NDArray

from giveway.crowd.motion.beside_cars import keep_off
from giveway.crowd.motion.neighbours import AroundModel
from giveway.geometry.kernel import Array
from pedestrian_model import (
    OFF_WALKWAYS,
    OPEN_GROUND,
    Crowd,
    PedestrianModel,
    Surroundings,
    Vehicles,
    targets,
)

_AT_KERB = 0.4  # distance [m] to the way-point at the kerb within which people stand; own choice
_SHUFFLES = 0.3  # share of their motion that people who stand make, as others push; own choice
_STEPS_BACK = 2.0  # speed [m/s] at which people step back from cars that turn; own choice
_SOON = 3.0  # time [s] before a car's arrival from which on they do; own choice
_ON_EDGE = 0.02  # distance [m] to the edge of a sidewalk within which people are on it
_NEAR = 5.0  # distance [m] to a car within which they do so, too; own choice

NOWHERE: shapely.Geometry = shapely.Polygon()


class HeldAtKerb(AroundModel):
    """A model whose people do not leave the sidewalk at a kerb at which they wait for a gap.

    Args:
        model: Model that moves all people.
        first: First of the signals at which people wait for a gap; as many open ones come after
            these signals.
        count: Number of these signals.
        sidewalks: Sidewalks and walkingareas around the kerbs.
        swept: Place beside the kerbs over which cars pass as they turn. People who do not cross
            step back from it.
        crossings: The crossings. People who do not cross do not leave the sidewalk for them.

    Attributes:
        free: Place that people who wait for a gap do not leave.
    """

    free: shapely.Geometry

    def __init__(
        self,
        model: PedestrianModel,
        first: int,
        count: int,
        sidewalks: shapely.Geometry,
        swept: shapely.Geometry = NOWHERE,
        crossings: shapely.Geometry = NOWHERE,
    ) -> None:
        super().__init__(model)
        self._first, self._count = first, count
        self.free = sidewalks - swept if swept.intersects(sidewalks) else sidewalks
        self._swept, self._crossings = swept & sidewalks, crossings - self.free
        shapely.prepare((self.free, self._swept, self._crossings))

    def advance(
        self, crowd: Crowd, vehicles: Vehicles, surroundings: Surroundings = OPEN_GROUND
    ) -> None:
        """Step the crowd in place."""
        at = crowd.waypoint_start[:-1] + crowd.waypoint_index
        signal = crowd.waypoint_signal[at]
        for_gap = (signal >= self._first) & (signal < self._first + self._count)
        rows = np.flatnonzero(for_gap & surroundings.closed[signal])
        before = crowd.position[rows]
        aside, places = self._not_crossing(crowd, at), crowd.position.copy()
        self._model.advance(crowd, vehicles, surroundings)
        if len(rows):
            self._stand(crowd, rows, before)
            left = ~shapely.contains_xy(self.free, crowd.position[rows])
            left &= shapely.contains_xy(self.free, before)
            crowd.position[rows[left]] = before[left]
            crowd.velocity[rows[left]] = 0.0
        if len(crowd):
            most = _STEPS_BACK * self.time_step
            radius = self.parameters.body_radius
            keep_off(crowd.position, crowd.velocity, vehicles, radius, most)
        self._keep_from_crossings(crowd, aside, places)
        if not self._swept.is_empty:
            self._step_back(crowd, aside, places, vehicles)

    def _not_crossing(self, crowd: Crowd, at: NDArray[np.int64]) -> NDArray[np.intp]:
        """Return the rows of people who are not on a crossing, and do not go onto it now."""
        signal, first, count = crowd.waypoint_signal, self._first, self._count
        goes = (signal[at] >= first + count) & (signal[at] < first + 2 * count)
        goes |= signal[at] == OFF_WALKWAYS
        last = signal[at - 1]
        goes |= (crowd.waypoint_index > 0) & (last >= first) & (last < first + 2 * count)
        return np.flatnonzero(~goes)

    def _keep_from_crossings(self, crowd: Crowd, rows: NDArray[np.intp], before: Array) -> None:
        """Let people who were pushed onto a crossing slide along its kerb instead."""
        rows = rows[shapely.contains_xy(self._crossings, crowd.position[rows])]
        came = shapely.dwithin(shapely.points(before[rows]), self.free, _ON_EDGE)
        rows = rows[came]
        if not len(rows):
            return
        ways = shapely.shortest_line(shapely.points(crowd.position[rows]), self.free)
        crowd.position[rows] = shapely.get_coordinates(ways).reshape(-1, 2, 2)[:, 1]
        crowd.velocity[rows] = (crowd.position[rows] - before[rows]) / self.time_step

    def _step_back(
        self, crowd: Crowd, rows: NDArray[np.intp], before: Array, vehicles: Vehicles
    ) -> None:
        """Let people keep off the place over which a car is about to turn."""
        rows = rows[shapely.contains_xy(self._swept, crowd.position[rows])]
        rows = rows[_meet(crowd.position[rows], vehicles)] if len(rows) else rows
        if not len(rows):
            return
        came = shapely.contains_xy(self.free, before[rows])  # who crossed goes on
        crowd.position[rows[came]] = before[rows[came]]
        crowd.velocity[rows[came]] = 0.0
        rows = rows[~came]
        here = before[rows]
        ways = shapely.shortest_line(shapely.points(here), self.free)
        way = shapely.get_coordinates(ways).reshape(-1, 2, 2)[:, 1] - here
        far = np.maximum(np.hypot(*way.T), 1e-9)[:, None]
        most = _STEPS_BACK * self.time_step
        crowd.position[rows] = here + way / far * np.minimum(far, most)
        crowd.velocity[rows] = 0.0

    def _stand(self, crowd: Crowd, rows: NDArray[np.intp], before: Array) -> None:
        """Let people at the kerb stand, and give way to others slowly."""
        goal, now = targets(crowd, rows), crowd.position[rows]
        stands = np.hypot(*(goal - now).T) < _AT_KERB
        crowd.position[rows[stands]] = before[stands] + _SHUFFLES * (now - before)[stands]


def _meet(places: Array, vehicles: Vehicles) -> NDArray[np.bool_]:
    """Return whether a vehicle is near each place (k, 2) [m], or soon."""
    x, y, _, speed = vehicles.array[:, :4].T
    reach = _NEAR + _SOON * np.abs(speed)
    away = np.hypot(places[:, None, 0] - x, places[:, None, 1] - y)
    return np.asarray((away <= reach).any(axis=1))
