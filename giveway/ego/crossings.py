"""Giving way at crossings: a place before each at which the ego waits for those with priority.

Whoever is on a crossing, or stands at its kerb and wants to cross, has priority where it is a zebra
or their light is green; who is still on it when the light changes may finish. The Vienna Convention
on Road Traffic (1968, art. 21) asks no more: "give way to pedestrians who are using the crossing or
about to use it". The ego stops before the crossing, not on it, and does not drive onto one that the
vehicle ahead keeps it from leaving (art. 18.2).
"""

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.crowd.crossings import ASIDE, have_priority, is_near, is_open, place_on, use_of
from giveway.ego.leader import NO_LEADER, Leader
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath
from giveway.sumo.crossings import Crossing
from pedestrian_model import Crowd

HARDEST = 3.0  # [m/s^2] braking that anybody who wants to cross may ask of the ego
STOP_BEFORE = 1.0  # [m] before the crossing the front bumper is to stand
_SAMPLE = 0.1  # [m] between the points of the path that are looked at
_BESIDE = 0.8  # [m] from the ego's side to the middle of somebody who is not in its way
_BEFORE, _AFTER = 1.0, 0.5  # [s] between the ego and whoever passes its way after or before it
_PATIENCE = 4.5  # [s] away from the ego's way, and a little more than an encounter's 4 s
_PULL_AWAY = 1.5  # [m/s^2] of the ego that has waited
_GAP = 1.0  # [m] behind the ego once it has left a crossing
_CRAWLING = 2.0  # [m/s] a vehicle ahead that is slower may come to a stand
_SIGHT = 60.0  # [m] before a crossing from which on people are looked at


class PathCrossing(NamedTuple):
    """A crossing that a path leads over, in the crossing's own coordinates."""

    entry: float  # [m] the path's first station on it
    exit: float  # [m] and its last
    kerb: Array  # (2,) [m] one end of the crossing's middle line
    along: Array  # (2,) unit vector to its other end
    length: float  # [m] between the kerbs
    half_width: float  # [m]
    low: float  # [m] from the kerb, where the path's way over it begins, for a body's middle
    high: float  # [m] and where it ends
    zebra: bool
    system: str
    link: int


def crossings_on(
    path: EgoPath, shape: VehicleShape, crossings: Sequence[Crossing]
) -> tuple[PathCrossing, ...]:
    """The crossings that a path leads over, in its order.

    Args:
        path: the ego's.
        shape: of its body.
        crossings: of the network.
    """
    if not crossings:
        return ()
    stations = np.arange(0.0, path.length, _SAMPLE)
    points = np.column_stack(
        [np.interp(stations, path.stations, path.vertices[:, axis]) for axis in range(2)]
    )
    found: list[PathCrossing] = []
    for crossing in crossings:
        kerb, other = crossing.ends
        length = float(np.hypot(*(other - kerb)))
        if length <= 0.0:
            continue
        along = (other - kerb) / length
        u, w = place_on(points, kerb, along)
        inside = (u >= 0.0) & (u <= length) & (np.abs(w) <= crossing.width / 2)
        for visit in _runs(inside):
            # how much wider the body's way over the crossing is than the body
            over = w[visit[-1]] - w[visit[0]]
            skew = max(1.0, math.hypot(over, u[visit[-1]] - u[visit[0]]) / max(abs(over), 1.0))
            half = shape.width / 2 * skew + _BESIDE
            found.append(
                PathCrossing(
                    float(stations[visit[0]]),
                    float(stations[visit[-1]]),
                    kerb,
                    along,
                    length,
                    crossing.width / 2 + ASIDE,
                    float(u[visit].min()) - half,
                    float(u[visit].max()) + half,
                    crossing.zebra,
                    crossing.system,
                    crossing.link,
                )
            )
    return tuple(sorted(found, key=lambda place: place.entry))


def _runs(inside: NDArray[np.bool_]) -> list[NDArray[np.intp]]:
    """The stretches of two points or more that are inside."""
    places = np.flatnonzero(inside)
    if not len(places):
        return []
    pieces = np.split(places, np.flatnonzero(np.diff(places) > 1) + 1)
    return [piece for piece in pieces if len(piece) > 1]


class Crossings:
    """Watches the crossings on one ego's path.

    Args:
        crossings: in the order of the path.
        length: of the ego's body [m].
        kerb_distance: [m] from the kerb, from which on somebody who heads for a crossing is about
            to enter it.

    Attributes:
        systems: SUMO's ids of the traffic lights that govern them.
    """

    def __init__(
        self,
        crossings: Sequence[PathCrossing],
        *,
        length: float,
        kerb_distance: float,
    ) -> None:
        self._crossings = tuple(crossings)
        self._length = length
        self._kerb_distance = kerb_distance
        self._next = 0
        self._waiting = False  # at the next crossing, since it could stop there
        self._states: Mapping[str, str] = {}
        self.systems = frozenset(place.system for place in self._crossings if place.system)

    def update(self, states: Mapping[str, str]) -> None:
        """Take note of the lights' states: of each system, one letter per movement (SUMO's)."""
        self._states = states

    def stop_at(
        self, front: float, speed: float, crowd: Crowd, leader: Leader = NO_LEADER
    ) -> float:
        """Station [m] at which the front bumper has to stop; inf: nowhere.

        Args:
            front: station of the front bumper [m].
            speed: [m/s].
            crowd: the pedestrians as the ego sees them.
            leader: the vehicle ahead.
        """
        while self._next < len(self._crossings) and self._crossings[self._next].entry < front:
            self._next += 1
            self._waiting = False
        for number in range(self._next, len(self._crossings)):
            place = self._crossings[number]
            if place.entry - front > _SIGHT:
                break
            needed = speed * speed / (2.0 * max(place.entry - front, 1e-3))
            waiting = self._waiting and number == self._next
            if not waiting and needed > HARDEST:
                continue
            yields = self._is_wanted(number, front, speed, crowd)
            if yields or self._is_blocked(place, leader):
                self._waiting = self._waiting or number == self._next
                return max(place.entry - STOP_BEFORE, min(front, place.entry))
            if number == self._next:
                self._waiting = False
        return math.inf

    def _is_blocked(self, place: PathCrossing, leader: Leader) -> bool:
        """Whether the vehicle ahead leaves no room behind the crossing."""
        room = leader.station - place.exit
        return (
            leader.speed < _CRAWLING
            and leader.station > place.entry
            and room < self._length + _GAP + leader.speed
        )

    def _is_wanted(self, number: int, front: float, speed: float, crowd: Crowd) -> bool:
        """Whether somebody with priority and the ego would be on its way over it together."""
        place = self._crossings[number]
        if not len(crowd):
            return False
        u, w = place_on(crowd.position, place.kerb, place.along)
        near = is_near(u, w, place.length, place.half_width, self._kerb_distance)
        if not near.any():
            return False
        rows = np.flatnonzero(near)
        u = u[rows]
        use = use_of(crowd, rows, u, place.along, place.length)
        state = self._states.get(place.system, "")
        coming = have_priority(use, is_open(state, place.link, zebra=place.zebra))
        direction = np.where(use.onward >= 0.0, 1.0, -1.0)
        to_go = np.where(direction > 0.0, place.low - u, u - place.high)
        to_leave = np.where(direction > 0.0, place.high - u, u - place.low)
        pace = np.maximum(crowd.desired_speed[rows], 0.1)
        arrives, leaves = to_go / pace, to_leave / pace
        enters, clears = self._own_times(place, front, speed)
        first = leaves + (_BEFORE if speed > _CRAWLING else _AFTER) < enters
        later = arrives > max(clears + _BEFORE, _PATIENCE)
        return bool((coming & (to_leave > 0.0) & ~first & ~later).any())

    def _own_times(self, place: PathCrossing, front: float, speed: float) -> tuple[float, float]:
        """When [s] the ego would enter the crossing and have left it, if it went on."""
        entry, left = place.entry - front, place.exit + self._length - front
        if speed > _CRAWLING:
            return entry / speed, left / speed
        a = _PULL_AWAY
        return (
            (math.sqrt(speed * speed + 2.0 * a * max(entry, 0.0)) - speed) / a,
            (math.sqrt(speed * speed + 2.0 * a * left) - speed) / a,
        )
