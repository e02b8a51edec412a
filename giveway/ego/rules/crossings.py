"""Giving way at crossings: the ego waits before a crossing for pedestrians with priority.

Pedestrians on a crossing, or at its kerb and about to cross, have priority if the crossing is a
zebra or their light is green. Those who are still on it when the light changes may finish. This is
what the Vienna Convention on Road Traffic (1968, art. 21) demands: "give way to pedestrians who are
using the crossing or about to use it". The ego stops before the crossing, not on it. It does not
drive onto a crossing that it could not leave because of the vehicle ahead (art. 18.2).

If a stop at a crossing would leave the body on another crossing or in a junction without a light,
the ego stops before that one. It looks farther ahead for people then. It does so for a limited time
alone, so that a stream of people does not hold it for ever; after that it waits at the crossing.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from controller.driving_constants import FIRM, PULL_AWAY, SAFE_TIME, SAFE_TIME_BEHIND
from giveway.crowd.crossings import (
    KERB_DISTANCE,
    have_priority,
    is_near,
    is_open,
    place_on,
    turning_in,
    use_of,
)
from giveway.ego.perception.leader import Leader
from giveway.ego.rules.gap_acceptance import travel_time
from giveway.ego.rules.path_crossings import PathCrossing, crossings_on
from giveway.ego.rules.protocol import YIELD, Demand, Needs, Situation
from giveway.ego.rules.route import RouteContext
from giveway.ego.rules.yielding import (
    BUILD_UP,
    CRAWLING,
    STOP_BEFORE,
    leaves_no_room,
    needed_braking,
)
from giveway.sumo.signal_plans import ChangeOf, untold
from pedestrian_model import Crowd

_PATIENCE = 4.5  # time [s]: a pedestrian who reaches the ego's path within it always counts
_CLEAR = 0.3  # least distance [m] between a stop and the crossing
_LAST = 2.0  # distance [m]; farther away, a stop at the very edge of the crossing is early enough
_SURE = 1.0  # additional time margin [s] before the ego starts again, so that it does not creep
# Walking time [s] to the kerb within which a pedestrian is about to enter the crossing: the brake
# reaction time of AASHTO's Green Book (2011, section 3.2) on stopping sight distance
KERB_TIME = 2.5
_SIGHT = 60.0  # sight distance [m] ahead of a crossing
_INSIDE = 3.0  # distance [m] behind its line, from which on an ego that stands is in a junction
_HELD = 10.0  # time [s] for which the ego waits before a junction for people behind it


def _no_time(_begin: float, _end: float) -> float:
    """The least time [s] between two stations [m], if no speed is known."""
    return 0.0


class Way(NamedTuple):
    """The junctions along an ego's way, and the time that it needs."""

    junctions: Sequence[tuple[float, float, float]] = ()  # [m] line, entry, exit without a light
    lines: Sequence[tuple[float, float]] = ()  # [m] stop lines that a network sets, and their ends
    duration: Callable[[float, float], float] = _no_time  # time [s] between stations, if it is free


ANYWHERE = Way()
"""A way without junctions, on which no free speed is known."""


class Crossings:
    """Watches the crossings on one ego's path.

    Args:
        crossings: Crossings in the order of the path.
        length: Length of the ego's body [m].
        gap: Distance [m] that it keeps behind a standing vehicle.
        kerb_distance: Distance [m] to the kerb, within which a pedestrian who walks towards a
            crossing is about to enter it.
        kerb_time: Walking time [s] to the kerb, within which such a pedestrian is about to enter
            it as well, unless their light turns red before they arrive.
        change_of: Function that returns the next change of a traffic light by its id.
        way: Junctions and free speed along the ego's way.

    Attributes:
        needs: The signal systems that govern the crossings, and where the ego must not stand.
    """

    def __init__(
        self,
        crossings: Sequence[PathCrossing],
        *,
        length: float,
        gap: float,
        kerb_distance: float = KERB_DISTANCE,
        kerb_time: float = KERB_TIME,
        change_of: ChangeOf = untold,
        way: Way = ANYWHERE,
    ) -> None:
        self._change_of = change_of
        self._junctions, self._lines, self._duration = way
        self._crossings = tuple(crossings)
        self._length, self._room = length, length + gap
        self._kerb_distance, self._kerb_time = kerb_distance, kerb_time
        self._next = 0
        self._latest = math.inf
        self._waits_for: int | None = None  # index of the crossing before which the ego waits
        self._place = math.inf  # station [m] of the ego's wait, present or past; inf without one
        self._before = math.inf  # station [m] of the crossing or junction before which it waits
        self._since = math.inf  # time [s] since when it has stood before a junction
        self._time = 0.0  # SUMO's clock [s]
        self._states: Mapping[str, str] = {}
        self.needs = Needs(
            frozenset(place.system for place in self._crossings if place.system),
            keep_clear=tuple((place.entry, place.exit + length) for place in self._crossings),
        )

    @classmethod
    def on(cls, route: RouteContext) -> Crossings | None:
        """The rule on one ego's route, or None if it has no crossings or the rule is off."""
        if not route.heeds("crossings"):
            return None
        passages = route.lane_path.passages
        found = crossings_on(route.path, route.shape, route.session.lanes.crossings)
        if not found:
            return None
        return cls(
            found,
            length=route.shape.length,
            gap=route.standing_gap,
            change_of=route.change_of,
            way=Way(
                [
                    (one.line(-math.inf), one.entry, one.exit)
                    for one in route.junctions
                    if not one.movement.system
                ],
                [(one.entry - one.offset, one.entry) for one in passages if one.offset],
                _no_time if route.profile is None else route.profile.duration,
            ),
        )

    def update(self, situation: Situation) -> None:
        """Take note of the lights' states.

        Args:
            situation: Present situation of the ego.
        """
        self._states = situation.signals

    def demand(self, situation: Situation) -> Demand | None:
        """The stop before a crossing at which the ego gives way, or which it could not leave.

        Args:
            situation: Present situation of the ego.
        """
        leader, self._time = situation.leader_at_rest(), situation.time
        stop = self._stop_at(situation.station, situation.speed, situation.crowd, leader)
        return None if stop == math.inf else Demand(stop, YIELD, self._latest)

    def _stop_at(self, front: float, speed: float, crowd: Crowd, leader: Leader) -> float:
        """The station [m] at which the front bumper has to stop; inf if it need not stop."""
        self._latest = math.inf
        while self._next < len(self._crossings) and self._crossings[self._next].entry < front:
            self._next += 1
            self._waits_for, self._place = None, math.inf
            self._before = self._since = math.inf
        for number in range(self._next, len(self._crossings)):
            place = self._crossings[number]
            if place.entry - front > _SIGHT:
                break
            wanted = self._is_wanted(number, front, speed, crowd)
            room = place.entry - front - BUILD_UP * speed
            in_time = number == self._waits_for or needed_braking(speed, room) <= FIRM
            if wanted or (in_time and leaves_no_room(leader, place.entry, place.exit, self._room)):
                stop = self._stop_for(number, front, speed)
                if stop < math.inf:
                    return stop
        self._waits_for = None
        return math.inf

    def _stop_for(self, number: int, front: float, speed: float) -> float:
        """Station [m] at which to stop for one crossing; inf if it is too late for any stop."""
        waits = self._waits_for is not None
        for entry, first in self._stops_before(number, front):
            latest = entry - _CLEAR
            far = entry - front > _LAST
            too_late = needed_braking(speed, (entry if far else latest) - front) > FIRM
            if too_late and not (first and waits and entry == self._before):
                continue
            nearest = front + speed * speed / (2.0 * FIRM)
            stop = max(entry - STOP_BEFORE, min(nearest, latest))
            self._latest = latest
            self._waits_for = number if first else None
            if first:
                if entry != self._before or (not waits and nearest > self._place):
                    self._place = math.inf  # the ego has driven off since
                self._place = min(self._place, stop)
                self._before, stop = entry, self._place
            if speed <= CRAWLING and self._since == math.inf:
                self._since = self._time
            return stop
        return math.inf

    def _stops_before(self, number: int, front: float) -> list[tuple[float, bool]]:
        """Stations [m] before which the ego may stop for crossing ``number``, the earliest first.

        An earlier crossing or junction is one of them if the ego would block it by a stop at the
        next one. Each comes with whether no crossing lies between it and the ego.
        """
        crossings = self._crossings[self._next : number]
        areas = [(place.entry, place.entry, place.exit) for place in crossings]
        areas += [(line, line, end + _INSIDE - self._length) for line, end in self._lines]
        if self._time - self._since <= _HELD:
            areas += [(line, entry + _INSIDE, leave) for line, entry, leave in self._junctions]
        stops = [self._crossings[number].entry]
        while True:
            stop = stops[-1] - STOP_BEFORE
            blocked = [
                entry
                for entry, inside, leave in areas
                if front <= entry < stops[-1]
                and inside < stops[-1]
                and stop - self._length <= leave
            ]
            if not blocked:
                break
            stops.append(max(blocked))
        nearest = self._crossings[self._next].entry
        return [(entry, entry <= nearest) for entry in reversed(stops)]

    def _enters_junction(self, number: int, front: float) -> bool:
        """Return whether a stop at a crossing would be in a junction that is still ahead."""
        entry, held = self._crossings[number].entry, self._time - self._since > _HELD
        rear = entry - STOP_BEFORE - self._length
        return not held and any(
            front <= line and begin + _INSIDE < entry and rear <= leave
            for line, begin, leave in self._junctions
        )

    def _is_wanted(self, number: int, front: float, speed: float, crowd: Crowd) -> bool:
        """Return whether the ego would meet a pedestrian with priority on the crossing."""
        place = self._crossings[number]
        if not len(crowd):
            return False
        kerb, along, length, half_width = place.area
        u, w = place_on(crowd.position, kerb, along)
        sure = _SURE if number == self._waits_for else 0.0
        starts = speed <= CRAWLING or number == self._waits_for
        enters, clears = self._own_times(place, front, speed, starts)
        within = self._kerb_time + sure + (enters if self._enters_junction(number, front) else 0.0)
        reach = np.maximum(self._kerb_distance, within * crowd.desired_speed)
        near = is_near(u, w, length, half_width + reach, reach)
        if not near.any():
            return False
        rows = np.flatnonzero(near)
        u, aside = u[rows], np.maximum(np.abs(w[rows]) - half_width, 0.0)
        use = use_of(crowd, rows, u, along, length)
        opened = is_open(self._states.get(place.system, ""), place.link, zebra=place.zebra)
        turning = turning_in(crowd, rows, kerb, along, length, reach[rows])
        coming = (aside <= 0.0) & have_priority(use, opened)
        coming |= ~use.on & (turning != 0.0) & opened
        direction = np.where(turning != 0.0, turning, np.where(use.onward >= 0.0, 1.0, -1.0))
        pace = np.maximum(crowd.desired_speed[rows], 0.1)
        if opened and (coming & ~use.on).any():
            to_kerb = np.where(direction > 0.0, -u, u - length) + aside
            in_time = np.maximum(self._kerb_distance, pace * self._open_for(place))
            coming &= use.on | (to_kerb <= in_time)
        to_go = np.where(direction > 0.0, place.low - u, u - place.high) + aside
        to_leave = np.where(direction > 0.0, place.high - u, u - place.low) + aside
        arrives, leaves = to_go / pace, to_leave / pace
        has_waited = number == self._next and self._place < math.inf
        first = leaves + (SAFE_TIME_BEHIND if starts or has_waited else SAFE_TIME) < enters
        later = arrives > max(clears + SAFE_TIME, _PATIENCE) + sure
        return bool((coming & (to_leave > 0.0) & ~first & ~later).any())

    def _open_for(self, place: PathCrossing) -> float:
        """The time [s] for which a crossing stays open to people; inf if no change is announced."""
        change = self._change_of(place.system) if place.system else None
        if change is None or is_open(change.state, place.link, zebra=place.zebra):
            return math.inf
        return change.time

    def _own_times(
        self, place: PathCrossing, front: float, speed: float, starts: bool
    ) -> tuple[float, float]:
        """The times [s] at which the ego would enter and leave the crossing if it drove on."""
        times = []
        for to_go in (place.entry - front, place.exit + self._length - front):
            time = travel_time(to_go, speed, PULL_AWAY, math.inf) if starts else to_go / speed
            times.append(max(time, self._duration(front, front + to_go)))
        return times[0], times[1]
