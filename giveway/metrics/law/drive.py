"""The input of the judgement: one ego's tables, and the rules along its path."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from controller.driving_constants import COMFORTABLE, STANDING
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath
from giveway.run_data.tracks import BackgroundTrack, CrowdTrack, EgoTrack, PeopleTrack, SignalTrack
from giveway.run_data.way import EgoWay

NO_LIGHT = "O"
_SAME = 1e-6  # Difference [s] up to which two instants are one


class Undisturbed(NamedTuple):
    """The positions of the people in the counterfactual run, in which they did not feel the ego."""

    step: NDArray[np.int64]  # (R,) control instants, counted from the ego's first one
    pedestrian: NDArray[np.int64]  # (R,) index of the person, as in the run's crowd
    x: Array  # (R,) [m]
    y: Array  # (R,) [m]


@dataclass(frozen=True)
class Drive:
    """One ego's drive.

    Attributes:
        ego: Track of the ego, T instants.
        shape: Shape of its body.
        body_radius: Body radius of a pedestrian [m].
        way: Path with the crossings, lights, junctions and stops on it.
        crowd: People on foot, counted from the ego's first instant.
        people: Routes and desired speeds of the people, from the same instant.
        signals: Changes of the traffic lights.
        vehicles: All other vehicles.
        comfortable: Deceleration [m/s^2] that the ego must be ready to use at a yellow light.
        goal: Position [m] at which the ego leaves the road.
        stop_speed: Speed [m/s] below which the ego stands.
        undisturbed: People of the counterfactual run, or None without one.
    """

    ego: EgoTrack
    shape: VehicleShape
    body_radius: float
    way: EgoWay
    crowd: CrowdTrack
    people: PeopleTrack
    signals: SignalTrack
    vehicles: BackgroundTrack
    comfortable: float = COMFORTABLE
    goal: float = np.inf
    stop_speed: float = STANDING
    undisturbed: Undisturbed | None = None

    @cached_property
    def path(self) -> EgoPath:
        """Polyline of the path."""
        return EgoPath.through(self.way.points)

    @cached_property
    def front(self) -> Array:
        """Station (T,) [m] of the front bumper."""
        return self.ego.position + self.way.departure

    @property
    def end(self) -> float:
        """Station [m] at which the ego leaves the road."""
        return self.way.departure + self.goal

    def time_at(self, station: float) -> float:
        """Return the time [s] at which the front reaches ``station`` [m].

        It is inf if the front never does, and -inf if it was there before departure. Between
        control instants it is interpolated linearly.
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
        """Return the latest control instant (n,) up to each ``time`` (n,) [s], or the first one."""
        found = np.searchsorted(self.ego.time, time + _SAME, side="right") - 1
        return np.asarray(np.maximum(found, 0), dtype=np.int64)

    def letters(self, system: str, link: int, time: Array) -> NDArray[np.str_]:
        """Return the letter (n,) of a movement's light at each ``time`` (n,) [s], in any order.

        Before the first record, the first one counts. A light without records is off.
        """
        mine = np.flatnonzero(self.signals.system == system)
        if not len(mine) or link < 0:
            return np.full(len(time), NO_LIGHT)
        states = self.signals.state[mine]
        letters = np.array([state[link] if link < len(state) else NO_LIGHT for state in states])
        place = np.searchsorted(self.signals.time[mine], time + _SAME, side="right") - 1
        return np.asarray(letters[np.maximum(place, 0)], dtype=np.str_)


def spread(time: Array, there: NDArray[np.bool_], before: float, after: float) -> NDArray[np.bool_]:
    """Extend the instants ``there`` (T,) by the times ``before`` and ``after`` [s]."""
    hits = time[there]
    if not len(hits):
        return there
    following = np.minimum(np.searchsorted(hits, time - after - _SAME), len(hits) - 1)
    near = hits[following]
    return np.asarray((near >= time - after - _SAME) & (near <= time + before + _SAME))
