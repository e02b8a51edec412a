"""What the law of the road is judged by: one ego's tables, and what stood on its way."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath
from giveway.run_data.rows import STOP_SPEED
from giveway.run_data.tracks import BackgroundTrack, CrowdTrack, EgoTrack, PeopleTrack, SignalTrack
from giveway.run_data.way import EgoWay

NO_LIGHT = "O"
_SAME = 1e-6  # [s]


class Undisturbed(NamedTuple):
    """Where people were in the run's twin, in which they did not feel the ego; R records."""

    step: NDArray[np.int64]  # (R,) control instants, counted from the ego's first one
    pedestrian: NDArray[np.int64]  # (R,) as in the run's crowd
    x: Array  # (R,) [m]
    y: Array  # (R,) [m]


@dataclass(frozen=True)
class Drive:
    """One ego's drive.

    Attributes:
        ego: its track, T instants.
        shape: of its body.
        body_radius: of a pedestrian [m].
        way: with all that stood on it.
        crowd: everybody on foot, counted from the ego's first instant.
        people: where they mean to walk and how fast, counted likewise.
        signals: the traffic lights' changes.
        vehicles: all other vehicles.
        comfortable: deceleration [m/s^2] that a yellow light asks of it.
        goal: position [m] at which it leaves the road.
        stop_speed: it stands below it [m/s].
        undisturbed: the people of the run's twin; None: there is no twin.
    """

    ego: EgoTrack
    shape: VehicleShape
    body_radius: float
    way: EgoWay
    crowd: CrowdTrack
    people: PeopleTrack
    signals: SignalTrack
    vehicles: BackgroundTrack
    comfortable: float = 2.0
    goal: float = np.inf
    stop_speed: float = STOP_SPEED
    undisturbed: Undisturbed | None = None

    @cached_property
    def path(self) -> EgoPath:
        """The way's polyline."""
        return EgoPath.through(self.way.points)

    @cached_property
    def front(self) -> Array:
        """(T,) [m] station of the front bumper."""
        return self.ego.position + self.way.departure

    @property
    def end(self) -> float:
        """Station [m] at which the ego leaves the road."""
        return self.way.departure + self.goal

    def time_at(self, station: float) -> float:
        """When [s] the front bumper reaches ``station`` [m]; inf: never, -inf: before it departs.

        Straight between control instants.
        """
        beyond = np.flatnonzero(self.front >= station)
        if not len(beyond):
            return np.inf
        k = int(beyond[0])
        if k == 0:
            return -np.inf
        share = (station - self.front[k - 1]) / (self.front[k] - self.front[k - 1])
        return float(self.ego.time[k - 1] + share * (self.ego.time[k] - self.ego.time[k - 1]))

    def instants(self, time: Array) -> NDArray[np.int64]:
        """(n,) the latest control instant up to each ``time`` (n,) [s]; else the first."""
        found = np.searchsorted(self.ego.time, time + _SAME, side="right") - 1
        return np.asarray(np.maximum(found, 0), dtype=np.int64)

    def letters(self, system: str, link: int, time: Array) -> NDArray[np.str_]:
        """(n,) the letter of a light's movement at each ``time`` (n,) [s], ascending or not.

        Before the first record it is that of the first; a light without records is out.
        """
        mine = np.flatnonzero(self.signals.system == system)
        if not len(mine) or link < 0:
            return np.full(len(time), NO_LIGHT)
        states = self.signals.state[mine]
        letters = np.array([state[link] if link < len(state) else NO_LIGHT for state in states])
        place = np.searchsorted(self.signals.time[mine], time + _SAME, side="right") - 1
        return np.asarray(letters[np.maximum(place, 0)], dtype=np.str_)


def runs(mask: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """The stretches in which ``mask`` (n,) is true: first place, and the one after the last."""
    edges = np.diff(np.concatenate([[0], mask.astype(np.int8), [0]]))
    begins, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    return list(zip(begins.tolist(), ends.tolist(), strict=True))


def spread(time: Array, there: NDArray[np.bool_], before: float, after: float) -> NDArray[np.bool_]:
    """(T,) ``there`` from so long [s] before until so long [s] after."""
    hits = time[there]
    if not len(hits):
        return there
    following = np.minimum(np.searchsorted(hits, time - after - _SAME), len(hits) - 1)
    near = hits[following]
    return np.asarray((near >= time - after - _SAME) & (near <= time + before + _SAME))
