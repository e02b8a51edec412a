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

from giveway.crowd.crossings import (
    ASIDE,
    have_priority,
    is_near,
    is_open,
    place_on,
    turning_in,
    use_of,
)
from giveway.ego.giving_way import (
    CRAWLING,
    HARDEST,
    STOP_BEFORE,
    leaves_no_room,
    needed_braking,
)
from giveway.ego.perception.leader import NO_LEADER, Leader
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath, fine_near
from giveway.sumo.crossings import Crossing
from giveway.sumo.signal_plans import ChangeOf, untold
from pedestrian_model import Crowd

_SAMPLE, _COARSE = 0.1, 2.0  # [m] between the places of the body that are looked at
_GRAIN = 0.5  # [m] between the points of its outline, at most
_BESIDE = 0.8  # [m] from the ego's side to the middle of somebody who is not in its way
_BEFORE = 1.0  # [s] between the ego and whoever passes its way before or after it
_AFTER = 0.5  # [s] instead, behind whoever it has waited for: else it would stop for them again
_PATIENCE = 4.5  # [s] away from the ego's way, and a little more than an encounter's 4 s
_CLEAR = 0.3  # [m] before the crossing it stops at the latest
_LAST = 2.0  # [m] before the crossing; farther away a stop at it counts as in time, as by the law
_SURE = 1.0  # [s] in addition, before it starts again; else it would creep on bit by bit
_PULL_AWAY = 1.5  # [m/s^2] of the ego that has waited
_SIGHT = 60.0  # [m] before a crossing from which on people are looked at


class PathCrossing(NamedTuple):
    """A crossing that a path leads over, in the crossing's own coordinates."""

    entry: float  # [m] station of the front bumper from which on the body is on it
    exit: float  # [m] station that the rear passes last
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
    found: list[PathCrossing] = []
    coarse = np.arange(0.0, path.length, _COARSE)
    middles = _points(path, coarse)
    for crossing in crossings:
        kerb, other = crossing.ends
        length = float(np.hypot(*(other - kerb)))
        if length <= 0.0:
            continue
        away = np.hypot(*(middles - crossing.ends.mean(axis=0)).T)
        reach = (length + crossing.width) / 2 + shape.length + shape.width + _COARSE
        near = coarse[away <= reach]
        if not len(near):
            continue
        along = (other - kerb) / length
        stations = fine_near(near, _COARSE, near[0], path.length, _SAMPLE)
        outline = _outlines(path, shape, stations)
        u, w = place_on(outline.reshape(-1, 2), kerb, along)
        u, w = u.reshape(outline.shape[:2]), w.reshape(outline.shape[:2])
        inside = (u >= 0.0) & (u <= length) & (np.abs(w) <= crossing.width / 2)
        for visit in _runs(np.asarray(inside.any(axis=1))):
            swept = u[visit][inside[visit]]
            found.append(
                PathCrossing(
                    float(stations[visit[0]]),
                    float(stations[visit[-1]]) - shape.length,
                    kerb,
                    along,
                    length,
                    crossing.width / 2 + ASIDE,
                    float(swept.min()) - _BESIDE,
                    float(swept.max()) + _BESIDE,
                    crossing.zebra,
                    crossing.system,
                    crossing.link,
                )
            )
    return tuple(sorted(found, key=lambda place: place.entry))


def _points(path: EgoPath, stations: Array) -> Array:
    """(n, 2) [m] the path at ``stations`` (n,) [m], which goes on straight before its beginning."""
    points = path.points(stations)
    heading = path.headings[0]
    points += np.outer(np.minimum(stations, 0.0), (np.cos(heading), np.sin(heading)))
    return points


def _outlines(path: EgoPath, shape: VehicleShape, stations: Array) -> Array:
    """(n, p, 2) [m] points of the sides and the front of the body at each of ``stations`` (n,)."""
    front, rear = _points(path, stations), _points(path, stations - shape.length)
    forward = front - rear
    forward /= np.maximum(np.hypot(forward[:, 0], forward[:, 1]), 1e-9)[:, None]
    left = np.column_stack([-forward[:, 1], forward[:, 0]])
    back = np.linspace(0.0, shape.length, max(2, math.ceil(shape.length / _GRAIN)))
    sides = [(distance, side) for distance in back for side in (-0.5, 0.0, 0.5)]
    points = [front - a * forward + side * shape.width * left for a, side in sides]
    return np.stack(points, axis=1)


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
        gap: that it keeps behind a vehicle that stands [m].
        kerb_distance: [m] from the kerb, from which on somebody who heads for a crossing is about
            to enter it.
        kerb_time: [s] before they are there, from which on they are as well, unless their light
            turns red before.
        change_of: the next change of a traffic light by its id; None: nobody can tell.

    Attributes:
        systems: SUMO's ids of the traffic lights that govern them.
        latest: station [m] beyond which no plan leads while it stops for one; inf: it does not.
    """

    def __init__(
        self,
        crossings: Sequence[PathCrossing],
        *,
        length: float,
        gap: float,
        kerb_distance: float,
        kerb_time: float,
        change_of: ChangeOf = untold,
    ) -> None:
        self._change_of = change_of
        self._crossings = tuple(crossings)
        self._length, self._room = length, length + gap
        self._kerb_distance, self._kerb_time = kerb_distance, kerb_time
        self._next = 0
        self.latest = math.inf
        self._waits_for: int | None = None  # a crossing, before the next one
        self._place = math.inf  # [m] where it does, or did before; inf: it has not
        self._states: Mapping[str, str] = {}
        self.systems = frozenset(place.system for place in self._crossings if place.system)

    @property
    def kept_free(self) -> list[tuple[float, float]]:
        """Stations [m] of the front bumper between which the body is on one of them."""
        return [(place.entry, place.exit + self._length) for place in self._crossings]

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
        self.latest = math.inf
        while self._next < len(self._crossings) and self._crossings[self._next].entry < front:
            self._next += 1
            self._waits_for, self._place = None, math.inf
        for number in range(self._next, len(self._crossings)):
            place = self._crossings[number]
            if place.entry - front > _SIGHT:
                break
            wanted = self._is_wanted(number, front, speed, crowd)
            if wanted or leaves_no_room(leader, place.entry, place.exit, self._room):
                stop = self._stop_for(number, front, speed)
                if stop < math.inf:
                    return stop
        self._waits_for = None
        return math.inf

    def _stop_for(self, number: int, front: float, speed: float) -> float:
        """Station [m] at which to stop for one crossing; inf: it is too late everywhere."""
        waits = self._waits_for is not None
        for before in self._stops_before(number, front):
            entry = self._crossings[before].entry
            first = before == self._next
            latest = entry - _CLEAR
            far = entry - front > _LAST
            too_late = needed_braking(speed, (entry if far else latest) - front) > HARDEST
            if too_late and not (first and waits):
                continue
            nearest = front + speed * speed / (2.0 * HARDEST)
            stop = max(entry - STOP_BEFORE, min(nearest, latest))
            self.latest = latest
            self._waits_for = number if first else None
            if first:
                self._place = min(self._place, stop)
                stop = self._place
            return stop
        return math.inf

    def _stops_before(self, number: int, front: float) -> list[int]:
        """Before which crossings to stop for one: if it would stand on others, before these."""
        stops = [number]
        while stops[-1] > self._next:
            stop = self._crossings[stops[-1]].entry - STOP_BEFORE
            before = self._crossings[stops[-1] - 1]
            if stop - self._length > before.exit or before.entry < front:
                break
            stops.append(stops[-1] - 1)
        return stops[::-1]

    def _is_wanted(self, number: int, front: float, speed: float, crowd: Crowd) -> bool:
        """Whether somebody with priority and the ego would be on its way over it together."""
        place = self._crossings[number]
        if not len(crowd):
            return False
        u, w = place_on(crowd.position, place.kerb, place.along)
        sure = _SURE if number == self._waits_for else 0.0
        reach = np.maximum(self._kerb_distance, (self._kerb_time + sure) * crowd.desired_speed)
        near = is_near(u, w, place.length, place.half_width + reach, reach)
        if not near.any():
            return False
        rows = np.flatnonzero(near)
        u, aside = u[rows], np.maximum(np.abs(w[rows]) - place.half_width, 0.0)
        use = use_of(crowd, rows, u, place.along, place.length)
        opened = is_open(self._states.get(place.system, ""), place.link, zebra=place.zebra)
        turning = turning_in(crowd, rows, place.kerb, place.along, place.length, reach[rows])
        coming = (aside <= 0.0) & have_priority(use, opened)
        coming |= ~use.on & (turning != 0.0) & opened
        direction = np.where(turning != 0.0, turning, np.where(use.onward >= 0.0, 1.0, -1.0))
        pace = np.maximum(crowd.desired_speed[rows], 0.1)
        if opened and (coming & ~use.on).any():
            to_kerb = np.where(direction > 0.0, -u, u - place.length) + aside
            in_time = np.maximum(self._kerb_distance, pace * self._open_for(place))
            coming &= use.on | (to_kerb <= in_time)
        to_go = np.where(direction > 0.0, place.low - u, u - place.high) + aside
        to_leave = np.where(direction > 0.0, place.high - u, u - place.low) + aside
        arrives, leaves = to_go / pace, to_leave / pace
        starts = speed <= CRAWLING or number == self._waits_for
        enters, clears = self._own_times(place, front, speed, starts)
        has_waited = number == self._next and self._place < math.inf
        first = leaves + (_AFTER if starts or has_waited else _BEFORE) < enters
        later = arrives > max(clears + _BEFORE, _PATIENCE) + sure
        return bool((coming & (to_leave > 0.0) & ~first & ~later).any())

    def _open_for(self, place: PathCrossing) -> float:
        """How long [s] a crossing is open to people yet, as far as anybody can tell."""
        change = self._change_of(place.system) if place.system else None
        if change is None or is_open(change.state, place.link, zebra=place.zebra):
            return math.inf
        return change.time

    def _own_times(
        self, place: PathCrossing, front: float, speed: float, starts: bool
    ) -> tuple[float, float]:
        """When [s] the ego would enter the crossing and have left it, if it went on, or started."""
        entry, left = place.entry - front, place.exit + self._length - front
        if not starts:
            return entry / speed, left / speed
        a = _PULL_AWAY
        return (
            (math.sqrt(speed * speed + 2.0 * a * max(entry, 0.0)) - speed) / a,
            (math.sqrt(speed * speed + 2.0 * a * left) - speed) / a,
        )
