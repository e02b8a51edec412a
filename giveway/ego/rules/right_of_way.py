"""Right of way among vehicles: where the ego waits at a junction for those who go first.

Who goes first says the network (its links' states and ``request`` rows) and, where there is one,
the running traffic light: red and yellow are the business of `TrafficLights`; with ``G`` the ego
goes first; with ``g``, ``s`` (after a stop), ``o`` and no light at all it lets those go first
whom ``request`` names, unless their light is red. At an all-way stop who stood first goes first.

Those with priority come first if the ego, going on, would find them in its way: it needs its
critical gap (`gap_acceptance`) from its line on, and a second after it has cleared their way. It
waits at the line, or where SUMO's vehicles wait inside the junction if it may go as far. It does
not enter a junction that a slow vehicle ahead keeps it from leaving.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence, Set

from giveway.ego.driving_style import FIRM, PULL_AWAY, PULL_AWAY_BRISK, STANDING
from giveway.ego.perception.leader import Leader
from giveway.ego.rules.gap_acceptance import travel_time
from giveway.ego.rules.junctions import (
    RED,
    SIGHT,
    YELLOW,
    Approach,
    PathJunction,
    Traffic,
    letter_of,
)
from giveway.ego.rules.protocol import YIELD, Demand, Needs, Situation
from giveway.ego.rules.route import RouteContext
from giveway.ego.rules.yielding import (
    AFTER,
    BEFORE,
    CRAWLING,
    STOP_BEFORE,
    USUAL_SPEED,
    leaves_no_room,
    needed_braking,
)
from giveway.geometry.conflict import Conflict
from giveway.sumo.network.junction_links import Movement

_COMING = 1.0  # acceleration [m/s^2] of other vehicles
_GOING = 0.3  # time margin [s] to a vehicle that passes after an ego that has decided to go
_STAYS = 3.0  # time [s] after which a vehicle that stands without need is taken to stay
_BOXED_IN = 1.0  # the same [s] for a vehicle that has no room to go on
_CLOSE = 3.0  # gap [m] to a standing vehicle ahead, below which there is no room
_BRIEFLY = 1.0  # time [s] within which a crawling vehicle counts as having closed that gap
_AT_LINE = 4.0  # distance [m] before the line, within which a vehicle stands at it
_DECIDED = 10.0  # distance [m] before the line, within which the ego keeps its decision to go
_STOPS_AT_YELLOW = 2.5  # deceleration [m/s^2] with which others stop at yellow
# Letters of movements that yield to nobody: priority, or a zipper, which the rule Merging orders.
_NOBODY = frozenset("GZ")


class RightOfWay:
    """Watches the junctions on one ego's path.

    Args:
        junctions: Junctions in the order of the path.
        name: SUMO's id of the ego, which is among the traffic.
        length: Length of the ego's body [m].
        gap: Distance [m] that it keeps behind a standing vehicle.
        fastest: Speed [m/s] that the ego drives at most.
        critical_gap: Critical headway [s], or None for the Highway Capacity Manual's.
        follow_up_gap: Follow-up headway [s], or None for the Highway Capacity Manual's.

    Attributes:
        needs: The junctions, their signal systems, and where the ego must not stand.
        beside: Names of vehicles whose lanes lead them past the ego's path at the next junctions.
    """

    def __init__(
        self,
        junctions: Sequence[PathJunction],
        *,
        name: str,
        length: float,
        gap: float,
        fastest: float,
        critical_gap: float | None = None,
        follow_up_gap: float | None = None,
    ) -> None:
        self._junctions = tuple(junctions)
        self._name = name
        self._length, self._room = length, length + gap
        self._fastest = fastest
        self._gap = critical_gap, follow_up_gap
        self._next = 0
        self._followed = -math.inf  # [s] when the vehicle before it went over the next line
        self._stop = math.inf
        self._going = False  # it has decided to go through the next junction
        self._halted = False  # it has stood at the next line, where it has to
        self._stood = 0.0  # [s] at the next line, or behind it
        self._time = -math.inf
        self._staying: set[str] = set()  # others who will go on standing
        self._green: dict[tuple[str, int], float] = {}  # since when others' lights have been green
        self.needs = Needs(
            frozenset(place.movement.system for place in junctions) - {""},
            self._junctions,
            keep_clear=tuple((place.entry, place.exit + length) for place in junctions),
        )
        self.beside: Set[str] = frozenset()

    @classmethod
    def on(cls, route: RouteContext) -> RightOfWay | None:
        """The rule on one ego's route; None if vehicles meet nowhere, or it heeds no priority."""
        if not (route.heeds("right_of_way") and route.junctions):
            return None
        regulation = route.config.regulation
        return cls(
            route.junctions,
            name=route.config.ego_id,
            length=route.shape.length,
            gap=route.standing_gap,
            fastest=route.fastest,
            critical_gap=regulation.critical_gap,
            follow_up_gap=regulation.follow_up_gap,
        )

    def _pass(self, front: float) -> None:
        """Forget the junctions that the ego has left."""
        while self._next < len(self._junctions) and self._junctions[self._next].exit < front:
            self._next += 1
            self._stop = math.inf  # it was for the junction passed
            self._going = self._halted = False
            self._stood, self._followed = 0.0, -math.inf

    def update(self, situation: Situation) -> None:
        """Decide where to wait.

        Args:
            situation: What the rules know now.
        """
        time, front, speed = situation.time, situation.station, situation.speed
        states, traffic = situation.signals, situation.traffic
        self._pass(front)
        ahead = self._junctions[self._next :]
        if not ahead or ahead[0].entry - front > SIGHT:
            self.beside = frozenset()
        if not (states or traffic):
            return  # nothing is known that the decision depends on
        passed, self._time = time - self._time, time
        before, self._stop = self._stop, math.inf
        beside, others = set[str](), set[str]()
        for number in range(self._next, len(self._junctions)):
            place = self._junctions[number]
            if place.entry - front > SIGHT:
                break
            first = number == self._next
            for other in traffic.get(place.movement.junction, ()):
                (beside if other.number in place.beside else others).add(other.name)
            letter = letter_of(place.movement, states)
            if first:
                self._note(place, front, speed, passed, traffic)
            stop = self._stop_in(place, letter, first, front, speed, states, traffic)
            if first:
                near = place.entry - front <= _DECIDED
                self._going = stop == math.inf and (self._going or near) and letter not in RED
            needed = needed_braking(speed, stop + STOP_BEFORE - front)
            if stop < math.inf and (needed <= FIRM or abs(stop - before) <= STOP_BEFORE):
                self._stop = min(self._stop, max(stop, min(front, stop + STOP_BEFORE)))
        self.beside = beside - others

    def demand(self, situation: Situation) -> Demand | None:
        """A stop before a junction, or inside it, where the ego waits for others.

        Args:
            situation: What the rules know now.
        """
        stop = self._stop_at(situation.station, situation.speed, situation.leader_at_rest())
        return None if stop == math.inf else Demand(stop, YIELD)

    def _stop_at(self, front: float, speed: float, leader: Leader) -> float:
        """Station [m] at which the front bumper has to stop; inf: nowhere."""
        stop = self._stop
        for place in self._junctions[self._next :]:
            if place.entry < front:
                continue
            blocked = leaves_no_room(leader, place.entry, place.exit, self._room)
            if blocked and needed_braking(speed, place.entry - front) <= FIRM:
                stop = min(stop, max(place.entry - STOP_BEFORE, min(front, place.entry)))
            break
        return stop

    def _note(
        self, place: PathJunction, front: float, speed: float, passed: float, traffic: Traffic
    ) -> None:
        """Take note of the ego's wait at the line, and of a vehicle before it that crosses it."""
        stands = place.entry - front <= _AT_LINE and speed < STANDING
        self._stood = self._stood + passed if stands and passed < math.inf else 0.0
        self._halted = self._halted or (stands and front <= place.entry)
        own = place.movement
        for other in traffic.get(own.junction, ()):
            if other.name == self._name:
                continue
            if other.number == own.number and -passed * other.speed < other.distance <= 0.0:
                self._followed = self._time

    def _stop_in(
        self,
        place: PathJunction,
        letter: str,
        first: bool,
        front: float,
        speed: float,
        states: Mapping[str, str],
        traffic: Traffic,
    ) -> float:
        """Station [m] at which the ego waits for others at one junction; inf: it does not."""
        line = place.entry - STOP_BEFORE
        before = front <= place.entry
        if before and letter in "sw" and not (first and self._halted):
            return line
        gap = place.gap_at_lights if letter in "gGyY" else place.gap
        critical, follow_up = (
            usual if wanted is None else wanted
            for usual, wanted in zip(gap, self._gap, strict=True)
        )
        if first and before and letter not in "GMyY" and self._time - self._followed < follow_up:
            return line
        margin = AFTER
        if first and self._going:
            critical, margin = 0.0, _GOING
        stop, stay = math.inf, set[str]()
        for other in traffic.get(place.movement.junction, ()):
            where = None if other.name == self._name else place.conflicts.get(other.number)
            source = place.movements[other.number].source
            if where is None or front > where.enter or source in stay:
                continue
            if self._stays(place, other, states, traffic):
                stay.add(source)  # and who is behind it
                continue
            if not self._goes_first(place, letter, other, where, states, traffic):
                continue
            if not self._meets(place, other, where, front, speed, critical, margin):
                continue
            inside = [w for w in place.waiting if front <= w and w <= where.enter]
            if inside:
                stop = min(stop, inside[-1] - STOP_BEFORE)
            elif before:
                stop = min(stop, line)
        return stop

    def _stays(
        self, place: PathJunction, other: Approach, states: Mapping[str, str], traffic: Traffic
    ) -> bool:
        """Return whether a vehicle that could go on keeps standing, or is boxed in."""
        if other.standing <= 0.0:
            self._staying.discard(other.name)
            return other.speed < CRAWLING and _is_boxed_in(place, other, traffic)
        movement = place.movements[other.number]
        stood = other.standing
        if movement.system:
            key = movement.system, movement.link
            if letter_of(movement, states) in RED:
                self._green.pop(key, None)
                return False
            stood = min(stood, self._time - self._green.setdefault(key, self._time))
        patient = stood > _STAYS and self._stood > _STAYS
        if patient or (stood > _BOXED_IN and _is_boxed_in(place, other, traffic)):
            self._staying.add(other.name)  # for as long as it stands: the ego may go now
        return other.name in self._staying

    def _goes_first(
        self,
        place: PathJunction,
        letter: str,
        other: Approach,
        where: Conflict,
        states: Mapping[str, str],
        traffic: Traffic,
    ) -> bool:
        """Return whether the ego has to let the vehicle go first."""
        movement = place.movements[other.number]
        named = other.number in place.movement.yields_to
        if other.distance <= 0.0:  # it is in the junction already
            if other.distance + where.other_leave + other.length <= 0.0:
                return False
            there = other.distance + where.other_enter <= 0.0
            waits = other.standing > 0.0 and _has_to_wait(movement, traffic)
            return there or other.speed > CRAWLING or (named and letter != "G" and not waits)
        if letter in _NOBODY or not named:
            return False
        if movement.system:
            its = letter_of(movement, states)
            if its in RED:
                return False
            needed = other.speed**2 / (2.0 * other.distance)
            return its not in YELLOW or needed > _STOPS_AT_YELLOW
        if letter == "w":
            return other.distance < _AT_LINE and other.standing > self._stood
        return True

    def _meets(
        self,
        place: PathJunction,
        other: Approach,
        where: Conflict,
        front: float,
        speed: float,
        critical: float,
        margin: float,
    ) -> bool:
        """Return whether the ego would meet the vehicle if it went on."""
        fastest = max(self._fastest, speed)
        line, clear = (
            travel_time(station - front, speed, PULL_AWAY, fastest)
            for station in (place.entry, where.leave + self._length)
        )
        enter = travel_time(where.enter - front, speed, PULL_AWAY_BRISK, fastest)
        to_enter = other.distance + where.other_enter
        to_leave = other.distance + where.other_leave + other.length
        comes = travel_time(to_enter, other.speed, _COMING, max(USUAL_SPEED, other.speed))
        goes = math.inf
        if other.speed >= STANDING:  # in the junction it drives no faster than its lanes allow
            inside = min(other.speed, place.movements[other.number].speed)
            outside = min(max(other.distance, 0.0), to_leave)
            goes = outside / other.speed + (to_leave - outside) / inside
        in_time = comes >= max(clear + margin, line + critical if front <= place.entry else 0.0)
        return not in_time and goes + BEFORE > enter


def _has_to_wait(movement: Movement, traffic: Traffic) -> bool:
    """Return whether a vehicle is near to which this movement yields, the ego included."""
    return any(one.number in movement.yields_to for one in traffic.get(movement.junction, ()))


def _is_boxed_in(place: PathJunction, other: Approach, traffic: Traffic) -> bool:
    """Return whether a standing vehicle right ahead keeps another one from going on."""
    source = place.movements[other.number].source
    return any(
        ahead.standing > _BOXED_IN
        and ahead.distance < other.distance
        and other.distance - ahead.distance - ahead.length < _CLOSE + _BRIEFLY * other.speed
        and place.movements[ahead.number].source == source
        for ahead in traffic.get(place.movement.junction, ())
    )
